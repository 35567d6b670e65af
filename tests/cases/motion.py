"""Cases of animations, bone names and teachers."""
import os

import numpy as np

import focal
from scene import Scene
from truths import clip_difference, distances, height, places, share, turns


def two_armatures(case):
    lab, mesh, clips = case.lab, case.lab.character(12), []
    for source in "single", "two":
        scene, _ = lab.rig(lab.taught(), mesh, "--animations", case.file(source + ".glb"))
        clips.append((scene, scene.clip("wave")))
    case.at_most("clip 'wave' beside single.glb, m", clip_difference(*clips[0], *clips[1]), 1e-3)
    scene, clip = clips[1]
    case.at_most("hips move, m", max(np.linalg.norm(scene.pose(clip, t).places()["hips"] - scene.pose(clip, 0).places()["hips"])
                                     for t in np.linspace(0, scene.end(clip), 5)), 1e-4)


def cubic_step(case):
    scene, _ = case.lab.rig(case.lab.taught(), case.lab.character(12), "--animations", case.file("hero.glb"))
    cubic = turns(scene, scene.clip("swing_cubic"), "leftUpperArm", [0, 0.25, 0.5, 0.75, 1])
    case.at_most("cubic, worst of 0/46.8/60/46.8/0 degrees", np.abs(np.subtract(cubic, [0, 46.8, 60, 46.8, 0])).max(), 0.1)
    step = turns(scene, scene.clip("pose_step"), "leftUpperArm", [0, 0.5, 0.99, 1, 1.5])
    case.at_most("step, worst of 0/0/0/60/60 degrees", np.abs(np.subtract(step, [0, 0, 0, 60, 60])).max(), 0.1)


def moving(scene, name):
    """Channels of more than one key. A joint that the character's clip leaves alone has one, which holds it in that character's pose."""
    clip = scene.clip(name)
    return sum(len(scene.accessor(clip["samplers"][channel["sampler"]]["input"])) > 1 for channel in clip["channels"])


def unnamed(case):
    lab, hero = case.lab, case.file("hero_unnamed.glb")
    model = lab.quick("unnamed", hero)
    scene, _ = lab.rig(model, lab.character(12), "--animations", hero)
    case.is_so("21 channels that move", moving(scene, "stretch") == 21, moving(scene, "stretch"))
    posed_as_skinned(case, hero)


def posed_as_skinned(case, file, true=None, clip="stretch", time=1):
    """The mesh as the library poses it, beside the file skinned here."""
    posed = np.asarray(focal.Mesh.load(file, pose_animation=clip, pose_time=time).vertices)
    other = Scene(true or file)
    skinned = np.vstack([points for _, _, points, _ in other.pose(other.clip(clip), time).shown(weights=False)])
    case.at_most("posed vertices beside the skinned ones, m", np.linalg.norm(posed - skinned, axis=1).max(), 1e-3)


def prefixes(case):
    lab = case.lab
    a, b, c = (case.file(name + ".glb") for name in "abc")
    report = lab.report("info", lab.quick("mixamo_ab", a, b))
    case.is_so("22 joints of two characters with other prefixes", len(report["joints"]) == 22, len(report["joints"]))
    for source in b, c:
        scene, _ = lab.rig(lab.quick("mixamo_a", a), lab.character(12), "--animations", source)
        case.is_so("21 channels of a clip with another prefix", moving(scene, "stretch") == 21, moving(scene, "stretch"))
    status, _, error = lab.focal("rig", lab.quick("unnamed", lab.input("08_unnamed", "hero_unnamed.glb")), lab.character(12),
                                 "--animations", a, "-o", case.result("none.glb"), "--keep-failed")
    case.is_so("a clip without any matching joint is named", "match" in error or "joint" in error, error.strip().split("\n")[0][:90])


def parented(case):
    lab = case.lab
    scene, _ = lab.rig(lab.quick("robot", case.file("robot.glb")), lab.character(12))
    shares = []
    for _, _, points, weights in scene.shown():
        top = points[:, 1] > points[:, 1].max() - 0.15
        shares.append(share({name: column[top] for name, column in weights.items()}, "head"))
    case.is_so("mean weight of the head in the top 15 cm > 0.9", min(shares) > 0.9, f"{min(shares):.3f}")


def long_clip(case):
    lab = case.lab
    scene, report = lab.rig(lab.taught(), lab.character(12), "--animations", case.file("mocap.glb"))
    keys = max(scene.root["accessors"][sampler["input"]]["count"] for sampler in scene.clip("mocap_91_48")["samplers"])
    case.is_so("4,000 keys", keys == 4000, keys)


def scale(case):
    lab = case.lab
    _, full = lab.rig(lab.taught(), lab.character(12))
    _, tiny = lab.rig(lab.taught(), case.file("tiny_node.glb"))
    factor = 0.003 / 1.75
    true = {name: place * factor for name, place in places(full).items()}
    case.at_most("3 mm high: joints beside full size, mm", 1e3 * distances(places(tiny), true).max(), 1e-3)
    clips = []
    for source in lab.character(0, ".rig.glb"), case.file("meshy_001.glb"):
        scene, _ = lab.rig(lab.taught(), lab.character(12), "--animations", source)
        clips.append((scene, scene.clip("stretch")))
    case.at_most("clip of the 0.01 armature beside humanoid_00's, m", clip_difference(*clips[0], *clips[1]), 1e-3)


def eight_influences(case):
    posed_as_skinned(case, case.file("hero.glb"), case.lab.character(0, ".rig.glb"))


def real_humans(case):
    """The other three humans of the report lie in the data."""
    lab = case.lab
    humans = [os.path.join(lab.data, "wild", "dev", f"m2m_{name}.rig.glb") for name in ("male", "human", "sophia")]
    if not all(map(os.path.exists, humans)):
        case.is_so("skipped: no such humans in FOCAL_EVALUATION_DATA", True)
        return
    zombie = Scene(case.file("human-zombie.glb"))
    _, report = lab.rig(lab.model("humans", *humans), case.file("human-zombie.glb"))
    bound = {name: place for name, place in zombie.places().items() if name in places(report)}  # it stands as it is bound
    off = distances(places(report), bound) / height(zombie)
    case.at_most("joints beside its own, mean % of the height", 100 * off.mean(), 5)


CASES = {"01_two_armatures": two_armatures, "02_cubic_step": cubic_step, "08_unnamed": unnamed, "09_mixamorig": prefixes,
         "10_parented_to_bone": parented, "19_scale": scale, "24_eight_influences": eight_influences, "29_long_clip": long_clip,
         "32_real_humans": real_humans}
