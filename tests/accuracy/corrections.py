"""What a correction by hand is worth: the worst landmark of each test mesh is put to its true place, then the next two; how the error of
the others changes. Prints a table for docs/accuracy.md.

    corrections.py --sets FOLDER --models FOLDER [--quality best|interactive] [--limit N] SET...

Models are FOLDER/SET.focal, learned of the training split. Errors x 100 / sqrt(area), straight lines. `same` is the error that the
landmarks which are not fixed had before any was. Needs NumPy and the Python package of the build on PYTHONPATH.
"""
import argparse
import json
import pathlib

import numpy

import focal

STEPS = 3


def marks_of(path):
    """Places by name, and surface points or vertices to fix them at."""
    found = {}
    for entry in json.loads(path.read_text())["landmarks"]:
        if entry.get("status") == "absent" or not entry.get("position"):
            continue
        point = entry.get("vertex")
        if "triangle" in entry:
            point = focal.SurfacePoint(entry["triangle"], tuple(entry["barycentric"]))
        found[entry["name"]] = (numpy.array(entry["position"], float), point)
    return found


class Trial:
    """One mesh: the errors after no, one, two, three corrections."""

    def __init__(self, model, mesh, marks, quality):
        self.scale = 100 / mesh.surface_area ** 0.5
        self.marks, self.names = marks, [name for name in model.landmark_names if name in marks]
        analysis = model.analyse(mesh, quality=quality)
        self.fixed, self.rows, self.turned_absent = {}, [], 0
        before = self.measure(model.detect(analysis, quality=quality, keep_votes=False))
        for _ in range(STEPS):
            worst = max((name for name in self.names if name not in self.fixed), key=lambda name: self.errors[name])
            self.fixed[worst] = marks[worst][1]
            self.measure(model.detect(analysis, quality=quality, keep_votes=False, fixed=self.fixed), before)

    def measure(self, detection, before=None):
        absent = {one.name for one in detection if one.status == focal.LandmarkStatus.ABSENT}
        self.errors = {name: self.scale * numpy.linalg.norm(numpy.array(detection[name].position) - self.marks[name][0])
                       if detection[name].position else 100.0 for name in self.names}
        others = [name for name in self.names if name not in self.fixed]
        first = before or (self.errors, absent)
        now, then = (numpy.mean([errors[name] for name in others]) for errors in (self.errors, first[0]))
        self.rows.append((now, then))
        self.turned_absent += len((absent - first[1]) & set(others))
        return self.errors, absent


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--sets", type=pathlib.Path, required=True)
    parser.add_argument("--models", type=pathlib.Path, required=True)
    parser.add_argument("--quality", default="best")
    parser.add_argument("--limit", type=int, default=10)
    parser.add_argument("--split", default="test")
    parser.add_argument("set", nargs="+")
    options = parser.parse_args()
    print("| set | meshes | no correction | " + " | ".join(f"{k} fixed (same)" for k in range(1, STEPS + 1)) + " | turned absent |")
    print("|---|" + "---|" * (STEPS + 3))
    all_rows, absent = [], 0
    for name in options.set:
        folder, model = options.sets / name, focal.Model.load(options.models / f"{name}.focal")
        meshes = json.loads((folder / "set.json").read_text())[options.split][:options.limit]
        trials = [Trial(model, focal.Mesh.load(folder / f"{mesh}.glb"), marks_of(folder / f"{mesh}.landmarks.json"),
                        options.quality) for mesh in meshes]
        all_rows += [trial.rows for trial in trials]
        absent += sum(trial.turned_absent for trial in trials)
        line(name, [trial.rows for trial in trials], sum(trial.turned_absent for trial in trials))
    line("all", all_rows, absent)


def line(name, rows, absent):
    mean = numpy.mean(numpy.array(rows), axis=0)
    print(f"| {name} | {len(rows)} | {mean[0][0]:.2f} | "
          + " | ".join(f"{now:.2f} ({then:.2f})" for now, then in mean[1:]) + f" | {absent} |", flush=True)


if __name__ == "__main__":
    main()
