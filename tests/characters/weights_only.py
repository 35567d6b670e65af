"""How near do the weights of `focal rig --keep-skeleton` come to those that artists gave their characters?

    weights_only.py --focal FOCAL --out FOLDER FILE.rig.glb ... [-- OPTIONS OF FOCAL]

Per file: the mean over vertices of the sum of absolute differences of weights (L1: 0 the same, 2 nothing in common), by joints of the
file's own skins, and the share of vertices with the same main joint. Fails (1) where a joint of a written file is not what it was, to the bit.
"""
import argparse
import os
import sys

import numpy as np

import evaluate
import glb


def skinned(file):
    """Per primitive with a skin: weights of its vertices by node, (vertices, nodes)."""
    for node in file.nodes:
        if "mesh" not in node or "skin" not in node:
            continue
        joints_of = np.array(file.root["skins"][node["skin"]]["joints"])
        for primitive in file.root["meshes"][node["mesh"]]["primitives"]:
            attributes = primitive["attributes"]
            if "JOINTS_0" in attributes:
                yield rows(file, attributes, joints_of)


def rows(file, attributes, joints_of):
    result = np.zeros((file.root["accessors"][attributes["POSITION"]]["count"], len(file.nodes)))
    for number in (0, 1):
        if f"JOINTS_{number}" in attributes:
            joints = file.accessor(attributes[f"JOINTS_{number}"]).astype(int)
            weights = file.accessor(attributes[f"WEIGHTS_{number}"])
            np.add.at(result, (np.arange(len(result))[:, None], joints_of[joints]), weights)
    total = result.sum(1, keepdims=True)
    return result / np.where(total > 0, total, 1)


def differences(before, after):
    """L1 of every vertex, and whether its main joint is the same."""
    l1, same = [], []
    for one, other in zip(skinned(before), skinned(after)):
        used = one.sum(1) > 0
        l1.append(np.abs(one - other).sum(1)[used])
        same.append((one.argmax(1) == other.argmax(1))[used])
    return (np.concatenate(l1), np.concatenate(same)) if l1 else (np.zeros(0), np.zeros(0))


def same_joints(before, after):
    joints = [skin["joints"] for skin in before.root.get("skins", [])]
    binds = [[f.accessor(skin["inverseBindMatrices"]) for skin in f.root["skins"] if "inverseBindMatrices" in skin] for f in (before, after)]
    return (joints == [skin["joints"] for skin in after.root["skins"]][:len(joints)] and
            all((a == b).all() for a, b in zip(*binds)) and
            all(before.nodes[j] == after.nodes[j] for skin in joints for j in skin))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--focal", required=True)
    parser.add_argument("--out", default="build/characters/weights_only")
    parser.add_argument("files", nargs="+")
    arguments = parser.parse_args()
    os.makedirs(arguments.out, exist_ok=True)
    means, sames, moved = [], [], []
    for path in arguments.files:
        name = os.path.basename(path)[:-4]
        out = f"{arguments.out}/{name}.glb"
        code, _, wrong, seconds = evaluate.run([arguments.focal, "rig", "--keep-skeleton", path, "-o", out, "--quiet"])
        if code:
            print(f"{name:32} refused: {wrong[-200:]}", flush=True)
            continue
        before, after = glb.File(path), glb.File(out)
        l1, same = differences(before, after)
        if not len(l1):
            print(f"{name:32} no weights", flush=True)
            continue
        if not same_joints(before, after):
            moved.append(name)
        means.append(l1.mean()), sames.append(same.mean())
        print(f"{name:32} L1 {l1.mean():.3f}  same main joint {100 * same.mean():3.0f} %  {seconds:.1f} s", flush=True)
    print(f"{len(means)} files: L1 {np.mean(means):.3f}, median {np.median(means):.3f}; same main joint {100 * np.mean(sames):.0f} %; "
          f"joints changed: {', '.join(moved) or 'none'}")
    return 1 if moved else 0


if __name__ == "__main__":
    sys.exit(main())
