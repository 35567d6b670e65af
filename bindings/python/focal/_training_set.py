"""Marked meshes for training."""
from __future__ import annotations

import contextlib
import ctypes
import threading
from typing import Any, Iterator, Mapping, Sequence

from . import _abi
from ._context import Context, context_or_default
from ._handle import Handle, handle_of
from ._library import call, create, library
from ._mesh import NO_VERTEX, Mesh, is_number, marked_point
from ._skeleton import template_text
from ._values import Mark, integer, text


class TrainingSet(Handle):
    """Marked meshes. One thread at a time fills it (others wait), and not while a model is being trained from it.

    landmark_names  1..4096 different names, the landmarks to learn. None: a set of rigged characters (add_rig)
    """

    _kind = "training_set"

    def __init__(self, landmark_names: Sequence[str] | None = None, *, context: Context | None = None) -> None:
        if isinstance(landmark_names, str):
            raise TypeError("landmark_names must be a sequence of str, not one str")
        self._names = [] if landmark_names is None else list(landmark_names)
        if landmark_names is not None and not self._names:
            raise ValueError("landmark_names is empty; leave it out for a set of rigged characters")
        texts = [text(name, "each landmark name") for name in self._names]
        self._changing = threading.Lock()
        self._training = 0
        running = context_or_default(context)
        self._take(create("focal_training_set_create", _abi.focal_training_set, running._handle,
                          (ctypes.c_char_p * len(texts))(*texts) if texts else None, len(texts)), running)

    def _facts(self) -> str:
        kind = f"{len(self._names)} landmarks" if self._names else "rigged characters"
        return f"{kind}, {self.mesh_count} meshes"

    @property
    def landmark_names(self) -> list[str]:
        return list(self._names)

    @property
    def mesh_count(self) -> int:
        """Meshes added so far."""
        return int(library().focal_training_set_mesh_count(self._handle))

    def add(self, mesh: Mesh, marks: Mapping[str, Mark] | Sequence[Mark]) -> None:
        """Adds a mesh with its marks: {name: mark}, or marks in the order of landmark_names.

        A mark is a vertex number, a SurfacePoint, (x, y, z): the nearest point of the surface, or None: absent on this mesh, as are names that a mapping lacks. On
        error the set does not change: ValueError (a name that the set does not know, another number of marks), Error
        with Status.INVALID_LANDMARK (no such vertex or triangle).
        """
        handle_of(mesh, Mesh, "mesh")
        ordered = self._ordered(marks)
        # Marks all by number go in as they are, else all become surface points.
        if all(mark is None or is_number(mark) for mark in ordered):
            numbers = [NO_VERTEX if mark is None else integer(mark, "a vertex number", ctypes.c_uint32)
                       for mark in ordered]
            add = "focal_training_set_add_vertices"
            block: Any = (ctypes.c_uint32 * len(numbers))(*numbers)
        else:
            points = [marked_point(mesh, mark, f"the mark of {name!r}") for mark, name in zip(ordered, self._names)]
            add, block = "focal_training_set_add", (_abi.focal_surface_point * len(points))(*points)
        with self._changed():
            call(add, self._handle, mesh._handle, block, len(ordered))

    def _ordered(self, marks: Any) -> list[Any]:
        if isinstance(marks, Mapping):
            for name in marks:
                if name not in self._names:
                    raise ValueError(f"{name!r} is no landmark of this set: {', '.join(self._names)}")
            return [marks.get(name) for name in self._names]
        if isinstance(marks, (str, bytes)):
            raise TypeError("marks must be a mapping or a sequence, not a text")
        try:
            ordered = list(marks)
        except TypeError:
            raise TypeError(f"marks must be a mapping or a sequence, not {type(marks).__name__}") from None
        if len(ordered) != len(self._names):
            raise ValueError(f"{len(ordered)} marks for {len(self._names)} landmarks; None stands for an absent one")
        return ordered

    def add_rig(self, mesh: Mesh) -> None:
        """Adds a rigged character, loaded from glTF, to a set made without landmark names: landmarks and joints follow
        from its skeleton. One character is enough; several should share one skeleton (joints are matched by name).

        Error: INVALID_ARGUMENT (a set with landmark names; no file kept; no skin), INVALID_FILE.
        """
        handle = handle_of(mesh, Mesh, "mesh")
        with self._changed():
            call("focal_training_set_add_rig", self._handle, handle)

    def set_skeleton(self, skeleton_template: str | Mapping[str, Any] | None) -> None:
        """A skeleton over the marked landmarks, as JSON text or as a mapping (docs/rigs.md): models trained from the set store it, and
        Detection.rig() uses it. None, the default: no skeleton.

        Error: INVALID_ARGUMENT (it names landmarks that the set lacks; a set of rigged characters), INVALID_FILE (not JSON).
        """
        given = template_text(skeleton_template)
        with self._changed():
            call("focal_training_set_set_skeleton", self._handle, None if given is None else text(given, "skeleton_template"))

    def check(self) -> list[str]:
        """Warnings about the rigged characters, as sentences that number them from 1: joints that some of them lack,
        ignored name prefixes, weights that are not numbers, joints all in one place. Model.train still learns from
        these characters. A set with landmark names has no warnings.

        Error: INVALID_ARGUMENT (no character, or characters that share fewer than half of their joints).
        """
        with self._changed():
            call("focal_training_set_check", self._handle)
            count = library().focal_training_set_warning_count(self._handle)
            return self._texts("focal_training_set_warning", count)

    @contextlib.contextmanager
    def _changed(self) -> Iterator[None]:
        with self._changing:
            if self._training:
                raise RuntimeError("the TrainingSet is being trained from; add meshes before or after")
            yield

    @contextlib.contextmanager
    def _trained(self) -> Iterator[Any]:
        with self._changing:
            self._training += 1
        try:
            yield self._handle
        finally:
            with self._changing:
                self._training -= 1
