"""Landmark files, as docs/landmark-format.md describes them."""
from __future__ import annotations

import csv
import io
import json
import os
import tempfile
from typing import Any


def landmarks_json(landmarks: list[Any]) -> str:
    lines = []
    for landmark in landmarks:
        entry: dict[str, Any] = {"name": landmark.name, "status": landmark.status.name.lower(),
                                 "confidence": landmark.confidence}
        if landmark.point is None:
            entry["status"] = "absent"
        else:
            entry.update(triangle=landmark.triangle, barycentric=list(landmark.barycentric), vertex=landmark.vertex,
                         position=list(landmark.position))
        lines.append("  " + json.dumps(entry, ensure_ascii=False))
    return '{\n "format": "focal-landmarks", "version": 1,\n "landmarks": [\n' + ",\n".join(lines) + "\n ]\n}\n"


def landmarks_csv(landmarks: list[Any]) -> str:
    """Absent ones have no line."""
    text = io.StringIO()
    table = csv.writer(text, lineterminator="\n")
    table.writerow(["name", "x", "y", "z"])
    for landmark in landmarks:
        if landmark.position is not None and not landmark.absent:
            table.writerow([landmark.name, *landmark.position])
    return text.getvalue()


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
