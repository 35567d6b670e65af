"""Is confidence honest? Pools landmarks of clean, spoiled and foreign meshes and compares what was said with what came true.

    confidence.py REPORT...

REPORT: what `focal eval --json` prints, what `focal detect --json` prints of a mesh of another category (no landmark of it
can be right), or what tests/robustness/run.sh --json writes. A landmark is right within 4 edges of its mark.
tests/accuracy/confidence.sh makes the reports.
"""
import json
import sys

import numpy as np


def outcomes(path):
    """Kind of a report, its rows (confidence, is right), and its meshes' (category fit, is own)."""
    with open(path) as file:
        report = json.load(file)
    if "cases" in report:
        spoiled = [c for c in report["cases"] if c["case"] != "clean" and "deviation_edges" not in c]
        return "spoiled", [(c, error is not None and error < 4) for case in spoiled for c, error in case["outcomes"]], []
    if "meshes" in report:
        rows = [(mesh["confidences"][name], error < 4) for mesh in report["meshes"]
                for name, error in mesh["errors_edges"].items()]
        return "clean", rows, [(mesh["category_fit"], True) for mesh in report["meshes"]]
    return "foreign", [(mark["confidence"], False) for mark in report["landmarks"]], [(report["category_fit"], False)]


def auroc(value, truth):
    yes, no = value[truth], value[~truth]
    if not len(yes) or not len(no):
        return float("nan")
    return (yes[:, None] > no).mean() + (yes[:, None] == no).mean() / 2


def line(name, rows):
    confidence, right = np.array([r[0] for r in rows]), np.array([r[1] for r in rows], bool)
    bin_of = np.minimum((confidence * 10).astype(int), 9)
    gap = sum(abs((right[bin_of == b] - confidence[bin_of == b]).sum()) for b in range(10)) / len(rows)
    sure = confidence >= 0.9
    print(f"{name:24} {len(rows):7} {right.mean():7.3f} {gap:7.3f} {auroc(confidence, right):7.3f} {sure.sum():6} "
          f"{right[sure].mean() if sure.any() else float('nan'):7.3f}")


def main(paths):
    by_kind, fits = {}, []
    for path in paths:
        kind, rows, of_meshes = outcomes(path)
        by_kind.setdefault(kind, []).extend(rows)
        fits += of_meshes
    print(f"{'':24} {'marks':>7} {'right':>7} {'ECE':>7} {'AUROC':>7} {'>=0.9':>6} {'right':>7}")
    for kind, rows in sorted(by_kind.items()):
        line(kind, rows)
    line("all", [row for rows in by_kind.values() for row in rows])
    fit, own = np.array([f[0] for f in fits]), np.array([f[1] for f in fits], bool)
    print(f"category fit: {own.sum()} own, {(~own).sum()} foreign meshes, AUROC {auroc(fit, own):.3f}")


main(sys.argv[1:])
