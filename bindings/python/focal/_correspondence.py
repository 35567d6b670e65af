"""A map between two detected meshes."""
from __future__ import annotations

import array
from typing import Any

from . import _abi
from ._arrays import Floats, Numbers, block_of, empty, numpy, result
from ._handle import Handle
from ._library import call


class Correspondence(Handle):
    """A point of the target's mesh for every vertex of the source's, from Detection.correspond."""

    _kind = "correspondence"
    _counts = (0, 0)  # vertices of source and target

    def __init__(self) -> None:
        raise TypeError("make a Correspondence with Detection.correspond")

    def _facts(self) -> str:
        return f"from {self._counts[0]} to {self._counts[1]} vertices"

    @property
    def points(self) -> tuple[Numbers, Floats]:
        """(triangles, barycentric): (n,) triangle numbers of the target, NO_TRIANGLE where no triangle uses the
        source's vertex, and (n, 3) weights of their corners."""
        count = self._counts[0]
        room: Any = (_abi.focal_surface_point * count)()
        call("focal_correspondence_points", self._handle, count, room)
        if numpy is not None:
            rows: Any = numpy.frombuffer(room, numpy.dtype([("triangle", numpy.uint32), ("weights", numpy.float32, 3)]))
            return rows["triangle"].copy(), rows["weights"].copy()
        plain: Any = [tuple(p.barycentric) for p in room]
        return array.array("I", [p.triangle for p in room]), plain

    def carry(self, values: Any) -> Floats:
        """Values of the target's vertices, (m,) or (m, k) numbers, transferred to the source's, (n,) or (n, k) floats;
        0 where no triangle uses a vertex. carry(target.vertices) is where each source vertex goes."""
        width = _width(values)
        given = block_of(values, "values", "f", width)
        source, target = self._counts
        if given.rows != target:
            raise ValueError(f"values has {given.rows} rows, the target has {target} vertices")
        if width == 1:
            return self._carry_one(given.pointer, source, target)
        columns: list[Any] = []
        for column in range(width):
            one = block_of(given.owner[column::width], "values", "f", 1)
            columns.append(self._carry_one(one.pointer, source, target))
        carried: Floats = numpy.stack(columns, 1) if numpy is not None else list(zip(*columns))
        return carried

    def _carry_one(self, pointer: Any, source: int, target: int) -> Floats:
        room = empty("f", source)
        call("focal_correspondence_carry", self._handle, target, pointer, source, room.pointer)
        carried: Floats = room.owner
        return carried


def _width(values: Any) -> int:
    """Numbers a row, by the shape or the first row; 1 for what is flat."""
    shape = getattr(values, "shape", None)
    if isinstance(shape, tuple):
        return int(shape[1]) if len(shape) == 2 else 1
    try:
        return max(1, len(values[0]))
    except (TypeError, IndexError, KeyError):
        return 1
