"""Landmark files, as docs/landmark-format.md describes them."""
from __future__ import annotations

import csv
import io
import json
import math
import os
import pathlib
import tempfile
from typing import Any, Iterable, Mapping

from ._values import Mark, SurfacePoint


def read_landmarks(path: str | os.PathLike[str]) -> dict[str, Mark]:
    """The marks of a landmark file, .landmarks.json or .csv, as TrainingSet.add takes them: a SurfacePoint, a vertex number, a
    position (x, y, z), or None where the file calls the landmark absent. `focal convert` makes such files from those of other programs.
    ValueError, which names the file: not such a file, a landmark without a place, a duplicate name; OSError."""
    name = os.fsdecode(path)
    try:
        text = pathlib.Path(name).read_text(encoding="utf-8-sig")
        rows = _csv_rows(text) if name.lower().endswith(".csv") else _json_rows(text)
        marks: dict[str, Mark] = {}
        for landmark, mark in rows:
            if not landmark or landmark in marks:
                raise ValueError(f"landmark {landmark!r} is there twice" if landmark else "a landmark has no name")
            marks[landmark] = mark
        return marks
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise ValueError(f"{name} is not a landmark file: {error}") from None


def write_landmarks(path: str | os.PathLike[str], marks: Mapping[str, Mark], *, mesh: str = "") -> None:
    """Writes marks of one mesh, by name, as read_landmarks reads them; the suffix of the path chooses the format. mesh: the name of its
    file, for readers. ValueError: another suffix; a mark without a position in a .csv. OSError."""
    name = os.fsdecode(path)
    lower = name.lower()
    if lower.endswith(".csv"):
        write_text(path, _csv_text((landmark, _position_of(landmark, mark)) for landmark, mark in marks.items() if mark is not None))
    elif lower.endswith(".json") and not lower.endswith(".mrk.json"):
        write_text(path, _json_text([{"name": landmark, **_entry_of(landmark, mark)} for landmark, mark in marks.items()], mesh))
    else:
        raise ValueError(f"{name!r} ends in none of .landmarks.json and .csv")


def _json_rows(text: str) -> list[tuple[str, Mark]]:
    document = json.loads(text)
    if not isinstance(document, dict) or document.get("format") != "focal-landmarks":
        raise ValueError('it needs "format": "focal-landmarks"')
    if document.get("version", 1) != 1:
        raise ValueError("it is of a newer version")
    return [(entry["name"], _mark_of(entry)) for entry in document["landmarks"]]


def _mark_of(entry: Mapping[str, Any]) -> Mark:
    """triangle before vertex before position, as docs/landmark-format.md has it."""
    if entry.get("status") == "absent":
        return None
    if "triangle" in entry:
        return SurfacePoint(_index(entry["triangle"]), _three(entry["barycentric"]))
    if "vertex" in entry:
        return _index(entry["vertex"])
    if "position" in entry:
        return _three(entry["position"])
    raise ValueError(f"landmark {entry['name']!r} has no vertex, no triangle and no position")


def _index(value: Any) -> int:
    if isinstance(value, bool) or not isinstance(value, int) or not 0 <= value < 2**32:
        raise ValueError(f"{value!r} is not a whole number from 0")
    return value


def _three(value: Any) -> tuple[float, float, float]:
    x, y, z = (float(number) for number in value)
    if not all(map(math.isfinite, (x, y, z))):
        raise ValueError(f"{value!r} is not three finite numbers")
    return x, y, z


def _csv_rows(text: str) -> list[tuple[str, Mark]]:
    table = csv.DictReader(io.StringIO(text))
    if not {"name", "x", "y", "z"} <= set(table.fieldnames or ()):
        raise ValueError("its first line needs the columns name, x, y and z")
    return [(row["name"], None if row.get("status") == "absent" else _three((row["x"], row["y"], row["z"]))) for row in table]


def _entry_of(landmark: str, mark: Mark) -> dict[str, Any]:
    if mark is None:
        return {"status": "absent"}
    if hasattr(mark, "__index__"):
        return {"vertex": int(mark)}  # type: ignore[arg-type]
    if len(mark) == 2:
        triangle, barycentric = mark  # type: ignore[misc]
        return {"triangle": int(triangle), "barycentric": list(_three(barycentric))}
    return {"position": list(_position_of(landmark, mark))}


def _position_of(landmark: str, mark: Mark) -> tuple[float, float, float]:
    try:
        return _three(mark)
    except (TypeError, ValueError):
        raise ValueError(f"the mark of {landmark!r} is no position (x, y, z): {mark!r:.60}") from None


def _json_text(entries: list[dict[str, Any]], mesh: str = "") -> str:
    """One landmark a line: people read, compare and edit such files."""
    of = f', "mesh": {json.dumps(mesh, ensure_ascii=False)}' if mesh else ""
    lines = ",\n".join("  " + json.dumps(entry, ensure_ascii=False) for entry in entries)
    return '{\n "format": "focal-landmarks", "version": 1' + of + ',\n "landmarks": [\n' + lines + "\n ]\n}\n"


def _csv_text(rows: Iterable[tuple[str, tuple[float, float, float]]]) -> str:
    text = io.StringIO()
    table = csv.writer(text, lineterminator="\n")
    table.writerow(["name", "x", "y", "z"])
    table.writerows([name, *position] for name, position in rows)
    return text.getvalue()


def landmarks_json(landmarks: list[Any]) -> str:
    entries = []
    for landmark in landmarks:
        entry: dict[str, Any] = {"name": landmark.name, "status": landmark.status.name.lower(),
                                 "confidence": landmark.confidence}
        if landmark.point is None:
            entry["status"] = "absent"
        else:
            entry.update(triangle=landmark.triangle, barycentric=list(landmark.barycentric), vertex=landmark.vertex,
                         position=list(landmark.position))
        entries.append(entry)
    return _json_text(entries)


def landmarks_csv(landmarks: list[Any]) -> str:
    """Absent ones have no line."""
    return _csv_text((one.name, one.position) for one in landmarks if one.position is not None and not one.absent)


def write_text(path: Any, text: str) -> None:
    """A whole file or the old one."""
    target = os.path.realpath(os.fsdecode(path))
    descriptor, temporary = tempfile.mkstemp(dir=os.path.dirname(target), prefix=".focal-")
    try:
        with os.fdopen(descriptor, "w", encoding="utf-8", newline="") as file:
            file.write(text)
        mask = os.umask(0)
        os.umask(mask)
        os.chmod(temporary, 0o666 & ~mask)
        os.replace(temporary, target)
    except BaseException:
        os.unlink(temporary)
        raise
