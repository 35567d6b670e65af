"""Does an animation tear a mesh? Prints how far edges are stretched, of their length in the bind pose, over all its frames.

    animation.py FILE.glb [PART OF AN ANIMATION'S NAME]

For each animation that the name suits: the median, 99th percentile and largest of |edge in a frame| / |edge in the bind pose|
over edges and frames, of the mesh nodes that have a skin. Compare a character's own figures with those of a mesh that
`focal rig --animations` gave its animations to. Reads .glb with float or byte data, LINEAR and STEP keys.
"""
import json
import struct
import sys

import numpy as np


class File:
    def __init__(self, path):
        with open(path, "rb") as file:
            data = file.read()
        size = struct.unpack("<I", data[12:16])[0]
        self.root, self.bin = json.loads(data[20:20 + size]), data[28 + size:]

    def accessor(self, index):
        a = self.root["accessors"][index]
        view = self.root["bufferViews"][a["bufferView"]]
        kind = {5120: "i1", 5121: "u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}[a["componentType"]]
        width = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}[a["type"]]
        stride = view.get("byteStride", np.dtype(kind).itemsize * width)
        start = view.get("byteOffset", 0) + a.get("byteOffset", 0)
        raw = np.frombuffer(self.bin, np.uint8)
        rows = start + stride * np.arange(a["count"])[:, None] + np.arange(np.dtype(kind).itemsize * width)
        values = raw[rows].reshape(a["count"], -1).view(kind).astype(float)
        return values / np.iinfo(kind).max if a.get("normalized") else values


def matrix(t, q, s):
    x, y, z, w = q / np.linalg.norm(q)
    m = np.eye(4)
    m[:3, :3] = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                          [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                          [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]) * s
    m[:3, 3] = t
    return m


def world(file, poses):
    nodes = file.root["nodes"]
    result = [None] * len(nodes)

    def visit(index, parent):
        node = nodes[index]
        if "matrix" in node:
            local = np.array(node["matrix"]).reshape(4, 4).T
        else:
            pose = {"translation": [0, 0, 0], "rotation": [0, 0, 0, 1], "scale": [1, 1, 1]}
            pose.update({k: v for k, v in node.items() if k in pose})
            pose.update(poses.get(index, {}))
            local = matrix(*(np.array(pose[k], float) for k in ("translation", "rotation", "scale")))
        result[index] = parent @ local
        for child in node.get("children", []):
            visit(child, result[index])

    children = {c for n in nodes for c in n.get("children", [])}
    for index in range(len(nodes)):
        if index not in children:
            visit(index, np.eye(4))
    return result


def skinned_parts(file):
    """Per primitive of a skinned node: positions, joints, weights, edges, skin."""
    for node in file.root["nodes"]:
        if "mesh" not in node or "skin" not in node:
            continue
        for primitive in file.root["meshes"][node["mesh"]]["primitives"]:
            get = lambda key: file.accessor(primitive["attributes"][key])
            corners = file.accessor(primitive["indices"]).astype(int).reshape(-1, 3)
            edges = np.unique(np.sort(np.vstack([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]]), 1), axis=0)
            yield get("POSITION"), get("JOINTS_0").astype(int), get("WEIGHTS_0"), edges, file.root["skins"][node["skin"]]


def at(times, values, time, turns):
    after = int(np.searchsorted(times, time, "right"))
    if after in (0, len(times)):
        return values[min(after, len(times) - 1)]
    t = (time - times[after - 1]) / (times[after] - times[after - 1])
    a, b = values[after - 1], values[after]
    if turns and a @ b < 0:
        b = -b
    return (1 - t) * a + t * b


def stretches(file, animation, frames=24):
    samplers = [(file.accessor(s["input"])[:, 0], file.accessor(s["output"])) for s in animation["samplers"]]
    end = max(times[-1] for times, _ in samplers)
    result = []
    for time in np.linspace(0, end, frames):
        poses = {}
        for channel in animation["channels"]:
            times, values = samplers[channel["sampler"]]
            path = channel["target"]["path"]
            poses.setdefault(channel["target"]["node"], {})[path] = at(times, values, time, path == "rotation")
        transforms = world(file, poses)
        for positions, joints, weights, edges, skin in skinned_parts(file):
            inverse = file.accessor(skin["inverseBindMatrices"]).reshape(-1, 4, 4).transpose(0, 2, 1)
            matrices = np.array([transforms[j] @ inverse[i] for i, j in enumerate(skin["joints"])])
            # The bind pose has the size of the joint matrices in rest: compare lengths after it.
            blend = np.einsum("vk,vkij->vij", weights, matrices[joints])
            moved = np.einsum("vij,vj->vi", blend, np.c_[positions, np.ones(len(positions))])[:, :3]
            size = np.cbrt(abs(np.linalg.det(matrices[0][:3, :3])))
            before = np.linalg.norm(positions[edges[:, 0]] - positions[edges[:, 1]], axis=1) * size
            after = np.linalg.norm(moved[edges[:, 0]] - moved[edges[:, 1]], axis=1)
            result.append(after[before > 1e-9] / before[before > 1e-9])
    return np.concatenate(result)


def main(path, part=""):
    file = File(path)
    used = {j for *_, skin in skinned_parts(file) for j in skin["joints"]}
    for animation in file.root.get("animations", []):
        if part not in animation.get("name", "") or not used & {c["target"].get("node") for c in animation["channels"]}:
            continue
        s = stretches(file, animation)
        print(f"{animation.get('name', ''):40} median {np.median(s):.3f}  99 % {np.percentile(s, 99):.3f}  largest {s.max():.2f}")


main(*sys.argv[1:])
