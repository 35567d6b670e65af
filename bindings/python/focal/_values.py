"""Python values into structs, texts and paths of focal.h, checked before the call; and structs back."""
from __future__ import annotations

import ctypes
import numbers
import operator
import os
from enum import IntEnum
from typing import Any, NamedTuple, TypeVar, Union

from . import _abi
from ._library import call

Choice = TypeVar("Choice", bound=IntEnum)

_RANGES = {
    ctypes.c_int32: (-2**31, 2**31 - 1),
    ctypes.c_uint32: (0, 2**32 - 1),
    ctypes.c_uint64: (0, 2**64 - 1),
}
# By field; 0..1 the quality of a skeleton is a double, and stays one.
_ENUMS = {"preset": _abi.Preset, "backend": _abi.Backend, "quality": _abi.Quality, "orientation": _abi.Orientation, "surface": _abi.Surface,
          "verdict": _abi.Verdict, "rest_pose": _abi.Pose}


class SurfacePoint(NamedTuple):
    """A point of a mesh's surface: triangle number, and weights (>= 0, sum 1) of its three corners."""

    triangle: int
    barycentric: tuple[float, float, float]


Position = tuple[float, float, float]
Mark = Union[int, SurfacePoint, Position, None]  # of a landmark: a vertex number, a point, the nearest point, absent


def text(value: Any, name: str) -> bytes:
    if not isinstance(value, str):
        raise TypeError(f"{name} must be a str, not {type(value).__name__}")
    if "\0" in value:
        raise ValueError(f"{name} holds a NUL character")
    return value.encode("utf-8")


def path_text(value: Any) -> bytes:
    """A path as UTF-8, the encoding that focal takes on every system."""
    if not isinstance(value, (str, bytes, os.PathLike)):
        raise TypeError(f"path must be a str or os.PathLike, not {type(value).__name__}")
    return text(os.fsdecode(value), "path")


def integer(value: Any, name: str, kind: Any = ctypes.c_int32) -> int:
    """ctypes would wrap a number that does not fit."""
    try:
        number = operator.index(value)
    except TypeError:
        raise TypeError(f"{name} must be an integer, not {type(value).__name__}") from None
    low, high = _RANGES[kind]
    if not low <= number <= high:
        raise ValueError(f"{name} is {number}, not within {low}..{high}")
    return number


def real(value: Any, name: str) -> float:
    if not isinstance(value, numbers.Real):
        raise TypeError(f"{name} must be a number, not {type(value).__name__}")
    return float(value)


def choice(kind: type[Choice], value: Any, name: str) -> Choice:
    """A member, or its name in any case: Quality.BEST, "best"."""
    try:
        if isinstance(value, str):
            return kind[value.upper().replace("-", "_")]
        if isinstance(value, int) and not isinstance(value, bool):
            return kind(value)
    except (KeyError, ValueError):
        names = ", ".join(member.name.lower() for member in kind)
        raise ValueError(f"{name} is {value!r}, not one of: {names}") from None
    raise TypeError(f"{name} must be a focal.{kind.__name__} or its name, not {type(value).__name__}")


def listed(value: Any, names: list[str], name: str) -> int | None:
    """The number of one of the library's names, in any case: "si-hks", Descriptor.SI_HKS, 0."""
    if isinstance(value, str):
        value = value.lower().replace("_", "-")
    elif value is None or (isinstance(value, int) and not isinstance(value, bool)):
        return value
    else:
        raise TypeError(f"{name} must be a name or a number, not {type(value).__name__}")
    if value not in names:
        raise ValueError(f"{name} is {value!r}, not one of: {', '.join(names)}")
    return names.index(value)


def numbered(which: Any, names: list[str]) -> int:
    """The number of a landmark given by name or number; negative numbers count from the end. KeyError, IndexError."""
    if isinstance(which, str):
        if which not in names:
            raise KeyError(which)
        return names.index(which)
    try:
        number = operator.index(which)
    except TypeError:
        raise TypeError(f"a landmark is given by name or number, not {type(which).__name__}") from None
    if not -len(names) <= number < len(names):
        raise IndexError(f"there are {len(names)} landmarks, there is no number {number}")
    return number % len(names)


def new(kind: type) -> Any:
    """A struct with its struct_size and defaults."""
    struct = kind()
    call(f"{kind.__name__}_init", ctypes.byref(struct), ctypes.sizeof(struct))
    return struct


def given_of(**fields: Any) -> dict[str, Any]:
    """Those that are not None."""
    return {name: value for name, value in fields.items() if value is not None}


def fill(struct: Any, **fields: Any) -> Any:
    """Sets the fields that are not None."""
    kinds = dict(struct._fields_)
    for name, value in fields.items():
        if value is None:
            continue
        if name in _ENUMS:
            value = choice(_ENUMS[name], value, name)
        if kinds[name] in _RANGES:
            value = integer(value, name, kinds[name])
        elif kinds[name] is ctypes.c_double:
            value = real(value, name)
        elif kinds[name] is ctypes.c_char_p:
            value = text(value, name)
        setattr(struct, name, value)
    return struct


def floats(values: Any) -> Any:
    """A float[n] field as a tuple."""
    return tuple(values)


def point_of(struct: _abi.focal_surface_point) -> SurfacePoint | None:
    if struct.triangle == _abi.FOCAL_NO_TRIANGLE:
        return None
    return SurfacePoint(struct.triangle, floats(struct.barycentric))


def as_dict(struct: Any) -> dict[str, Any]:
    """The fields of a result that holds numbers only."""
    fields = {}
    for name, _ in struct._fields_:
        if name != "struct_size" and not name.startswith("reserved"):
            value = getattr(struct, name)
            fields[name] = _ENUMS[name](value) if name in _ENUMS and isinstance(value, int) else value
    return fields
