"""What meshes and detections are made of, so that pickle can make them again.

Mesh and Detection use this module, so it does not import them: they pass themselves, and their class."""
from __future__ import annotations

import array
import os
from typing import Any, NamedTuple

from ._abi import Status
from ._context import context_or_default
from ._errors import Error
from ._values import given_of


class Source(NamedTuple):
    """How a Mesh was made; `content` is a path with its state, bytes, or None where the mesh itself holds its arrays."""

    maker: str  # "arrays", "parts", "path" or "bytes"
    content: Any
    parameters: dict[str, Any]


def source_of(maker: str, content: Any = None, **parameters: Any) -> Source:
    return Source(maker, content, given_of(**parameters))


def path_state(path: Any) -> tuple[str, int, int]:
    """Where a file is and which of its versions was read."""
    full = os.path.abspath(os.fsdecode(path))
    found = os.stat(full)
    return full, found.st_size, found.st_mtime_ns


def mesh_state(mesh: Any) -> tuple[str, Any, dict[str, Any], tuple[float, float, float]]:
    """A .glb goes along as it is; a .gltf, which may have files beside it, by its path."""
    maker, content, parameters = mesh._source
    if maker in ("arrays", "parts"):
        content = _arrays_of(mesh)
    elif maker == "path":
        _check_unchanged(content)
        if not content[0].lower().endswith(".gltf") and "allow_external_files" not in parameters:
            with open(content[0], "rb") as file:
                maker, content = "bytes", file.read()
        else:
            content = content[0]
    return maker, content, parameters, mesh.origin


def _check_unchanged(state: tuple[str, int, int]) -> None:
    try:
        same = path_state(state[0]) == state
    except OSError:
        same = False
    if not same:
        raise Error(Status.IO, f"{state[0]} is not the file any more that the Mesh was loaded from",
                    "pickle a Mesh while its file is there, or load it with Mesh.from_bytes")


def _arrays_of(mesh: Any) -> list[tuple[bytes, bytes]]:
    vertices, faces = mesh._own_arrays()
    return [(vertices[12 * part.vertices.start:12 * part.vertices.stop],
             _moved(faces[12 * part.triangles.start:12 * part.triangles.stop], part.vertices.start)) for part in mesh.parts]


def _moved(faces: bytes, first: int) -> bytes:
    """Vertex numbers of a part, from those of the whole mesh; what is out of range stays so."""
    if not first:
        return faces
    return array.array("I", [(number - first) % 2**32 for number in array.array("I", faces)]).tobytes()


def mesh_again(kind: Any, maker: str, content: Any, parameters: dict[str, Any], origin: tuple[float, float, float]) -> Any:
    if maker == "path":
        return kind.load(content, **parameters)
    if maker == "bytes":
        return kind.from_bytes(content, **parameters)
    parts = [(array.array("f", vertices), array.array("I", faces)) for vertices, faces in content]
    made = kind(*parts[0], **parameters) if maker == "arrays" else kind.from_parts(parts, **parameters)
    made.origin = origin
    return made


def detection_state(detection: Any) -> dict[str, Any]:
    """What is known without the library, and what the rest is computed from on demand."""
    return {"_kept": {"landmarks": detection.landmarks, "info": detection.info, "seconds": detection.seconds,
                      "warnings": detection.warnings},
            "_made_of": detection._made_of, "_joint_names": detection._joint_names, "_origin": detection._origin}


def detection_again(kind: Any, state: dict[str, Any]) -> Any:
    made = kind._adopt(None, context_or_default(None))
    vars(made).update(state)
    return made
