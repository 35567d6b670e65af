"""Cases of files, folders, tables, and what a file keeps."""
import json
import math
import os
import shutil

import numpy as np

import focal
from scene import Scene

SOURCES = ("input", "output")


def morph_animation(case):
    scene, _ = case.lab.rig(case.lab.taught(), case.file("face.glb"))
    channels = [channel for clip in scene.root["animations"] for channel in clip["channels"] if channel["target"]["path"] == "weights"]
    carriers = [scene.nodes[channel["target"]["node"]].get("mesh") for channel in channels]
    case.is_so("the channel targets the node that carries mesh 0", carriers == [0], carriers)
    case.is_so("its keys are those of the input", same_keys(Scene(case.file("face.glb")), scene))


def same_keys(before, after):
    pairs = zip(before.root["animations"], after.root["animations"])
    return all(np.array_equal(before.accessor(one[key]), after.accessor(other[key]))
               for first, second in pairs for one, other in zip(first["samplers"], second["samplers"]) for key in SOURCES)


def gltf_folder(case):
    lab = case.lab
    here = case.result("other", "rigged.gltf")
    lab.report("rig", lab.taught(), case.file("in dir", "statue.gltf"), "-o", here, "--keep-failed")
    loads(case, "rig", here)
    folder = case.result("batch", "")
    lab.report("batch", lab.marks(), case.file("in dir"), "-o", folder)
    for name in os.listdir(folder):
        if name.endswith((".gltf", ".glb")):
            loads(case, "batch", os.path.join(folder, name))


def loads(case, how, file):
    info = case.lab.report("info", file)
    case.is_so(f"{how}: the result loads from where it lies", info["vertices"] == 5184, info["vertices"])
    with open(file) as text:
        root = json.load(text)
    uris = [thing["uri"] for kind in ("buffers", "images") for thing in root.get(kind, []) if "uri" in thing]
    missing = [uri for uri in uris if not uri.startswith("data:") and
               not os.path.isfile(os.path.join(os.path.dirname(file), uri.replace("%20", " ")))]
    case.is_so(f"{how}: its buffers and images lie beside it", not missing, missing)


def pointer(case):
    status, _, error = case.lab.focal("info", case.file("giraffe.glb"))
    case.is_so("refusal that says Git LFS pointer", status == 1 and "Git LFS pointer" in error, error.split("\n")[0][-80:])


def byte_order_mark(case):
    status, _, error = case.lab.focal("info", case.file("AssetWithBOM.gltf"))
    case.is_so("read, or a clear refusal", status == 0 or "byte order mark" in error, error.split("\n")[0][-80:])


def uris(case):
    for name in ("percent/example 10%.gltf", "backslash/a.gltf", "dotslash/a.gltf", "utf8/Körper.gltf"):
        case.is_so(name + " is read", case.lab.report("info", case.file(name))["vertices"] == 5184)


def empty_primitive(case):
    for name in ("body.glb", "no_primitives.glb"):
        info = case.lab.report("info", "--lenient", case.file(name))
        case.is_so(name + ": 5,184 vertices with a warning", info["vertices"] == 5184 and info["warnings"], info["warnings"])
        status, _, error = case.lab.focal("info", case.file(name))
        case.is_so(name + ": otherwise a refusal that names --lenient", status == 1 and "--lenient" in error)


def converted(case, name):
    """Name and place of each landmark, or what the refusal says."""
    out = case.result(name + ".landmarks.json")
    status, _, error = case.lab.focal("convert", case.file(name), out)
    if status != 0:
        return error
    with open(out) as file:
        return {mark["name"]: mark.get("position") for mark in json.load(file)["landmarks"]}


def tables(case):
    nose = {"nose": [0.0123, 1.61, 0.12]}
    wanted = {"capitals.csv": nose, "german.csv": {**nose, "chin": [0.01, 1.55, 0.11]}, "label.csv": nose, "quoted.csv": nose,
              "tab.csv": nose}
    for name, marks in wanted.items():
        found = converted(case, name)
        case.is_so(f"{name} is read", found == marks, found)
    found = converted(case, "nan.csv")
    case.is_so("nan.csv: no place, so absent, or a refusal", found == {} or "NaN" in found, found)
    found = converted(case, "noname.csv")
    case.is_so("noname.csv: a refusal", "no name" in found, found)


