"""A .glb file in a pose of one of its animations, sampled as the glTF specification says; weights of its vertices by joint name."""
import functools
import os
import sys

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "characters"))
import glb  # noqa: E402  (tests/characters/glb.py)


def slerp(a, b, share):
    cosine = a @ b
    if cosine < 0:
        b, cosine = -b, -cosine
    angle = np.arccos(min(cosine, 1.0))
    if angle < 1e-6:
        return (1 - share) * a + share * b
    return (np.sin((1 - share) * angle) * a + np.sin(share * angle) * b) / np.sin(angle)


def spline(times, rows, after, share):
    """rows: an in-tangent, a value and an out-tangent a key."""
    span, t = times[after] - times[after - 1], share
    start, leaving = rows[3 * after - 2], span * rows[3 * after - 1]
    arriving, end = span * rows[3 * after], rows[3 * after + 1]
    return ((2 * t**3 - 3 * t**2 + 1) * start + (t**3 - 2 * t**2 + t) * leaving + (-2 * t**3 + 3 * t**2) * end +
            (t**3 - t**2) * arriving)


class Scene(glb.File):
    def __init__(self, path):
        super().__init__(path)
        self.rest = [dict(node) for node in self.nodes]
        self.accessor = functools.lru_cache(maxsize=None)(super().accessor)  # clips share theirs, and are sampled often

    def clip(self, name):
        return next(clip for clip in self.root.get("animations", []) if clip.get("name") == name)

    def clip_of(self, name, node):
        """The last clip of that name that moves the node: the input's own come first."""
        clips = [clip for clip in self.root["animations"] if clip.get("name", "").split(" (")[0] == name]
        return [clip for clip in clips if node in {channel["target"].get("node") for channel in clip["channels"]}][-1]

    def sample(self, sampler, time, path):
        times, rows = self.accessor(sampler["input"])[:, 0], self.accessor(sampler["output"])
        kind = sampler.get("interpolation", "LINEAR")
        values = rows[1::3] if kind == "CUBICSPLINE" else rows
        after = int(np.searchsorted(times, time, "right"))
        if after in (0, len(times)):
            return values[min(after, len(times) - 1)]
        share = (time - times[after - 1]) / (times[after] - times[after - 1])
        if kind == "STEP":
            return values[after - 1]
        if kind == "CUBICSPLINE":
            return spline(times, rows, after, share)
        if path == "rotation":
            return slerp(values[after - 1], values[after], share)
        return (1 - share) * values[after - 1] + share * values[after]

    def end(self, clip):
        return max(self.accessor(sampler["input"]).max() for sampler in clip["samplers"])

    def pose(self, clip=None, time=0.0):
        """As the clip has it at that time; without a clip as the file stands."""
        for index, node in enumerate(self.rest):
            self.nodes[index] = dict(node)
        for channel in clip["channels"] if clip else []:
            target = channel["target"]
            if target.get("path") in ("translation", "rotation", "scale") and "node" in target:
                value = self.sample(clip["samplers"][channel["sampler"]], time, target["path"])
                self.nodes[target["node"]][target["path"]] = value
        self.place_nodes()
        return self

    def place_nodes(self):
        self.worlds = [None] * len(self.nodes)
        for index in sorted(range(len(self.nodes)), key=self.depth):
            local = self.local(index)
            self.worlds[index] = self.worlds[self.parents[index]] @ local if index in self.parents else local

    def local_rotation(self, node):
        rotation = np.asarray(self.nodes[node].get("rotation", [0, 0, 0, 1]), float)
        return rotation / np.linalg.norm(rotation)

    def bones(self, skin=-1):
        """Node of each joint of a skin, by name; skin: the last one, focal's own where it added one."""
        return {self.nodes[joint].get("name", f"node {joint}"): joint for joint in self.root["skins"][skin]["joints"]}

    def places(self, skin=-1):
        return {name: self.worlds[joint][:3, 3] for name, joint in self.bones(skin).items()}

    def shown(self, weights=True):
        """Per primitive of each node: its places, and weights by joint name where it has a skin."""
        for index, node in enumerate(self.nodes):
            if "mesh" not in node:
                continue
            for primitive in self.root["meshes"][node["mesh"]]["primitives"]:
                count = self.root["accessors"][primitive["attributes"]["POSITION"]]["count"]
                shares = self.weights(node, primitive["attributes"], count) if weights else {}
                yield node, primitive, self.placed(index, primitive), shares

    def placed(self, index, primitive):
        node, attributes = self.nodes[index], primitive["attributes"]
        places = self.accessor(attributes["POSITION"])
        places = np.c_[places, np.ones(len(places))]
        if "skin" in node and "JOINTS_0" in attributes:
            return np.einsum("vij,vj->vi", self.blend(node["skin"], attributes, {}), places)[:, :3]
        return (places @ self.worlds[index].T)[:, :3]

    def weights(self, node, attributes, count):
        if "skin" not in node or "JOINTS_0" not in attributes:
            return {}
        joints = self.root["skins"][node["skin"]]["joints"]
        result = {self.nodes[joint].get("name", f"node {joint}"): np.zeros(count) for joint in joints}
        columns = list(result)
        for number in range(2):
            if f"JOINTS_{number}" not in attributes:
                break
            numbers, shares = self.accessor(attributes[f"JOINTS_{number}"]).astype(int), self.accessor(attributes[f"WEIGHTS_{number}"])
            for k in range(4):
                for j, name in enumerate(columns):
                    result[name] += np.where(numbers[:, k] == j, shares[:, k], 0)
        return result
