"""Coverage by file and in all, from the counters that an instrumented build left behind.

A branch that only an exception takes is left out: gcov marks such edges, which any call that may throw brings along.
usage: report.py BUILD LEAST_PERCENT
"""
import collections
import json
import pathlib
import subprocess
import sys

build, least = pathlib.Path(sys.argv[1]).resolve(), float(sys.argv[2])
root = pathlib.Path(__file__).resolve().parents[2]
lines, branches = collections.defaultdict(dict), collections.defaultdict(dict)  # per file: place -> times taken

counters = sorted(build.rglob("*.gcda"))
if not counters:
    sys.exit("report.py: no counters; was it built with FOCAL_COVERAGE=ON, and did its tests run?")
for counter in counters:
    text = subprocess.run(["gcov", "--json-format", "--branch-probabilities", "--stdout", counter],
                          cwd=build, check=True, capture_output=True, text=True).stdout
    for report in filter(None, text.splitlines()):
        for file in json.loads(report)["files"]:
            path = pathlib.Path(file["file"])
            path = (build / path).resolve() if not path.is_absolute() else path
            if root not in path.parents or not path.relative_to(root).as_posix().startswith(("src/", "capi/")):
                continue
            name = path.relative_to(root).as_posix()
            if path.suffix != ".cpp":
                continue
            for line in file["lines"]:
                number = line["line_number"]
                lines[name][number] = lines[name].get(number, 0) + line["count"]
                # Templates and lambdas come several times; the same edges of each are one branch.
                for index, branch in enumerate(b for b in line["branches"] if not b["throw"]):
                    place = (number, index)
                    branches[name][place] = branches[name].get(place, 0) + branch["count"]


def share(counts):
    return sum(count > 0 for count in counts), len(counts)


def row(name, line_counts, branch_counts):
    (l, of_l), (b, of_b) = share(line_counts), share(branch_counts)
    percent = lambda part, whole: 100 * part / whole if whole else 100
    print(f"{name:42} lines {l:5}/{of_l:5} {percent(l, of_l):5.1f} %   branches {b:5}/{of_b:5} {percent(b, of_b):5.1f} %")
    return percent(b, of_b)


for name in sorted(lines):
    row(name, lines[name].values(), branches[name].values())
    if "--missing" in sys.argv:
        missing = sorted({place[0] for place, count in branches[name].items() if not count})
        print("    branches not taken on lines", *missing)
total = row("in all", [c for f in lines.values() for c in f.values()], [c for f in branches.values() for c in f.values()])
print(f"{total:.1f} % of the branches are taken, {least:g} % wanted")
sys.exit(total < least)
