"""Coverage of what reads foreign bytes and of the C interface, from what llvm-cov exports.

A branch is one way that a condition of the source goes: each operand of && and ||, each if, loop, ?: and case counts twice.
What an exception does and what the compiler adds by itself (clean-up, guards of statics) is no condition and is not counted.
Conditions that are settled when the code is compiled are left out: they cannot go another way.
usage: report.py COVERAGE.json [LEAST_PERCENT] [--missing]
"""
import collections
import fnmatch
import json
import pathlib
import sys

numbers = [a for a in sys.argv[2:] if not a.startswith("--")]
least = float(numbers[0]) if numbers else 90
root = pathlib.Path(__file__).resolve().parents[2]
GROUPS = {"src/gltf/*": "gltf", "src/base/archive.*": "model file", "src/base/utf8.*": "model file", "src/model/*_file.*": "model file", "src/analysis/*_file.*": "model file", "capi/*": "capi"}


def group_of(name):
    return next((group for pattern, group in GROUPS.items() if fnmatch.fnmatch(name, pattern)), None)


def lines_of(segments):
    """Whether a line is reached, by the regions that begin on it or that hold its beginning."""
    reached, current = {}, None
    by_line = collections.defaultdict(list)
    for line, _, count, has_count, *_ in segments:
        by_line[line].append(count if has_count else None)
    for line in range(1, max(by_line, default=0) + 1):
        counts = [c for c in [current, *by_line[line]] if c is not None]
        if counts:
            reached[line] = max(counts) > 0
        current = by_line[line][-1] if by_line[line] else current
    return reached


def main():
    exported = pathlib.Path(sys.argv[1]).resolve()
    reached, ways = collections.defaultdict(collections.Counter), collections.defaultdict(collections.Counter)
    for file in json.loads(exported.read_text())["data"][0]["files"]:
        path = (exported.parent / file["filename"]).resolve()  # relative ones are of the build
        name = path.relative_to(root).as_posix() if root in path.parents else ""
        if not group_of(name):
            continue
        source = path.read_text().splitlines()
        reached[name].update(lines_of(file["segments"]))
        for line, column, _, _, taken, not_taken, *_ in file["branches"]:  # instances of a template are one
            if "if constexpr" not in source[line - 1]:
                ways[name].update({(line, column, True): taken, (line, column, False): not_taken})
    totals = collections.defaultdict(lambda: [0, 0, 0, 0])
    for name, lines in sorted(reached.items()):
        row = [sum(c > 0 for c in lines.values()), len(lines), sum(c > 0 for c in ways[name].values()), len(ways[name])]
        totals[group_of(name)] = [a + b for a, b in zip(totals[group_of(name)], row)]
        tell(name, row)
        for (line, column, way), count in sorted(ways[name].items()):
            if "--missing" in sys.argv and not count:
                text = (root / name).read_text().splitlines()[line - 1].strip()
                print(f"    {line}:{column} never {'true' if way else 'false'}:  {text}")
    failed = [tell(group, row) < least for group, row in totals.items()]
    print(f"wanted: {least:g} % of the branches of each")
    sys.exit(any(failed))


def tell(name, row):
    reached, lines, taken, ways = row
    percent = 100 * taken / ways if ways else 100
    print(f"{name:36} lines {reached:5}/{lines:5} {100 * reached / max(lines, 1):5.1f} %   "
          f"branches {taken:5}/{ways:5} {percent:5.1f} %")
    return percent


main()
