"""Cases of what a file shows: instances, hidden and foreign parts, morph targets, skins, seams."""
import numpy as np

import focal
from scene import Scene
from truths import all_points, distances, height, places, share, true_joints


def statue(case):
    """The same body alone."""
    return case.lab.rig(case.lab.taught(), case.lab.character(12))


def as_alone(case, file, bound=1e-3):
    """What is left out of the analysis changes nothing; what is analysed with the body has a bound."""
    _, alone = statue(case)
    scene, report = case.lab.rig(case.lab.taught(), case.file(file))
    case.at_most(f"{file}: joints beside those of the body alone, mean % of the height",
                 100 * distances(places(report), places(alone)).mean() / 1.8, bound)
    return scene, report


def hidden_collider(case):
    scene, _ = as_alone(case, "godot.glb")
    before = Scene(case.file("godot.glb"))
    collider = next(i for i, node in enumerate(before.nodes) if node.get("name") == "CharacterCollider")
    mesh = before.nodes[collider]["mesh"]
    case.is_so("the collider is untouched", scene.rest[collider] == before.rest[collider] and
               scene.root["meshes"][mesh] == before.root["meshes"][mesh])


def mirrored_instance(case):
    lab = case.lab
    scene, _ = lab.rig(lab.taught(), case.file("eyes.glb"))
    eyes = [share(weights, "head") for node, _, _, weights in scene.shown() if node.get("name", "").startswith("Eye")]
    case.is_so("both eyes follow the head bone", len(eyes) == 2 and min(eyes) > 0.9, [round(eye, 3) for eye in eyes])
    toon = Scene(case.file("toon.glb"))
    _, report = lab.rig(lab.taught(), case.file("toon.glb"))
    true = true_joints(lab.character(10, ".joints.json"), "rest")
    for side in "left", "right":
        arm = {name: place for name, place in true.items() if name.startswith(side) and name.endswith(("Shoulder", "Arm", "Hand"))}
        case.at_most(f"{side} arm, worst joint, % of the height", 100 * distances(places(report), arm).max() / height(toon), 3)


def default_weights(case):
    _, report = case.lab.rig(case.lab.taught(), case.file("body.glb"))
    true = true_joints(case.lab.character(12, ".joints.json"))
    case.at_most("joints of the shown shape, mean % of the height", 100 * distances(places(report), true).mean() / 1.8, 0.75)


def no_inverse_bind(case):
    vertices = np.asarray(focal.Mesh.load(case.file("rigid_segments.glb")).vertices)
    case.at_most("box as shown, off 1.52 x 1.91 x 0.33", np.abs(np.ptp(vertices, axis=0) - [1.52, 1.91, 0.33]).max(), 0.006)
    _, report = case.lab.rig(case.lab.taught(), case.file("rigid_segments.glb"))
    off = distances(places(report), true_joints(case.lab.character(12, ".joints.json"), "rest"))
    case.is_so("22 joints", len(off) == 22 and np.isfinite(off).all(), len(off))
    case.at_most("joints, worst, % of the height", 100 * off.max() / 1.905, 3)


def seam_pairs(points, near=5e-4):
    """Numbers of the vertices that lie at one place, each pair once."""
    order = np.argsort(points[:, 0])
    points, pairs = points[order], []
    for step in range(1, len(points)):
        ahead = points[step:] - points[:-step]
        if (ahead[:, 0] > near).all():
            break
        found = np.flatnonzero(np.linalg.norm(ahead, axis=1) < near)
        pairs.append(np.c_[order[found], order[found + step]])
    return np.vstack(pairs)


def seam_noise(case):
    lab = case.lab
    _, exact = lab.rig(lab.taught(), case.file("exact.glb"))
    for name in "exact", "noise", "tenthmm", "soup_noise":
        file = case.file(name + ".glb")
        info = lab.report("info", file)
        case.is_so(f"{name}: 1 part", info["components"] == 1, info["components"])
        scene, report = lab.rig(lab.taught(), file, "--animations", lab.character(0, ".rig.glb"))
        case.is_so(f"{name}: fit beside exact.glb's", abs(report["category_fit"] - exact["category_fit"]) < 0.02,
                   f"{report['category_fit']:.3f} and {exact['category_fit']:.3f}")
        case.at_most(f"{name}: joints beside exact.glb's, mean % of the height",
                     100 * distances(places(report), places(exact)).mean() / 1.8, 0.2)
        one, other = seam_pairs(all_points(scene)).T
        case.is_so(f"{name}: vertices meet at seams", len(one) > 80, len(one))
        weights = {bone: np.hstack([part[3][bone] for part in scene.shown()]) for bone in places(report)}
        case.at_most(f"{name}: weights across the seam, L1",
                     sum(abs(column[one] - column[other]) for column in weights.values()).max(), 0.02)
        clip = scene.clip("stretch")
        posed = [all_points(scene.pose(clip, time)) for time in np.linspace(0, scene.end(clip), 5)]
        gap = max(np.linalg.norm(points[one] - points[other], axis=1).max() for points in posed)
        case.at_most(f"{name}: gap when posed, mm", 1e3 * gap, 1)


def specks(case):
    as_alone(case, "decode.glb", 0.3)


def two_skins(case):
    info = case.lab.report("info", case.file("char.glb"))
    case.at_most("area beside 1.658 m2", abs(info["surface_area"] - 1.658), 1e-3)
    case.is_so("1 part", info["components"] == 1, info["components"])


def ground(case):
    as_alone(case, "statue.glb")


CASES = {"06_hidden_collider": hidden_collider, "07_mirrored_instance": mirrored_instance, "11_default_weights": default_weights,
         "12_no_ibm": no_inverse_bind, "13_seam_noise": seam_noise, "14_specks": specks, "23_two_skins": two_skins,
         "26_ground": ground}
