"""Reads the meshes and skeletons of a binary glTF file: .glb with float or integer accessors, sparse ones left out."""
import json
import struct

import numpy as np

KINDS = {5120: "i1", 5121: "u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}


def turn(quaternion):
    x, y, z, w = np.asarray(quaternion, float) / np.linalg.norm(quaternion)
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


class File:
    def __init__(self, path):
        with open(path, "rb") as file:
            data = file.read()
        if data[:4] != b"glTF":
            raise ValueError(f"{path} is no .glb file")
        size = struct.unpack("<I", data[12:16])[0]
        self.root, self.bin = json.loads(data[20:20 + size]), np.frombuffer(data[28 + size:], np.uint8)
        self.nodes = self.root.get("nodes", [])
        self.parents = {child: index for index, node in enumerate(self.nodes) for child in node.get("children", [])}
        self.worlds = [self.world(index) for index in range(len(self.nodes))]

    def accessor(self, index):
        a = self.root["accessors"][index]
        kind, width = np.dtype(KINDS[a["componentType"]]), WIDTHS[a["type"]]
        if "bufferView" not in a:
            return np.zeros((a["count"], width))
        view = self.root["bufferViews"][a["bufferView"]]
        stride = view.get("byteStride", kind.itemsize * width)
        start = view.get("byteOffset", 0) + a.get("byteOffset", 0)
        rows = start + stride * np.arange(a["count"])[:, None] + np.arange(kind.itemsize * width)
        values = np.ascontiguousarray(self.bin[rows]).view(kind).reshape(a["count"], width).astype(float)
        return values / np.iinfo(kind).max if a.get("normalized") else values

    def local(self, index):
        node = self.nodes[index]
        if "matrix" in node:
            return np.array(node["matrix"], float).reshape(4, 4).T
        result = np.eye(4)
        result[:3, :3] = turn(node.get("rotation", [0, 0, 0, 1])) * np.array(node.get("scale", [1, 1, 1]), float)
        result[:3, 3] = node.get("translation", [0, 0, 0])
        return result

    def world(self, index):
        result = self.local(index)
        while index in self.parents:
            index = self.parents[index]
            result = self.local(index) @ result
        return result

    def joints(self):
        """Node indices of all joints of all skins, parents first."""
        found = {joint for skin in self.root.get("skins", []) for joint in skin["joints"]}
        return sorted(found, key=lambda index: (self.depth(index), index))

    def depth(self, index):
        return 1 + self.depth(self.parents[index]) if index in self.parents else 0

    def parts(self, bends=None):
        """Per primitive of triangles: places in the world and corners. bends: world matrix by node that moves a joint."""
        for index, node in enumerate(self.nodes):
            for primitive in self.root["meshes"][node["mesh"]]["primitives"] if "mesh" in node else []:
                if primitive.get("mode", 4) != 4 or "POSITION" not in primitive["attributes"]:
                    continue
                places = self.accessor(primitive["attributes"]["POSITION"])
                count = len(places)
                corners = self.accessor(primitive["indices"])[:, 0].astype(int) if "indices" in primitive else np.arange(count)
                places = np.c_[places, np.ones(count)]
                if "skin" in node and "JOINTS_0" in primitive["attributes"]:
                    places = np.einsum("vij,vj->vi", self.blend(node["skin"], primitive["attributes"], bends or {}), places)
                else:
                    places = places @ (self.carried(index, bends or {}) @ self.worlds[index]).T
                yield places[:, :3], corners[:len(corners) // 3 * 3].reshape(-1, 3)

    def carried(self, index, bends):
        """What moves a node without a skin: the joint it hangs on."""
        while index not in bends and index in self.parents:
            index = self.parents[index]
        return bends.get(index, np.eye(4))

    def blend(self, index, attributes, bends):
        skin = self.root["skins"][index]
        inverse = np.tile(np.eye(4), (len(skin["joints"]), 1, 1))
        if "inverseBindMatrices" in skin:
            inverse = self.accessor(skin["inverseBindMatrices"]).reshape(-1, 4, 4).transpose(0, 2, 1)
        moved = np.array([bends.get(j, np.eye(4)) @ self.worlds[j] @ inverse[i] for i, j in enumerate(skin["joints"])])
        joints, weights = self.accessor(attributes["JOINTS_0"]).astype(int), self.accessor(attributes["WEIGHTS_0"])
        if "WEIGHTS_1" in attributes:
            joints = np.hstack([joints, self.accessor(attributes["JOINTS_1"]).astype(int)])
            weights = np.hstack([weights, self.accessor(attributes["WEIGHTS_1"])])
        total = weights.sum(1, keepdims=True)
        return np.einsum("vk,vkij->vij", weights / np.where(total > 0, total, 1), moved[joints])

    def mesh(self, bends=None):
        """All parts as one: places and corners."""
        places, corners, first = [np.zeros((0, 3))], [np.zeros((0, 3), int)], 0
        for p, c in self.parts(bends):
            places.append(p)
            corners.append(c + first)
            first += len(p)
        return np.vstack(places), np.vstack(corners)
