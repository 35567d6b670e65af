#!/usr/bin/env python3
"""Compares what two builds made of the same meshes: landmarks (*.landmarks.json) and rigs (*.rigged.glb), file by file.

usage: compare.py REFERENCE OTHER MESHES [--edges 0.01] [--joints 0.001] [--weights 0.02]
REFERENCE, OTHER: folders of results, each named like its mesh in MESHES. Fails when a landmark is more than --edges mean edges of
its mesh away, a joint more than --joints of the mesh's size, or more than 0.1 % of the vertices have a weight that differs by more
than --weights.
"""
import argparse
import array
import json
import math
import pathlib
import struct
import sys

COMPONENTS = {5121: "B", 5123: "H", 5125: "I", 5126: "f"}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}


class Glb:
    def __init__(self, path: pathlib.Path):
        data = path.read_bytes()
        length = struct.unpack_from("<I", data, 12)[0]
        self.json = json.loads(data[20:20 + length])
        self.binary = data[28 + length:]

    def accessor(self, index: int) -> list[tuple[float, ...]]:
        accessor = self.json["accessors"][index]
        view = self.json["bufferViews"][accessor["bufferView"]]
        kind, width = COMPONENTS[accessor["componentType"]], WIDTHS[accessor["type"]]
        size = width * struct.calcsize(kind)
        stride = view.get("byteStride", size)
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        scale = {"B": 255, "H": 65535}.get(kind, 1) if accessor.get("normalized") else 1
        rows = []
        for i in range(accessor["count"]):
            values = array.array(kind, self.binary[start + i * stride:start + i * stride + size])
            rows.append(tuple(value / scale for value in values) if scale != 1 else tuple(values))
        return rows

    def primitives(self) -> list[dict]:
        return [primitive for mesh in self.json["meshes"] for primitive in mesh["primitives"]]


def mean_edge(mesh: Glb) -> float:
    total, count = 0.0, 0
    for primitive in mesh.primitives():
        points = mesh.accessor(primitive["attributes"]["POSITION"])
        corners = [row[0] for row in mesh.accessor(primitive["indices"])]
        for i in range(0, len(corners) - 2, 3):
            for a, b in ((0, 1), (1, 2), (2, 0)):
                total += math.dist(points[corners[i + a]], points[corners[i + b]])
                count += 1
    return total / count


def size_of(mesh: Glb) -> float:
    points = [point for primitive in mesh.primitives() for point in mesh.accessor(primitive["attributes"]["POSITION"])]
    return max(max(point[axis] for point in points) - min(point[axis] for point in points) for axis in range(3))


def bind_places(mesh: Glb) -> dict[str, list[float]]:
    """Where the inverse bind matrices have each joint: -R^T t of the inverse matrix, up to a uniform scale."""
    places = {}
    for skin in mesh.json.get("skins", []):
        for joint, m in zip(skin["joints"], mesh.accessor(skin["inverseBindMatrices"])):
            scale = m[0] ** 2 + m[1] ** 2 + m[2] ** 2
            place = [-sum(m[4 * row + k] * m[12 + k] for k in range(3)) / scale for row in range(3)]
            places[mesh.json["nodes"][joint].get("name", str(joint))] = place
    return places


def weights_of(mesh: Glb) -> list[dict[int, float]]:
    rows = []
    for primitive in mesh.primitives():
        attributes = primitive["attributes"]
        sets = [n for n in range(4) if f"WEIGHTS_{n}" in attributes]
        parts = [(mesh.accessor(attributes[f"JOINTS_{n}"]), mesh.accessor(attributes[f"WEIGHTS_{n}"])) for n in sets]
        for i in range(len(parts[0][0]) if parts else 0):
            row: dict[int, float] = {}
            for joints, weights in parts:
                for joint, weight in zip(joints[i], weights[i]):
                    row[joint] = row.get(joint, 0.0) + weight
            rows.append(row)
    return rows


def share_that_differs(one: list[dict[int, float]], other: list[dict[int, float]], tolerance: float) -> float:
    if len(one) != len(other):
        return 1.0
    differing = sum(any(abs(a.get(joint, 0.0) - b.get(joint, 0.0)) > tolerance for joint in a.keys() | b.keys())
                    for a, b in zip(one, other))
    return differing / max(len(one), 1)


def main() -> int:
    parser = argparse.ArgumentParser()
    parser.add_argument("reference", type=pathlib.Path)
    parser.add_argument("other", type=pathlib.Path)
    parser.add_argument("meshes", type=pathlib.Path)
    parser.add_argument("--edges", type=float, default=0.01)
    parser.add_argument("--joints", type=float, default=0.001)
    parser.add_argument("--weights", type=float, default=0.02)
    options = parser.parse_args()
    worst_edges = worst_joint = worst_share = 0.0
    landmarks = beyond = rigs = files = 0
    for path in sorted(options.reference.glob("*.landmarks.json")):
        files += 1
        edge = mean_edge(Glb(options.meshes / (path.name.removesuffix(".landmarks.json") + ".glb")))
        one, other = (json.loads((folder / path.name).read_text(encoding="utf-8"))["landmarks"]
                      for folder in (options.reference, options.other))
        if [mark["name"] for mark in one] != [mark["name"] for mark in other]:
            print(f"{path.name}: other landmarks were found")
            worst_edges = math.inf
            continue
        for a, b in zip(one, other):
            if a.get("position") is None or b.get("position") is None:
                worst_edges = max(worst_edges, 0.0 if a.get("position") == b.get("position") else math.inf)
                continue
            landmarks += 1
            apart = math.dist(a["position"], b["position"]) / edge
            beyond += apart > options.edges
            worst_edges = max(worst_edges, apart)
    for path in sorted(options.reference.glob("*.rigged.glb")):
        rigs += 1
        one, other = Glb(path), Glb(options.other / path.name)
        size, places, others = size_of(one), bind_places(one), bind_places(other)
        if places.keys() != others.keys():
            print(f"{path.name}: other joints")
            worst_joint = math.inf
            continue
        worst_joint = max([worst_joint] + [math.dist(places[name], others[name]) / size for name in places])
        worst_share = max(worst_share, share_that_differs(weights_of(one), weights_of(other), options.weights))
    print(f"{landmarks} landmarks of {files} meshes: at most {worst_edges:.4f} edges apart, {beyond} beyond {options.edges}; {rigs} rigs: joints at most "
          f"{worst_joint:.6f} of the size apart, {100 * worst_share:.2f} % of the vertices of a mesh with other weights")
    fits = worst_edges <= options.edges and worst_joint <= options.joints and worst_share <= 0.001
    return 0 if files + rigs > 0 and fits else 1


if __name__ == "__main__":
    sys.exit(main())
