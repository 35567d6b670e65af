"""What focal was not asked to move stands where it stood: at rest and at 25, 50 and 75 % of every clip, of ten characters.

    frames.py --focal FOCAL --quick-model FOCAL_QUICK_MODEL --characters FOLDER --out FOLDER

Sample characters of every family, with a prop that a clip moves, and with FOCAL_EVALUATION_DATA the animated ones of its rigs. Marked:
all nodes and all vertices. Other weights (--keep-skeleton): all nodes, and the vertices of meshes without a skin. Another skeleton: all
nodes that hang where they hung; at rest all vertices, as focal reads the file. Bound: 1e-3 of the size.
"""
import argparse
import glob
import json
import os
import shutil
import struct
import subprocess
import sys

import numpy as np

import focal
from scene import Scene

BOUND = 1e-3  # of the size
COUNT = 10


def with_prop(path, out):
    """A tetrahedron beside the character, on a node that turns and goes up in the character's own clip."""
    file = Scene(path)
    root, data = file.root, bytearray(file.bin.tobytes())
    low, high = points_of(file).min(0), points_of(file).max(0)
    size = float(np.linalg.norm(high - low))

    def accessor(rows, kind, extremes=True):
        rows = np.ascontiguousarray(rows)
        while len(data) % 4:
            data.append(0)
        root["bufferViews"].append({"buffer": 0, "byteOffset": len(data), "byteLength": rows.nbytes})
        data.extend(rows.tobytes())
        made = {"bufferView": len(root["bufferViews"]) - 1, "componentType": 5126 if rows.dtype == np.float32 else 5123,
                "count": len(rows), "type": kind}
        if extremes:
            made.update(min=np.atleast_1d(rows.min(0)).tolist(), max=np.atleast_1d(rows.max(0)).tolist())
        root["accessors"].append(made)
        return len(root["accessors"]) - 1

    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], np.float32) * np.float32(0.05 * size)
    primitive = {"attributes": {"POSITION": accessor(corners, "VEC3")},
                 "indices": accessor(np.array([0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3], np.uint16), "SCALAR", False)}
    root["meshes"].append({"name": "prop", "primitives": [primitive]})
    node = len(root["nodes"])
    root["nodes"].append({"name": "prop", "mesh": len(root["meshes"]) - 1, "translation": (high + 0.02 * size).tolist()})
    root["scenes"][root.get("scene", 0)]["nodes"].append(node)
    clip = root["animations"][0]
    times = accessor(np.array([0, file.end(clip)], np.float32), "SCALAR")
    for path_of, rows, kind in (("rotation", [[0, 0, 0, 1], [0, 1, 0, 0]], "VEC4"),
                                ("translation", [high + 0.02 * size, high + 0.1 * size], "VEC3")):
        clip["samplers"].append({"input": times, "output": accessor(np.array(rows, np.float32), kind, False)})
        clip["channels"].append({"sampler": len(clip["samplers"]) - 1, "target": {"node": node, "path": path_of}})
    root["buffers"] = [{"byteLength": len(data)}]
    write(out, root, bytes(data))


def write(path, root, data):
    text = json.dumps(root).encode()
    text, data = text + b" " * (-len(text) % 4), data + b"\0" * (-len(data) % 4)
    with open(path, "wb") as file:
        file.write(struct.pack("<4sIIII", b"glTF", 2, 28 + len(text) + len(data), len(text), 0x4E4F534A) + text +
                   struct.pack("<II", len(data), 0x004E4942) + data)


def points_of(scene):
    return np.vstack([points for _, _, points, _ in scene.shown(weights=False)])


def moments(scene):
    yield None, 0.0
    for index, clip in enumerate(scene.root.get("animations", [])):
        for share in (0.25, 0.5, 0.75):
            yield index, share * scene.end(clip)


def at(scene, index, time):
    return scene.pose(None if index is None else scene.root["animations"][index], time)


def hangs_as_before(before, after, node):
    """Whether all above the node are the nodes that were above it."""
    while node in before.parents:
        if after.parents.get(node) != before.parents[node]:
            return False
        node = before.parents[node]
    return node not in after.parents


def without_skin(scene):
    parts = [points for node, _, points, _ in scene.shown(weights=False) if "skin" not in node]
    return np.vstack(parts) if parts else np.zeros((0, 3))


def off(one, other, size):
    """The largest distance of rows, in sizes; what was added comes behind."""
    return np.linalg.norm(other[:len(one)] - one, axis=1).max() / size if len(one) else 0.0


def places_of(nodes):
    return lambda scene: np.array([scene.worlds[node][:3, 3] for node in nodes])


