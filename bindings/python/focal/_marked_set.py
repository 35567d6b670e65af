"""Sets of marked meshes in folders, and the errors of models on them."""
from __future__ import annotations

import json
import math
import os
import pathlib
from dataclasses import dataclass, field
from statistics import fmean, median
from typing import Any, Callable, Iterable, Mapping

from ._detection import Detection
from ._landmark_files import read_landmarks, write_landmarks, write_text
from ._mesh import Mesh, marked_point
from ._model import Model
from ._task import Progress
from ._training_set import TrainingSet
from ._values import Mark, point_of

_SPLITS = ("train", "test", "extra")


@dataclass(frozen=True)
class MarkError:
    """How far a landmark was found from its mark."""

    mesh: str
    landmark: str
    error: float       # a length, in the mesh's units; infinite where it has no place at all
    edges: float       # the same in mean edge lengths of the mesh
    confidence: float  # as the Landmark's
    absent: bool       # the model calls it absent


@dataclass(frozen=True)
class Evaluation:
    """What an evaluation or a cross-validation found: an error for each mark, in the order of the meshes."""

    errors: list[MarkError]

    @property
    def mean_edges(self) -> float:
        """Mean error in edge lengths; NaN without a mark."""
        return fmean(one.edges for one in self.errors) if self.errors else math.nan

    @property
    def median_edges(self) -> float:
        return median(one.edges for one in self.errors) if self.errors else math.nan

    def by_mesh(self) -> dict[str, Evaluation]:
        return self._parted(lambda one: one.mesh)

    def by_landmark(self) -> dict[str, Evaluation]:
        return self._parted(lambda one: one.landmark)

    def _parted(self, key: Callable[[MarkError], str]) -> dict[str, Evaluation]:
        parts: dict[str, list[MarkError]] = {}
        for one in self.errors:
            parts.setdefault(key(one), []).append(one)
        return {name: Evaluation(errors) for name, errors in parts.items()}

    def __repr__(self) -> str:
        return f"<focal.Evaluation {len(self.errors)} marks, mean {self.mean_edges:.2f} edges, median {self.median_edges:.2f}>"


