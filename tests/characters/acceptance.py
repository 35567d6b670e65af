"""How many characters of games come out usable at once, and how many after a few corrections by hand?

    acceptance.py --focal FOCAL --model MODEL --out FOLDER [--data ../shared/data/wild] [--split dev] [--count N] [--corrections 3]
                  [-- OPTIONS OF FOCAL]

Each humanoid of the split is rigged by the model, whose joints have VRM's names: a stock model. Then the joint that is farthest
from its true place is pinned there (`focal rig --pin`), and again, as somebody would who corrects what looks worst. Printed per round:
  good         characters whose verdict is `good`
  usable       9 of 10 joints within 5 per cent of the height and sides not exchanged; pinned joints are at their places
  both         both of these
  mean         of the mean error of the joints that are not pinned, in per cent of the height
A character is counted once it was usable and good; it is then corrected no more. --count takes so many, evenly spread over the split.
"""
import argparse
import json
import os
import sys

import numpy as np

import evaluate


def vrm_name(common):
    """upperArm.L: leftUpperArm."""
    what, _, side = common.partition(".")
    return {"L": "left", "R": "right"}[side] + what[0].upper() + what[1:] if side else what


class Character:
    def __init__(self, folder, name):
        with open(f"{folder}/{name}.joints.json") as file:
            truth = json.load(file)
        places = {joint["name"]: np.array(joint["position"]) for joint in truth["joints"]}
        self.name, self.path, self.size = name, f"{folder}/{name}.glb", truth["size"]
        self.true = {vrm_name(common): places[own] for common, own in truth["common"].items()}


def rig(arguments, character, pins):
    """The verdict and the joints' places by name; None: refused."""
    command = [arguments.focal, "rig", arguments.model, character.path, "-o", f"{arguments.out}/{character.name}.glb", "--json", "--quiet",
               "--keep-failed", *arguments.options]
    for name in pins:
        command += ["--pin", name + "=" + ",".join(repr(float(x)) for x in character.true[name])]
    code, text, wrong, _ = evaluate.run(command)
    try:
        report = json.loads(text)
        return report["verdict"], {joint["name"]: np.array(joint["position"]) for joint in report["joints"]}
    except (ValueError, KeyError):
        print(f"{character.name}: refused ({code}): {wrong[-300:]}", file=sys.stderr)
        return None


def rounds_of(arguments, character):
    """What each round reached, until the rig is good and usable."""
    pins, rounds = [], []
    for _ in range(arguments.corrections + 1):
        made = rig(arguments, character, pins)
        if made is None:
            return rounds
        verdict, found = made
        known = {name: place for name, place in character.true.items() if name in found}
        off = {name: np.linalg.norm(found[name] - place) / character.size for name, place in known.items() if name not in pins}
        usable = evaluate.compare(found, known, character.size)["usable"]
        rounds.append({"verdict": verdict, "usable": usable, "mean": float(np.mean(list(off.values()))), "pinned": list(pins)})
        if usable and verdict == "good":
            break
        pins.append(max(off, key=off.get))
    return rounds


def reached(rows, number):
    """A character's last round up to this one."""
    return rows[min(number, len(rows) - 1)] if rows else {"verdict": "failed", "usable": False, "mean": float("nan")}


def table(results, corrections):
    lines = [f"{'corrected':>9} {'good':>9} {'usable':>9} {'both':>9} {'mean, %':>8}"]
    for number in range(corrections + 1):
        rows = [reached(rounds, number) for rounds in results.values()]
        shares = [sum(one["verdict"] == "good" for one in rows), sum(one["usable"] for one in rows),
                  sum(one["usable"] and one["verdict"] == "good" for one in rows)]
        cells = " ".join(f"{f'{n} of {len(rows)}':>9}" for n in shares)
        lines.append(f"{number:9d} {cells} {100 * np.nanmean([one['mean'] for one in rows]):8.2f}")
    return "\n".join(lines)


def chosen(arguments):
    with open(f"{arguments.data}/set.json") as file:
        names = [one["mesh"] for one in json.load(file)["files"] if one["split"] == arguments.split and one["category"] == "humanoid"]
    if arguments.count and arguments.count < len(names):
        names = [names[i * len(names) // arguments.count] for i in range(arguments.count)]
    return [Character(f"{arguments.data}/{arguments.split}", name) for name in names]


def self_test():
    assert vrm_name("upperArm.L") == "leftUpperArm" and vrm_name("hips") == "hips"
    good, poor = ({"verdict": v, "usable": v == "good", "mean": m} for v, m in (("good", 0.01), ("check", 0.03)))
    said = table({"a": [good], "b": [poor, good], "c": []}, 1).splitlines()
    assert said[1].split() == "0 1 of 3 1 of 3 1 of 3 2.00".split() and said[2].split() == "1 2 of 3 2 of 3 2 of 3 1.00".split()
    print("names, rounds and table: as expected")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--self-test", action="store_true", help="only the counting, on known numbers")
    parser.add_argument("--focal")
    parser.add_argument("--model", help="a file, or the name of a stock model")
    parser.add_argument("--out", default="build/characters/acceptance")
    parser.add_argument("--data", default=os.environ.get("FOCAL_EVALUATION_DATA", "../shared/data") + "/wild")
    parser.add_argument("--split", default="dev")
    parser.add_argument("--count", type=int, default=0)
    parser.add_argument("--corrections", type=int, default=3)
    parser.add_argument("options", nargs="*", help="after --: passed on to focal, such as --threads 2")
    arguments = parser.parse_args()
    if arguments.self_test:
        return self_test()
    if not arguments.focal or not arguments.model:
        parser.error("--focal and --model are wanted")
    os.makedirs(arguments.out, exist_ok=True)
    results = {}
    for character in chosen(arguments):
        results[character.name] = rounds_of(arguments, character)
        said = "; ".join(f"{one['verdict']}{'' if one['usable'] else ', not usable'} {100 * one['mean']:.1f} %" for one in results[character.name])
        print(f"{character.name}: {said or 'refused'}", file=sys.stderr, flush=True)
    with open(f"{arguments.out}/results.json", "w") as file:
        json.dump(results, file, indent=1)
    print(table(results, arguments.corrections))
    return 0


if __name__ == "__main__":
    sys.exit(main())