def worst_of(before, comparisons):
    """By name of a comparison the largest distance over all moments. comparisons: name, the file after, what of it is compared."""
    worst, size = {name: 0.0 for name, *_ in comparisons}, np.linalg.norm(np.ptp(points_of(before.pose()), axis=0))
    others = {id(after): after for _, after, _ in comparisons}.values()
    for index, time in moments(before):
        for scene in (before, *others):
            at(scene, index, time)
        known = {}
        for name, after, what in comparisons:
            if what not in known:
                known[what] = what(before)
            worst[name] = max(worst[name], off(known[what], what(after), size))
    return worst


def farthest(points, others):
    """From a point to the nearest of the others, at most: parts may come in another order."""
    return max(np.sqrt(((others[None] - block[:, None]) ** 2).sum(2).min(1).max()) for block in np.array_split(points, 1 + len(points) // 500))


def kept_nodes(before, after):
    return [node for node in range(len(before.nodes)) if hangs_as_before(before, after, node)]


def is_found_out(path):
    """Whether a file in which a joint stands elsewhere is noticed: a comparison that notices nothing would always pass."""
    before, corrupted = Scene(path), Scene(path)
    node = corrupted.rest[corrupted.root["skins"][0]["joints"][1]]
    node["translation"] = np.add(node.get("translation", [0, 0, 0]), 0.01 * np.ptp(points_of(before)))
    worst = worst_of(before, [("nodes", corrupted, places_of(kept_nodes(before, corrupted))), ("vertices", corrupted, points_of)])
    return min(worst.values()) > BOUND


def with_props(made, out):
    paths = []
    for path in made:
        paths.append(os.path.join(out, os.path.basename(path)))
        with_prop(path, paths[-1])
    return paths


def real_ones(count):
    """Animated rigs of the data: those with the fewest clips, and the one with the most."""
    paths = glob.glob(os.path.join(os.environ.get("FOCAL_EVALUATION_DATA", "-"), "rigs", "*.glb"))
    clips = {path: len(Scene(path).root.get("animations", [])) for path in sorted(paths)}
    animated = sorted((path for path in clips if clips[path] > 0), key=clips.get)
    if not animated:
        print("frames: FOCAL_EVALUATION_DATA has no animated rigs: only sample characters")
    return animated[:count - 1] + animated[-1:]


def figures_of(path, written):
    """By name the largest distances, in sizes. written(name, arguments of focal, or only a character to learn from): the file."""
    before, model = Scene(path), written("quick.focal", path)
    marked = Scene(written("marked.glb", "detect", model, path))
    weighted = Scene(written("weighted.glb", "rig", "--keep-skeleton", path))
    rigged = Scene(written("rigged.glb", "rig", model, path, "--keep-failed"))
    every, kept = places_of(kept_nodes(before, weighted)), kept_nodes(before, rigged)
    figures = worst_of(before, [("marked: vertices", marked, points_of), ("nodes", marked, every), ("weights: nodes", weighted, every),
                                ("parts without a skin", weighted, without_skin), ("rigged: nodes", rigged, places_of(kept))])
    shown = np.asarray(focal.Mesh.load(path, surface="as-is").vertices)
    figures["vertices at rest"] = farthest(shown, points_of(rigged.pose())) / np.linalg.norm(np.ptp(shown, axis=0))
    frames = sum(1 for _ in moments(before))
    print(f"{os.path.basename(path):24} {frames} frames, {len(before.nodes)} nodes, {len(kept)} hang as before the rig; " +
          ", ".join(f"{what} {value:.1e}" for what, value in figures.items()), flush=True)
    return figures, frames


def main():
    parser = argparse.ArgumentParser()
    for name in ("--focal", "--quick-model", "--characters", "--out"):
        parser.add_argument(name, required=True)
    options = parser.parse_args()
    shutil.rmtree(options.out, ignore_errors=True)
    os.makedirs(options.out)

    def written(name, *arguments):
        path = os.path.join(options.out, name)
        if os.path.exists(path):
            os.remove(path)
        learn = [options.quick_model, path, *arguments]
        command = learn if len(arguments) == 1 else [options.focal, *arguments, "-o", path, "--quiet"]
        done = subprocess.run(command, capture_output=True, text=True)
        if not os.path.exists(path):  # a rig whose verdict is failed is written, and ends with 1
            raise RuntimeError(f"{' '.join(command)}: {done.stderr}")
        return path

    made = sorted(glob.glob(os.path.join(options.characters, "*", "*_00.rig.glb")))
    found = [figures_of(path, written) for path in with_props(made, options.out) + real_ones(COUNT - len(made))]
    worst = max(max(figures.values()) for figures, _ in found)
    print(f"frames: {len(found)} characters, {sum(frames for _, frames in found)} frames, off by at most {worst:.1e} of the size "
          f"(bound {BOUND:g})")
    return 0 if worst <= BOUND and is_found_out(made[0]) else 1


sys.exit(main())
