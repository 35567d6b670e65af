"""The tables and figures of Xia et al. 2016 for both presets, in one page.

    main.py [--quick] OUT.html SET...

A SET is a folder as docs/landmark-format.md describes it. The first set and the set "scape" get every figure, the others the tables,
the symmetry planes and Figs. 8, 9, 12 and 13. --quick: few shapes and small forests.
"""
import pathlib
import sys
import time

import focal

import figures
from drawing import HEAD, section
from experiment import Study

FOR_ALL = figures.extraction, figures.applications
FIGURES = (figures.pipeline, figures.descriptors, figures.symmetry, figures.metrics, figures.regression, figures.by_training, figures.by_votes,
           figures.extraction, figures.few_marks, figures.damage, figures.resolution, figures.applications, figures.missing_parts)


def write_page(path, folders, quick):
    start = time.perf_counter()

    def made(name, make, *given):
        result, title = make(*given), make.__doc__.partition(":")[0]
        print(f"{time.perf_counter() - start:6.1f} s  {name}, {title}", flush=True)
        return section(make.__doc__, *result) if result[0] else ""

    studies = []
    for folder in folders:
        studies.append(Study(folder, quick))
        print(f"{time.perf_counter() - start:6.1f} s  {studies[-1].name}, models", flush=True)
    page = HEAD + "".join(made("all sets", make, studies) for make in (figures.performance, figures.errors, figures.planes))
    for study in studies:
        page += f"<h2>{study.name}, {len(study.train)} training and {len(study.tests)} test shapes</h2>\n"
        has_all = study is studies[0] or study.name == "scape"
        page += "".join(made(study.name, make, study) for make in (FIGURES if has_all else FOR_ALL))
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
