"""A set of marked meshes, the models of it and what they find on its test shapes: what all tables and figures share."""
import collections
import math
import time

import focal
import numpy as np

from drawing import BLUE, GREEN, picture, view_of
from printed import KINDS

PRESETS = ("paper", "default")


class Shape:
    """A mesh with its marks: surface points by landmark."""

    def __init__(self, mesh, marks):
        self.mesh, self.edge = mesh, mesh.info["mean_edge_length"]  # errors are in edges
        self.marks = {name: mesh.point_at_vertex(mark) if isinstance(mark, int) else mesh.closest_point(mark) if len(mark) == 3 else mark
                      for name, mark in marks.items() if mark is not None}
        self.places = {name: mesh.position_of(mark) for name, mark in self.marks.items()}

    def view(self, *landmarks):
        """Of some landmarks, or of all."""
        return view_of(self.mesh, *(self.places[name] for name in landmarks or self.places))

    def changed(self, vertices, faces, scale=(1, 1, 1)):
        """The places are where they were, but for the scale."""
        result = Shape(focal.Mesh(vertices, faces), {})
        result.edge = self.edge * np.prod(scale)**(1 / 3)
        result.places = {name: tuple(np.multiply(place, scale)) for name, place in self.places.items()}
        return result

    def errors(self, detection, landmarks):
        """Of those that are marked, NaN where one has no place, in mean edge lengths."""
        found = {one.name: one.position or (math.nan,) * 3 for one in detection}
        return [math.dist(found[name], self.places[name]) / self.edge for name in landmarks if name in self.places]


class StageClock:
    """Seconds by stage of a call that it is the on_progress of."""

    def __init__(self):
        self.seconds, self.stage, self.last = collections.Counter(), "", time.perf_counter()

    def __call__(self, _, stage):
        now = time.perf_counter()
        self.seconds[self.stage] += now - self.last
        self.stage, self.last = stage, now


def learn(shapes, landmarks, clock=None, **parameters):
    """parameters: of focal.Model.train."""
    marked = focal.TrainingSet(landmarks)
    for shape in shapes:
        marked.add(shape.mesh, [shape.marks.get(name) for name in landmarks])
    # Where a landmark is found does not depend on the learned confidence.
    return focal.Model.train(marked, learn_confidence=False, on_progress=clock, **parameters)


def vote_picture(detection, shape, landmark, label, view=None):
    found = detection[landmark].position
    marks = [(shape.places[landmark], GREEN, "hollow")] + ([(found, BLUE)] if found else [])
    return picture(shape.mesh, f"{label}: {shape.errors(detection, [landmark])[0]:.1f}", view or shape.view(landmark),
                   detection.votes(landmark), marks)


class Study:
    """One set. models, found (a detection for each test shape) and clocks of training are by preset."""

    def __init__(self, folder, quick):
        marked = focal.MarkedSet.load(folder)
        is_sample_hand = marked.name == "hand" and "thumbTip" in marked.landmark_names
        self.quick, self.name, self.mirror = quick, "sample hand" if is_sample_hand else marked.name, marked.mirror
        self.kinds = KINDS.get(self.name, ([], marked.landmark_names, []))
        self.landmarks = sum(self.kinds, [])
        # One of each kind, of pairs the left one. The first is the harder one where it has a mirror image.
        self.examples = [next((name for name in kind if name.endswith(".L")), kind[-1]) for kind in self.kinds[:2] if kind] + self.kinds[2][:1]
        self.train, self.tests = ([Shape(marked.mesh(name), marked.marks(name)) for name in marked.meshes(split)[:count]]
                                  for split, count in (("train", 4 if quick else 10), ("test", 2 if quick else 4)))
        if not self.tests:
            raise ValueError(f"{folder} has no test mesh")
        self.test, self.clocks = self.tests[0], {preset: StageClock() for preset in PRESETS}
        self.models = {preset: learn(self.train, self.landmarks, self.clocks[preset], preset=preset) for preset in PRESETS}
        self.found = {preset: [model.detect(shape.mesh) for shape in self.tests] for preset, model in self.models.items()}
        self.title, self.trees = self.name + quick * " (few shapes)", {"tree_count": 10} if quick else {}  # trees: of models for one figure

    def mean_error(self, preset, landmarks):
        errors = [one for shape, found in zip(self.tests, self.found[preset]) for one in shape.errors(found, landmarks)]
        return np.mean(errors) if errors else math.nan