@dataclass
class MarkedSet:
    """A folder of meshes with their marks: set.json, and NAME.glb and NAME.landmarks.json for each mesh (docs/landmark-format.md).

        marked = focal.MarkedSet.load("cats")
        model = focal.Model.train(marked.training_set())
        print(marked.evaluate(model).mean_edges, marked.cross_validate().mean_edges)
    """

    folder: str | os.PathLike[str]
    landmark_names: list[str]
    splits: dict[str, list[str]] = field(default_factory=dict)  # "train", "test", "extra": names of meshes
    name: str = ""
    mirror: dict[str, str] = field(default_factory=dict)        # {"ear.R": "ear.L"}
    others: dict[str, Any] = field(default_factory=dict)        # what else set.json says; it is kept

    @property
    def _place(self) -> pathlib.Path:
        return pathlib.Path(os.fsdecode(self.folder))

    @classmethod
    def load(cls, folder: str | os.PathLike[str]) -> MarkedSet:
        """Reads FOLDER/set.json. ValueError: its content is not valid; OSError."""
        place = pathlib.Path(os.fsdecode(folder))
        try:
            document = json.loads((place / "set.json").read_text(encoding="utf-8-sig"))
            names = _names(document["landmark_names"])
            splits = {split: _names(document[split]) for split in _SPLITS if document.get(split)}
            mirror = {str(one): str(other) for one, other in document.get("mirror", {}).items()}
        except (ValueError, KeyError, TypeError, AttributeError) as error:
            raise ValueError(f"{place / 'set.json'} describes no set: {error!r}") from None
        known = {"name", "landmark_names", "mirror", *_SPLITS}
        return cls(place, names, splits, document.get("name") or place.resolve().name, mirror,
                   {key: value for key, value in document.items() if key not in known})

    def save(self) -> None:
        """Writes set.json, and makes the folder if it does not exist. OSError."""
        self._place.mkdir(parents=True, exist_ok=True)
        document = {"name": self.name or self._place.resolve().name, "landmark_names": self.landmark_names, "mirror": self.mirror,
                    **self.splits, **self.others}
        write_text(self._place / "set.json", json.dumps(document, ensure_ascii=False, indent=1) + "\n")

    def meshes(self, split: str = "train") -> list[str]:
        """Names of a split's meshes; "all": of train and test."""
        if split not in (*_SPLITS, "all"):
            raise ValueError(f"split is {split!r}, not one of: train, test, extra, all")
        return [name for part in (("train", "test") if split == "all" else (split,)) for name in self.splits.get(part, [])]

    def marks(self, mesh: str) -> dict[str, Mark]:
        """Of one mesh; landmarks that its file lacks or calls absent are None. ValueError: a name that the set does not know; OSError."""
        path = self._place / f"{mesh}.landmarks.json"
        found = read_landmarks(path)
        unknown = [name for name in found if name not in self.landmark_names]
        if unknown:
            raise ValueError(f"{path}: {unknown[0]!r} is no landmark of this set")
        return {name: found.get(name) for name in self.landmark_names}

    def put_marks(self, mesh: str, marks: Mapping[str, Mark]) -> None:
        """Writes a mesh's marks beside it."""
        unknown = [name for name in marks if name not in self.landmark_names]
        if unknown:
            raise ValueError(f"{unknown[0]!r} is no landmark of this set: {', '.join(self.landmark_names)}")
        write_landmarks(self._place / f"{mesh}.landmarks.json", marks, mesh=f"{mesh}.glb")

    def mesh(self, name: str) -> Mesh:
        """Errors as Mesh.load."""
        return Mesh.load(self._place / f"{name}.glb")

    def training_set(self, meshes: Iterable[str] | str = "train") -> TrainingSet:
        """Marked meshes to train from: of a split, or of the names given."""
        filled = TrainingSet(self.landmark_names)
        for name in self.meshes(meshes) if isinstance(meshes, str) else meshes:
            filled.add(self.mesh(name), self.marks(name))
        return filled

    def evaluate(self, model: Model, meshes: Iterable[str] | str = "test", *, on_progress: Progress | None = None,
                 **detect: Any) -> Evaluation:
        """How far a model finds the marks of a split, or of the meshes given. detect: parameters of Model.detect. What on_progress
        raises ends it."""
        names = self.meshes(meshes) if isinstance(meshes, str) else list(meshes)
        return Evaluation([one for number, name in enumerate(names) for one in self._errors(
            model, name, {"keep_votes": False, **detect}, _step(on_progress, number, len(names), name))])

    def cross_validate(self, split: str = "train", *, folds: int | None = None, train: Mapping[str, Any] | None = None,
                       detect: Mapping[str, Any] | None = None, on_progress: Progress | None = None) -> Evaluation:
        """Trains without some meshes and measures on those, in turn, as `focal cross-validate` does.

        folds          2 up to the number of meshes. Default: one mesh each, at most 10
        train, detect  parameters of Model.train and Model.detect

        ValueError: fewer than three meshes, or too many folds. Errors as Model.train and Model.detect; what on_progress raises.
        """
        names = self.meshes(split)
        count = _fold_count(folds, len(names))
        steps, done, errors = len(names) + count, 0, []
        for fold in range(count):
            left_out = [name for i, name in enumerate(names) if i * count // len(names) == fold]
            rest = self.training_set(name for name in names if name not in left_out)
            model = Model.train(rest, on_progress=_step(on_progress, done, steps, f"fold {fold + 1}"), **(train or {}))
            done += 1
            for name in left_out:
                errors += self._errors(model, name, {"keep_votes": False, **(detect or {})}, _step(on_progress, done, steps, name))
                done += 1
        return Evaluation(errors)

    def _errors(self, model: Model, name: str, detect: dict[str, Any], on_progress: Progress | None) -> list[MarkError]:
        mesh, marks = self.mesh(name), self.marks(name)
        return _errors_of(name, mesh, marks, model.detect(mesh, on_progress=on_progress, **detect))


def _errors_of(name: str, mesh: Mesh, marks: Mapping[str, Mark], found: Detection) -> list[MarkError]:
    edge, errors = mesh.info["mean_edge_length"], []
    for landmark in found:
        point = point_of(marked_point(mesh, marks.get(landmark.name), f"the mark of {landmark.name!r}"))
        if point is not None:
            place = mesh.position_of(point)
            error = math.inf if landmark.position is None else math.dist(landmark.position, place)
            errors.append(MarkError(name, landmark.name, error, error / edge, landmark.confidence, landmark.absent))
    return errors


def _names(value: Any) -> list[str]:
    if not isinstance(value, list) or not value or not all(isinstance(one, str) for one in value):
        raise ValueError(f"{value!r:.60} is no list of names")
    return list(value)


def _fold_count(folds: int | None, meshes: int) -> int:
    if meshes < 3:
        raise ValueError(f"cross-validation needs at least 3 meshes, not {meshes}")
    if folds is not None and not 2 <= folds <= meshes:
        raise ValueError(f"folds is {folds}, not within 2..{meshes}")
    return folds or min(meshes, 10)


def _step(report: Progress | None, number: int, count: int, what: str) -> Progress | None:
    """Progress of one of several calls as progress of all of them."""
    if report is None:
        return None
    call = report
    return lambda progress, stage: call((number + progress) / count, f"{what}: {stage}" if stage else what)