def slicer(case):
    wanted = {"ras.mrk.json": {"F-1": [-10, -20, 30]}, "slicer410.fcsv": {"F-1": [-10, -20, 30]},
              "slicer52.fcsv": {"F-1": [10, 20, 30], "F-2": [11, 21, 31]}, "slicer52_unset.fcsv": {"F-1": [10, 20, 30]}}
    for name, marks in wanted.items():
        found = converted(case, name)
        case.is_so(f"{name}: RAS turned, unplaced left out", found == marks, found)
    found = converted(case, "curve.mrk.json")
    case.is_so("curve.mrk.json: the points, or a refusal that names what is there twice", "twice" in found or
               found == {"F-1": [10, 20, 30]}, found)
    case.is_so("idav.pts: a refusal that names the formats", ".mrk.json" in converted(case, "idav.pts"))


def large_coordinates(case):
    body = focal.Mesh.load(case.lab.character(12))
    far = np.asarray(body.vertices, np.float64) + [-2487002.88, -4684683.67, 3529638.98]
    mesh = focal.Mesh(far, body.faces)
    case.is_so("5,184 surface vertices", mesh.info["surface_vertex_count"] == 5184, mesh.info["surface_vertex_count"])


def keep(case):
    """Every member of the source is in the result; what is added comes behind. A mesh gets attributes, a node its skin."""
    before = Scene(case.file("rich.glb"))
    after, _ = case.lab.rig(case.lab.taught(), case.file("rich.glb"))
    lost = []
    for key, value in before.root.items():
        kept = after.root.get(key)
        if isinstance(value, list) and key != "buffers":
            lost += [f"{key}[{i}]" for i, one in enumerate(value) if not holds(kept[i], one)]
        elif key != "buffers" and not holds(kept, value):
            lost.append(key)
    case.is_so("all other members are equal", not lost, lost)


def holds(new, old):
    """old, and more members of objects, attributes and children."""
    if isinstance(old, dict):
        return isinstance(new, dict) and all(key in new and holds(new[key], value) for key, value in old.items())
    if isinstance(old, list) and all(isinstance(one, int) for one in old):  # nodes of a scene, children: others may come between
        rest = iter(new)
        return all(one in rest for one in old)
    if isinstance(old, list):
        return isinstance(new, list) and len(new) >= len(old) and all(holds(a, b) for a, b in zip(new, old))
    return new == old and type(new) is type(old)


def heat_of_parts(case):
    side = 7
    grid = [(x, y, 0) for y in range(side) for x in range(side)]
    faces = [face for y in range(side - 1) for x in range(side - 1) for a in [y * side + x]
             for face in ((a, a + 1, a + side), (a + 1, a + side + 1, a + side))]
    vertices = grid + [(x + side - 1 + 20, y, z) for x, y, z in grid]
    mesh = focal.Mesh(vertices, faces + [tuple(v + len(grid) for v in face) for face in faces])
    for kind in "heat", "exact":
        found = np.asarray(mesh.distances(0, kind))[len(grid):].min()
        case.is_so(f"{kind}: the other island is as far as the gap is wide", math.isinf(found) or abs(found - 26) < 1, f"{found:.2f}")


def upper_case(case):
    lab, folder, out = case.lab, case.result("in", ""), case.result("out", "")
    for name in "first.glb", "second.GLB", "avatar.vrm", "notes.txt":
        shutil.copy(lab.character(13), os.path.join(folder, name))
    lab.report("batch", lab.marks(), folder, "-o", out)
    done = " ".join(os.listdir(out))
    for name in "first", "second", "avatar":
        case.is_so(f"batch: {name} is done", name in done, done)
    _, said, error = lab.focal("batch", lab.marks(), folder, "-o", out)
    case.is_so("batch: what was skipped is named", "notes.txt" in said + error, said.strip()[-90:])
    status, _, error = lab.focal("detect", lab.marks(), os.path.join(folder, "second.GLB"), "-o", os.path.join(out, "marked.GLB"))
    case.is_so("detect writes .GLB", status == 0 and len(Scene(os.path.join(out, "marked.GLB")).nodes) > 1, error.strip())


CASES = {"03_morph_anim": morph_animation, "05_gltf_folder": gltf_folder, "15_lfs": pointer, "16_bom": byte_order_mark,
         "17_uri": uris, "18_empty_primitive": empty_primitive, "20_csv_locale": tables, "21_slicer": slicer,
         "27_large_coordinates": large_coordinates, "28_keep": keep, "30_two_parts_heat": heat_of_parts,
         "31_upper_case": upper_case}
