"""The tables and figures of Xia et al. 2016 made anew, for both presets, in one page.

    main.py [--quick] OUT.html SET...

A SET is a folder as docs/landmark-format.md describes it. The first set and the set "scape" get every figure, the others the tables,
the symmetry planes and Figs. 8, 9, 12 and 13. --quick: few shapes and small forests.
"""
import pathlib
import sys
import time

import focal

import methods
import results
from drawing import HEAD, section
from experiment import Study

TABLES = results.performance, results.errors, methods.planes
FOR_ALL = results.extraction, results.segmentation, results.correspondence
FIGURES = (methods.pipeline, methods.adding, methods.descriptors, methods.symmetry, methods.metrics, methods.regression, results.by_training,
           results.by_votes, results.extraction, results.few_marks, results.damage, results.resolution, *FOR_ALL[1:], results.missing_parts)


def write_page(path, folders, quick):
    start, studies = time.perf_counter(), []

    def made(figure, name, given):
        body, values = figure(given)
        print(f"{time.perf_counter() - start:6.1f} s  {name}, {figure.__doc__.partition(':')[0]}", flush=True)
        return section(figure.__doc__, body, values) if body else ""

    for folder in folders:
        studies.append(Study(folder, quick))
        print(f"{time.perf_counter() - start:6.1f} s  {studies[-1].name}, models", flush=True)
    page = HEAD + "<h2>Tables</h2>\n" + "".join(made(figure, "all sets", studies) for figure in TABLES)
    for study in studies:
        page += f"<h2>{study.name}, {len(study.train)} training and {len(study.tests)} test shapes</h2>\n"
        has_all = study is studies[0] or study.name == "scape"
        page += "".join(made(figure, study.name, study) for figure in (FIGURES if has_all else FOR_ALL))
        path.write_text(page, encoding="utf-8")  # what there is so far can be read already


def main():
    words = sys.argv[1:]
    quick = words[:1] == ["--quick"]
    if len(words) < 2 + quick:
        sys.exit("usage: main.py [--quick] OUT.html SET...")
    try:
        write_page(pathlib.Path(words[quick]), words[quick + 1:], quick)
    except (focal.Error, OSError, ValueError) as error:
        sys.exit(f"samples/paper: {error}")


if __name__ == "__main__":
    main()
