"""Learns the landmarks of a set and measures them on its test meshes. A SET is a folder as docs/landmark-format.md describes it:
set.json, and for each mesh NAME.glb and NAME.landmarks.json.

    train.py SET MODEL.focal [KEYWORD=NUMBER...]

A KEYWORD is one of focal.Model.train, such as tree_count=10.
"""
import json
import math
import pathlib
import sys

import focal


def marks_of(mesh, path):
    """{name: mark} of a .landmarks.json; a landmark that is not there is absent."""
    marks = {}
    for one in json.loads(path.read_text(encoding="utf-8"))["landmarks"]:
        if one.get("status") == "absent":
            continue
        if "triangle" in one:
            marks[one["name"]] = focal.SurfacePoint(one["triangle"], one["barycentric"])
        elif "vertex" in one:
            marks[one["name"]] = mesh.point_at_vertex(one["vertex"])
        else:
            sys.exit(f"{path}: {one['name']} has a position only, which this sample does not look up")
    return marks


def train(folder, about, params):
    marked = focal.TrainingSet(about["landmark_names"])
    for name in about["train"]:
        mesh = focal.Mesh.load(folder / f"{name}.glb")
        marked.add(mesh, marks_of(mesh, folder / f"{name}.landmarks.json"))
    model = focal.Model.train(marked, on_progress=lambda progress, stage: print(
        f"\r{progress:4.0%} {stage:20}", end="", file=sys.stderr), **params)
    print(file=sys.stderr)
    return model


def measure(folder, about, model):
    for name in about["test"]:
        mesh = focal.Mesh.load(folder / f"{name}.glb")
        marks, edge = marks_of(mesh, folder / f"{name}.landmarks.json"), mesh.info["mean_edge_length"]
        errors = [math.dist(landmark.position, mesh.position_of(marks[landmark.name])) / edge
                  for landmark in model.detect(mesh) if landmark.name in marks and landmark.position]
        print(f"{name}: {len(errors)} landmarks, mean error {sum(errors) / max(1, len(errors)):.2f} edges")


def main():
    if len(sys.argv) < 3:
        sys.exit("usage: train.py SET MODEL.focal [KEYWORD=NUMBER...]")
    folder = pathlib.Path(sys.argv[1])
    about = json.loads((folder / "set.json").read_text(encoding="utf-8"))
    try:
        model = train(folder, about, {name: json.loads(value) for name, value in
                                      (given.split("=", 1) for given in sys.argv[3:])})
        model.save(sys.argv[2])
        measure(folder, about, model)
    except focal.Error as error:
        sys.exit(str(error))


if __name__ == "__main__":
    main()
