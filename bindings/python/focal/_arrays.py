"""Blocks of numbers in and out, with NumPy and without.

In: anything that NumPy takes, when it is there; buffers (array.array, memoryview) and sequences always. A block of
rows may be given as rows, as a two-dimensional buffer, or flat.
Out: numpy.ndarray with NumPy; without it array.array for one number a row, else a list of tuples.
"""
from __future__ import annotations

import array
import ctypes
import math
import operator
from typing import TYPE_CHECKING, Any, NamedTuple

try:
    import numpy as numpy  # shared with the other modules
except ImportError:
    numpy = None  # type: ignore[assignment]

if TYPE_CHECKING:  # with NumPy, which nearly every caller has; without it array.array, or a list of tuples where rows have a width
    from numpy.typing import NDArray

    Floats = NDArray[numpy.float32]
    Numbers = NDArray[numpy.uint32]  # of vertices, triangles, joints
    Labels = NDArray[numpy.int32]    # -1: none
else:
    Floats = Numbers = Labels = Any

_TYPES: dict[str, Any] = {"f": ctypes.c_float, "I": ctypes.c_uint32, "i": ctypes.c_int32}
_INTEGERS = "bBhHiIlLqQnN"


class Block(NamedTuple):
    """Memory for the library; it lives as long as `owner`."""

    pointer: Any
    rows: int
    owner: Any


def block_of(value: Any, name: str, code: str, width: int) -> Block:
    """Numbers as packed rows of `width`. code: "f" float or "I" uint32. Raises TypeError and ValueError."""
    if isinstance(value, (str, bytes, bytearray)) or value is None:
        raise TypeError(f"{name} must hold numbers, not {type(value).__name__}")
    flat = _flat_numpy(value, name, code, width) if numpy is not None else _flat_plain(value, name, code, width)
    if len(flat) % width:
        raise ValueError(f"{name} has {len(flat)} numbers, not a multiple of {width}")
    rows = len(flat) // width
    return Block(_pointer_to(flat if rows else empty(code, width).owner, code), rows, flat)


def _pointer_to(numbers: Any, code: str) -> Any:
    """A pointer that keeps the array alive."""
    if numpy is not None:
        return numbers.ctypes.data_as(ctypes.POINTER(_TYPES[code]))
    return ctypes.cast((_TYPES[code] * len(numbers)).from_buffer(numbers), ctypes.POINTER(_TYPES[code]))


def _check_shape(shape: tuple[int, ...], name: str, width: int) -> None:
    wanted = f"(n, {width})" if width > 1 else "(n,)"
    if len(shape) == 1 or (len(shape) == 2 and shape[1] == width):
        return
    raise ValueError(f"{name} must have the shape {wanted}, not {tuple(shape)}")


def _flat_numpy(value: Any, name: str, code: str, width: int) -> Any:
    try:
        given = numpy.asarray(value)
    except ValueError as error:  # rows of different lengths
        raise ValueError(f"{name} must be rows of {width} numbers: {error}") from None
    if given.ndim == 0:
        raise TypeError(f"{name} must be a sequence or a buffer of numbers, not {type(value).__name__}")
    _check_shape(given.shape, name, width)
    if given.size and given.dtype.kind not in ("fiu" if code == "f" else "iu"):
        kind = "numbers" if code == "f" else "integers"
        raise TypeError(f"{name} must hold {kind}, not {given.dtype}")
    if code == "I" and given.size and (given.min() < 0 or given.max() > 0xFFFFFFFF):
        raise ValueError(f"{name} must lie within 0..4294967295")
    with numpy.errstate(over="ignore"):  # beyond float is infinite, which focal refuses by name
        return numpy.ascontiguousarray(given, numpy.float32 if code == "f" else numpy.uint32).reshape(-1)


def _flat_plain(value: Any, name: str, code: str, width: int) -> array.array[Any]:
    try:
        numbers = _flat_buffer(memoryview(value), name, code, width)
    except TypeError:
        numbers = _flat_sequence(value, name, width)
    if isinstance(numbers, array.array):
        return numbers
    try:
        return array.array(code, numbers if code == "f" else map(operator.index, numbers))
    except OverflowError:
        raise ValueError(f"{name} must lie within 0..4294967295") from None
    except TypeError:
        raise TypeError(f"{name} must hold {'numbers' if code == 'f' else 'integers'}") from None


