"""focal's own landmark files (JSON, as the focal command reads and writes them). Knows nothing of Blender.

Positions are in the coordinates of a glTF file: metres, Y up. Blender's Z up is turned by the caller.
"""
import json
import os

from .json_file import read_json


class LandmarkFileError(Exception):
    """What is wrong with the file, in words for the user."""


def read(path):
    """A list of dicts: name, and of position, triangle with barycentric, vertex, status, confidence what is there."""
    document = read_json(path, LandmarkFileError)
    if not isinstance(document, dict) or document.get("format") != "focal-landmarks":
        raise LandmarkFileError(f'{path} holds no focal landmarks: "format": "focal-landmarks" is missing. '
                                "Other formats: focal convert IN OUT.json")
    if document.get("version", 1) != 1:
        raise LandmarkFileError(f"{path} is of a newer version: update focal")
    marks = document.get("landmarks")
    if not isinstance(marks, list):
        raise LandmarkFileError(f"{path} has no list of landmarks")
    return [_checked(mark, path) for mark in marks]


def _checked(mark, path):
    name = mark.get("name") if isinstance(mark, dict) else None
    if not isinstance(name, str) or not name:
        raise LandmarkFileError(f"{path}: a landmark has no name")
    for key in ("position", "barycentric"):
        if key in mark and not _is_triple(mark[key]):
            raise LandmarkFileError(f"{path}: {key} of landmark '{name}' is not a list of three numbers")
    for key in ("triangle", "vertex"):
        if key in mark and not (isinstance(mark[key], int) and mark[key] >= 0):
            raise LandmarkFileError(f"{path}: {key} of landmark '{name}' is not a whole number from 0")
    if "triangle" in mark and "barycentric" not in mark:
        raise LandmarkFileError(f"{path}: landmark '{name}' has a triangle but no barycentric")
    if mark.get("status") != "absent" and not any(key in mark for key in ("position", "triangle", "vertex")):
        raise LandmarkFileError(f"{path}: landmark '{name}' has no position, no triangle and no vertex")
    return mark


def _is_triple(value):
    return isinstance(value, list) and len(value) == 3 and all(
        isinstance(x, (int, float)) and abs(x) < float("inf") for x in value)


def write(path, mesh, marks):
    """marks: dicts as read() gives them. The file is whole or not there at all."""
    lines = ",\n  ".join(json.dumps(mark, ensure_ascii=False) for mark in marks)
    text = (f'{{\n "format": "focal-landmarks", "version": 1, "mesh": {json.dumps(mesh, ensure_ascii=False)},\n'
            f' "landmarks": [\n  {lines}\n ]\n}}\n')
    partial = path + ".part"
    try:
        with open(partial, "w", encoding="utf-8") as file:
            file.write(text)
        os.replace(partial, path)
    except OSError as error:
        raise LandmarkFileError(f"{path}: {error.strerror}") from error
