"""Runs every case of the folder of cases as a user would and compares with its right answer. Prints a table; fails where one is wrong.

    run.py --focal FOCAL --quick-model FOCAL_QUICK_MODEL --characters FOLDER --out FOLDER [--tools FOLDER] [--only NAME] [--models FOLDER]

The cases lie beside the folder that FOCAL_EVALUATION_DATA names, as `cases`; without them it ends with 77. --characters: sample
characters, `focal_creatures FOLDER --family humanoid`. --tools: where node_modules of the viewers lie; what was written is judged by
them too. --only: cases whose names have this in them. --models: where models of an earlier run of the same focal lie, and this one's
are put. A case of the folder that is unknown here is a failure. focal's Python package is found through PYTHONPATH.
"""
import argparse
import os
import shutil
import subprocess
import sys
import time
import traceback

import files
import motion
import shown
from lab import KNOWN, RIGHT, WRONG, Case, Lab

CASES = {**motion.CASES, **shown.CASES, **files.CASES}
HERE = os.path.dirname(os.path.abspath(__file__))


def run(lab, name):
    start = time.monotonic()
    try:
        CASES[name](Case(lab, name))
    except Exception:  # the other cases are of interest too
        lab.add(name, "it runs", traceback.format_exc().strip().split("\n")[-1], WRONG)
    print_results(lab, name, time.monotonic() - start)


def print_results(lab, name, seconds):
    for case, what, figure, state in lab.results:
        if case == name:
            print(f"{name:22} {state:10} {what}{': ' if figure else ''}{figure}")
    print(f"{name:22} {seconds:.1f} s", flush=True)


def node_modules(tools):
    return tools and shutil.which("node") and os.path.isdir(os.path.join(tools, "node_modules", "gltf-validator"))


def judge_written(lab, tools):
    """By the Khronos validator and three.js."""
    if not node_modules(tools):
        print("viewers: skipped: node or its packages are missing; .ci/bootstrap.sh ci fetches them")
        return
    judged = lab.result("list")
    with open(judged, "w") as file:
        file.writelines("\t".join(line) + "\n" for line in lab.written)
    environment = {**os.environ, "FOCAL_VIEWERS": tools}
    viewers = os.path.join(HERE, "..", "viewers")
    checks = [("all that was rigged", ["check.mjs", judged])]
    faces = [path for path, mesh, _ in lab.written if mesh.endswith("face.glb")]
    checks += [("face: three.js has an influence of 1 at 1 s", ["influence.mjs", path, "smile", "1", "1"]) for path in faces]
    for what, (script, *arguments) in checks:
        done = subprocess.run(["node", os.path.join(viewers, script), *arguments], env=environment, capture_output=True, text=True)
        print(done.stdout, end="")
        lab.add("viewers", what, done.stderr.strip()[-200:], RIGHT if done.returncode == 0 else WRONG)
    print_results(lab, "viewers", 0)


def main():
    parser = argparse.ArgumentParser()
    for name in ("--focal", "--quick-model", "--characters", "--out"):
        parser.add_argument(name, required=True)
    parser.add_argument("--tools")
    parser.add_argument("--only")
    parser.add_argument("--models")
    options = parser.parse_args()
    data = os.environ.get("FOCAL_EVALUATION_DATA", "")
    folder = os.path.join(data, "..", "cases")
    if not data or not os.path.isdir(folder):
        print("cases: skipped: no folder 'cases' beside FOCAL_EVALUATION_DATA")
        return 77
    shutil.rmtree(options.out, ignore_errors=True)
    lab = Lab(options.focal, options.quick_model, folder, options.characters, data, options.out, options.models)
    there = {name for name in os.listdir(folder) if os.path.isdir(os.path.join(folder, name))}
    for name in sorted(there - set(CASES)):
        lab.add(name, "is known here", "", WRONG)
        print_results(lab, name, 0)
    for name in sorted(there & set(CASES)):
        if not options.only or options.only in name:
            run(lab, name)
    if not options.only:
        judge_written(lab, options.tools)
    states = [state for *_, state in lab.results]
    print(f"cases: {len(there)} cases, {len(states)} answers: {states.count(RIGHT)} right, {states.count(KNOWN)} known to miss, "
          f"{states.count(WRONG)} wrong")
    return 1 if WRONG in states or not states else 0


sys.exit(main())