def _flat_buffer(view: memoryview, name: str, code: str, width: int) -> Any:
    _check_shape(view.shape or (), name, width)
    kind = view.format.lstrip("@=<")
    if kind not in (_INTEGERS + "fd" if code == "f" else _INTEGERS):
        return [None]  # refused by its caller as no numbers
    if kind == code and view.contiguous:
        flat = array.array(code)
        flat.frombytes(view.tobytes())
        return flat
    numbers: Any = view.tolist()
    return numbers if view.ndim == 1 else [number for row in numbers for number in row]


def _flat_sequence(value: Any, name: str, width: int) -> list[Any]:
    try:
        rows = list(value)
    except TypeError:
        raise TypeError(f"{name} must be a sequence or a buffer of numbers, not {type(value).__name__}") from None
    flat: list[Any] = []
    for number, row in enumerate(rows):
        if isinstance(row, (int, float)):
            flat.append(row)
            continue
        try:
            numbers = list(row)
        except TypeError:
            raise TypeError(f"{name} must hold numbers, not {type(row).__name__}") from None
        if len(numbers) != width:
            raise ValueError(f"{name} must be rows of {width} numbers: row {number} has {len(numbers)}")
        flat.extend(numbers)
    return flat


def empty(code: str, count: int) -> Block:
    """Room for the library to write `count` numbers to; result() makes them an array."""
    if numpy is not None:
        room: Any = numpy.zeros(count, {"f": numpy.float32, "I": numpy.uint32, "i": numpy.int32}[code])
    else:
        room = array.array(code, bytes(4 * count))
    return Block(_pointer_to(room, code), count, room)


def result(room: Any, width: int = 1) -> Any:
    """What the caller gets: rows of `width` numbers."""
    if width == 1:
        return room
    if numpy is not None:
        return room.reshape(-1, width)
    return list(zip(*[iter(room)] * width))


def copied(pointer: Any, code: str, count: int, width: int) -> Any:
    """A copy of the library's own memory, which may go before the caller's array does."""
    room = empty(code, count * width)
    ctypes.memmove(room.pointer, pointer, 4 * count * width)
    return result(room.owner, width)


def far_origin(vertices: Any) -> tuple[float, float, float] | None:
    """The centre of points whose 64-bit coordinates would lose more than a hundred-thousandth of their extent in 32
    bits (earth-centred ones), else None."""
    if numpy is None:
        return _far_origin_plain(vertices)
    given = numpy.asarray(vertices)
    if given.dtype != numpy.float64 or given.size < 3 or given.size % 3:
        return None
    rows = given.reshape(-1, 3)
    rows = rows[numpy.isfinite(rows).all(axis=1)]
    if not len(rows):
        return None
    return _origin(rows.min(axis=0).tolist(), rows.max(axis=0).tolist())


def _far_origin_plain(vertices: Any) -> tuple[float, float, float] | None:
    try:
        view = memoryview(vertices)
        if view.format.lstrip("@=<") != "d":
            return None
        vertices = view.tolist()
    except TypeError:
        pass  # a sequence
    try:
        flat = [float(x) for row in vertices for x in (row if hasattr(row, "__iter__") else (row,))]
    except (TypeError, ValueError):
        return None
    axes = [[x for x in flat[axis::3] if math.isfinite(x)] for axis in range(3)]
    return _origin([min(a) for a in axes], [max(a) for a in axes]) if all(axes) else None


def _origin(low: list[float], high: list[float]) -> tuple[float, float, float] | None:
    extent = max(h - l for l, h in zip(low, high))
    farthest = max(max(abs(l), abs(h)) for l, h in zip(low, high))
    if farthest * 2.0**-24 <= 1e-5 * extent:
        return None
    return tuple((l + h) / 2 for l, h in zip(low, high))  # type: ignore[return-value]


def moved(rows: Any, offset: tuple[float, float, float]) -> Any:
    """Rows of three numbers, or flat ones, with the offset added, in 64 bits."""
    if numpy is not None:
        return (numpy.asarray(rows, numpy.float64).reshape(-1, 3) + numpy.asarray(offset))
    flat = [float(x) for row in rows for x in (row if hasattr(row, "__iter__") else (row,))]
    return [tuple(x + o for x, o in zip(flat[i:i + 3], offset)) for i in range(0, len(flat), 3)]
