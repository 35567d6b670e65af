"""samples/paper on small shapes: every table and figure is there, in one page that stands alone, with errors that a found landmark can have.

    paper_test.py FOLDER      of focal_make_shapes
"""
import importlib.util
import pathlib
import re
import subprocess
import sys
import unittest

import focal

SOURCE = pathlib.Path(__file__).resolve().parents[2]
TITLES = ["Table 1", "Table 2", "Figs. 1 and 6", "Fig. 2", "Fig. 3 a", "Fig. 3 b", "Fig. 4", "Fig. 5", "Fig. 7 a, b", "Fig. 7 c", "Figs. 8 and 9",
          "Beside Schelling", "Fig. 10", "Fig. 11", "Figs. 12 and 13"]


def write_set(folder):
    shapes = [f"shape_{number}" for number in range(4)]
    marks = {shape: dict(line.split() for line in (folder / f"{shape}.txt").read_text().splitlines()) for shape in shapes}
    # The shapes have no mirror image; Fig. 3 a draws what the set says.
    marked = focal.MarkedSet(folder, list(marks[shapes[0]]), {"train": shapes[:3], "test": shapes[3:]}, "shapes", {"tail": "hand.L"})
    marked.save()
    for shape in shapes:
        marked.put_marks(shape, {name: int(vertex) for name, vertex in marks[shape].items()})


class PaperTest(unittest.TestCase):
    def test_page(self):
        write_set(FOLDER)
        out = FOLDER / "paper.html"
        subprocess.run([sys.executable, SOURCE / "samples/paper/main.py", "--quick", out, FOLDER], check=True)
        page = out.read_text(encoding="utf-8")
        for title in TITLES:
            with self.subTest(title):
                self.assertEqual(page.count(f"<h3>{title}"), 1)
        self.assertEqual(page.count("<img"), page.count('src="data:image/png'))  # nothing is fetched
        self.assertNotIn("nan", re.sub('"data:[^"]*"', "", page))
        self.assertNotRegex(page, "<td>paper<td>0.00<td>0.00<td>0.00")  # training takes time
        captions = re.findall(r"<figcaption>(paper|default), ([^:<]*): ([0-9.]+)</figcaption>", page)
        for preset in ("paper", "default"):
            self.assertGreater(sum(one == preset for one, *_ in captions), 10)
        for preset, what, error in captions:
            self.assertLess(float(error), 4 if (preset, what) == ("default", "clean") else 40)


if __name__ == "__main__":
    if importlib.util.find_spec("matplotlib") is None:
        print("skipped: no matplotlib (on Debian: python3-matplotlib)")
        sys.exit(77)
    FOLDER = pathlib.Path(sys.argv.pop())
    unittest.main()
