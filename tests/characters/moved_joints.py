"""Do weights follow joints that were moved by hand? Every joint of a rigged character is moved by 2 % of the height, `focal rig
--keep-skeleton` weighs it anew, and both are bent by the same rotations.

    moved_joints.py --focal FOCAL --out FOLDER FILE.rig.glb ...

Per file and over all: how far vertices lie, in the mean and at the 95th percentile, in per cent of the height, from where the
character's own joints and weights take them. Pivots that lie 2 % off account for a part of it: that part is what the artist's own
weights give with the moved joints.
"""
import argparse
import json
import os
import struct
import sys

import numpy as np

import evaluate
import glb

MOVED = 0.02
BEND = np.radians(20)  # standard deviation of the angle at each joint


def shifts(file, rng):
    """{joint: how far it moves}"""
    places = file.mesh()[0]
    height = (np.nanmax(places, 0) - np.nanmin(places, 0)).max()
    result = {}
    for joint in file.joints():
        way = rng.normal(size=3)
        result[joint] = MOVED * height * way / np.linalg.norm(way)
    return result, height


def moved_copy(file, shift, path):
    """The file with its joints moved and its surface as it stands."""
    root = json.loads(json.dumps(file.root))
    root.pop("animations", None)  # their translations would take the joints back
    worlds = [world.copy() for world in file.worlds]
    for joint, way in shift.items():
        worlds[joint][:3, 3] += way
    for index, node in enumerate(root["nodes"]):
        parent = file.parents.get(index)
        local = worlds[index] if parent is None else np.linalg.inv(worlds[parent]) @ worlds[index]
        if index in shift or parent in shift:
            if "matrix" in node:
                node["matrix"] = local.T.ravel().tolist()
            else:
                node["translation"] = local[:3, 3].tolist()
    more = b""
    for skin in root.get("skins", []):
        count = len(skin["joints"])
        inverse = np.tile(np.eye(4), (count, 1, 1))
        if "inverseBindMatrices" in skin:
            inverse = file.accessor(skin["inverseBindMatrices"]).reshape(-1, 4, 4).transpose(0, 2, 1)
        new = np.array([np.linalg.inv(worlds[j]) @ file.worlds[j] @ inverse[i] for i, j in enumerate(skin["joints"])])
        skin["inverseBindMatrices"] = len(root["accessors"])
        root["accessors"].append({"bufferView": len(root["bufferViews"]), "componentType": 5126, "count": count, "type": "MAT4"})
        root["bufferViews"].append({"buffer": 0, "byteOffset": len(file.bin) + len(more), "byteLength": 64 * count})
        more += new.transpose(0, 2, 1).astype("<f4").tobytes()
    body = file.bin.tobytes() + more
    root["buffers"][0]["byteLength"] = len(body)
    text = json.dumps(root).encode()
    text += b" " * (-len(text) % 4)
    with open(path, "wb") as out:
        out.write(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(body)) + struct.pack("<I4s", len(text), b"JSON") + text +
                  struct.pack("<I4s", len(body), b"BIN\0") + body)


def bends(file, rotations):
    """World matrices that the same rotations about its own joints give."""
    result = {}
    for joint in file.joints():
        above = file.parents.get(joint)
        while above is not None and above not in result:
            above = file.parents.get(above)
        place, about = file.worlds[joint][:3, 3], np.eye(4)
        if above is not None:  # roots stay
            about[:3, :3] = rotations[joint]
            about[:3, 3] = place - rotations[joint] @ place
        result[joint] = (result[above] if above is not None else np.eye(4)) @ about
    return result


def random_rotations(joints, rng):
    result = {}
    for joint in joints:
        axis = rng.normal(size=3)
        half = BEND * rng.normal() / 2
        result[joint] = glb.turn([*(np.sin(half) * axis / np.linalg.norm(axis)), np.cos(half)])
    return result


def distances(file, path, out, focal, rng):
    shift, height = shifts(file, rng)
    rotations = random_rotations(shift, rng)
    moved_copy(file, shift, path)
    code, _, wrong, _ = evaluate.run([focal, "rig", "--keep-skeleton", path, "-o", out, "--quiet"])
    if code:
        return wrong[-200:]
    truth = file.mesh(bends(file, rotations))[0]
    by_artist, by_focal = (glb.File(one) for one in (path, out))
    found = [100 * np.linalg.norm(one.mesh(bends(one, rotations))[0] - truth, axis=1) / height for one in (by_focal, by_artist)]
    return [one[np.isfinite(one)] for one in found]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--focal", required=True)
    parser.add_argument("--out", default="build/characters/moved_joints")
    parser.add_argument("files", nargs="+")
    arguments = parser.parse_args()
    os.makedirs(arguments.out, exist_ok=True)
    rows = []
    for path in arguments.files:
        name = os.path.basename(path)[:-4]
        file = glb.File(path)
        if not file.joints():
            continue
        found = distances(file, f"{arguments.out}/{name}.moved.glb", f"{arguments.out}/{name}.glb", arguments.focal,
                          np.random.default_rng(len(rows)))
        if isinstance(found, str):
            print(f"{name:32} refused: {found}", flush=True)
            continue
        rows.append([found[0].mean(), np.percentile(found[0], 95), found[1].mean()])
        print(f"{name:32} {rows[-1][0]:5.2f} %  95 % of vertices {rows[-1][1]:5.2f}  by the artist's weights {rows[-1][2]:5.2f}", flush=True)
    if rows:
        mean, median, worst = np.mean(rows, 0), np.median(rows, 0), np.max(rows, 0)
        print(f"{len(rows)} files: {mean[0]:.2f} % of the height, median {median[0]:.2f}, worst {worst[0]:.2f}; 95 % of vertices {mean[1]:.2f}; "
              f"by the artist's weights {mean[2]:.2f}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
