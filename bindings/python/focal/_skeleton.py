"""Joints and skin weights for one mesh."""
from __future__ import annotations

import ctypes
import json
import math
import os
from dataclasses import dataclass
from typing import Any, Mapping, Sequence

from . import _abi
from ._arrays import Block, Floats, Numbers, block_of, empty, result
from ._context import Context, context_or_default
from ._handle import Handle, handle_of
from ._library import call, create
from ._mesh import Mesh, placed
from ._task import Progress, Task, run
from ._values import as_dict, choice, fill, floats, integer, new, path_text, text


@dataclass(frozen=True)
class Joint:
    """One joint of a Skeleton."""

    name: str
    parent: int        # number of a joint before it; -1: a root
    confidence: float  # probability of lying within 5 % of the body's size of its place
    position: tuple[float, float, float]
    rotation: tuple[float, float, float, float]  # quaternion x, y, z, w: from the joint's own axes to the mesh's
    tip: tuple[float, float, float]              # the far end of its part of the surface


class Skeleton(Handle):
    """Joints and skin weights, from Detection.rig or Skeleton.bind."""

    _kind = "skeleton"
    _origin = (0.0, 0.0, 0.0)  # of the mesh

    def __init__(self) -> None:
        raise TypeError("make a Skeleton with Detection.rig or Skeleton.bind")

    @classmethod
    def bind(cls, mesh: Mesh, joints: Sequence[Joint | Mapping[str, Any]] | None = None, *,
             max_influences: int | None = None, context: Context | None = None, task: Task | None = None,
             on_progress: Progress | None = None) -> Skeleton:
        """Computes weights for an existing skeleton from the body alone; the joints stay bit-identical. No model is needed.

        joints          parents first: Joint, or mappings with name, parent (a number; -1: a root), position, and if known
                        rotation, tip, moves (False: it moves no vertex). None: those of the mesh's own file, which write()
                        then writes with new weights and no other change
        max_influences  joints that move one vertex, 1 to 8 (default 4)

        Error: INVALID_ARGUMENT (no file, or one without a skin; a joint before its parent; no joint that moves anything);
        Cancelled.
        """
        given, running = handle_of(mesh, Mesh, "mesh"), context_or_default(context)
        params = fill(new(_abi.focal_bind_params), max_influences=max_influences)
        if joints is not None:
            _put_joints(params, joints, mesh.origin)

        def bind(task_handle: Any) -> Skeleton:
            made = cls._adopt(create("focal_skeleton_bind", _abi.focal_skeleton, running._handle, given,
                                     ctypes.byref(params), task_handle), running)
            made._origin = mesh.origin
            return made

        return run(bind, task, on_progress)

    def _facts(self) -> str:
        info = self.info
        return f"{info['joint_count']} joints, {info['verdict'].name.lower()}, quality {info['quality']:.2f}"

    @property
    def joints(self) -> list[Joint]:
        """Parents first."""
        struct, found = new(_abi.focal_joint), []
        count = self.info["joint_count"]
        with self._borrow() as handle:
            for index in range(count):
                call("focal_skeleton_get_joint", handle, index, ctypes.byref(struct))
                found.append(Joint(struct.name.decode("utf-8", "replace"), struct.parent, struct.confidence,
                                   placed(struct.position, self._origin), floats(struct.rotation),
                                   placed(struct.tip, self._origin)))
        return found

    @property
    def weights(self) -> tuple[Numbers, Floats]:
        """(joints, weights): for each of the mesh's vertices four joint numbers, (n, 4), heaviest first, and their
        weights, (n, 4) floats that sum to 1; all 0 where no triangle uses the vertex. Eight if rig was called with
        max_influences above four."""
        info = self.info
        count, each = info["vertex_count"], info["influences_per_vertex"]
        joints, weights = empty("I", each * count), empty("f", each * count)
        call("focal_skeleton_weights", self._handle, count, joints.pointer, weights.pointer)
        return result(joints.owner, each), result(weights.owner, each)

    @property
    def info(self) -> dict[str, Any]:
        """joint_count, warning_count, max_influences (of one vertex), vertex_count, unweighted_vertices, quality, verdict,
        guessed_joints (those without a landmark that was found), influences_per_vertex (of weights)."""
        info = new(_abi.focal_skeleton_info)
        call("focal_skeleton_get_info", self._handle, ctypes.byref(info))
        return as_dict(info)

    @property
    def verdict(self) -> _abi.Verdict:
        """GOOD, CHECK (some joints may be wrong) or FAILED (unusable); warnings give the reasons."""
        return _abi.Verdict(self.info["verdict"])

    @property
    def quality(self) -> float:
        """0..1; the verdict is derived from it."""
        return float(self.info["quality"])

    @property
    def warnings(self) -> list[str]:
        """Plain sentences on what was found and done."""
        return self._texts("focal_skeleton_warning", self.info["warning_count"])

    def write(self, path: str | os.PathLike[str]) -> None:
        """Writes the mesh's own glTF, nothing lost, with skeleton, skin and landmarks. Rules and errors as
        Detection.write."""
        call("focal_skeleton_write_gltf", self._handle, path_text(path))

    def write_vrm(self, path: str | os.PathLike[str], meta: Mapping[str, Any]) -> None:
        """Writes a VRM 1.0 avatar: what write() writes, with the humanoid map by the joints' roles and VRM's meta data, of which name
        and authors (a list) are required. VRM wants a T-pose. Error: INVALID_ARGUMENT (a joint that VRM requires is missing; no name
        or authors), and those of write."""
        call("focal_skeleton_write_vrm", self._handle, text(json.dumps(_mapping(meta, "meta")), "meta"), path_text(path))


def _put_joints(params: _abi.focal_bind_params, joints: Sequence[Joint | Mapping[str, Any]],
                origin: tuple[float, float, float]) -> None:
    rows = [vars(joint) if isinstance(joint, Joint) else _mapping(joint, "each joint") for joint in joints]
    for row in rows:
        missing = {"name", "parent", "position"} - set(row)
        if missing:
            raise ValueError(f"a joint lacks {', '.join(sorted(missing))}")
    params.joint_names = (ctypes.c_char_p * max(1, len(rows)))(*[text(row["name"], "each joint name") for row in rows])
    params.joint_count = len(rows)
    params.joint_parents = (ctypes.c_int32 * max(1, len(rows)))(*[integer(row["parent"], "parent") for row in rows])
    params.joint_moves = (ctypes.c_int32 * max(1, len(rows)))(*[bool(row.get("moves", True)) for row in rows])
    start = (-origin[0], -origin[1], -origin[2])
    blocks = [block_of([placed(row["position"], start) for row in rows], "position", "f", 3),
              block_of([tuple(row.get("rotation") or (0, 0, 0, 1)) for row in rows], "rotation", "f", 4),
              block_of([placed(row.get("tip") or (math.nan,) * 3, start) for row in rows], "tip", "f", 3)]
    params.joint_positions, params.joint_rotations, params.joint_tips = (block.pointer for block in blocks)
    params._blocks = blocks  # their memory lives as long as the struct


def template_text(given: str | Mapping[str, Any] | None) -> str | None:
    """A skeleton template as JSON text."""
    return given if given is None or isinstance(given, str) else json.dumps(_mapping(given, "skeleton_template"))


def skeleton_params(known: list[str], *, names: Any, joint_names: Any, skeleton_template: Any, fixed_joints: Any,
                    origin: tuple[float, float, float], **fields: Any) -> _abi.focal_skeleton_params:
    """known: the joint names of the model; a template has its own."""
    if names is not None:
        names = choice(_abi.BoneNames, names, "names")
    skeleton_template = template_text(skeleton_template)
    animations = fields.pop("animations")
    if fields.get("rest_pose") is not None:
        fields["rest_pose"] = _pose(fields["rest_pose"])
    params: _abi.focal_skeleton_params = fill(new(_abi.focal_skeleton_params), names=names, skeleton_template=skeleton_template, **fields)
    if animations is not None:
        params.animations = animations
    own = known if params.skeleton_template is None else _template_joints(params.skeleton_template)
    if fixed_joints is not None:
        places = _fixed_places(own, _mapping(fixed_joints, "fixed_joints"), origin)
        params.fixed_joints, params.fixed_joint_count = places.pointer, places.rows
        params._fixed_places = places  # its memory lives as long as the struct
    if joint_names is not None:
        texts = _joint_texts(own, joint_names)
        params.joint_names = (ctypes.c_char_p * len(texts))(*texts)
        params.joint_name_count = len(texts)
    return params


def _pose(value: Any) -> _abi.Pose:
    if isinstance(value, bool):
        return _abi.Pose.OF_TEACHERS if value else _abi.Pose.OF_MESH
    if isinstance(value, str) and value.lower() in ("mesh", "teachers"):
        value = f"of_{value}"
    return choice(_abi.Pose, value, "rest_pose")


def _template_joints(template: bytes) -> list[str]:
    """In order; what is wrong with a template the library says."""
    try:
        return [str(joint["name"]) for joint in json.loads(template)["joints"]]
    except (ValueError, KeyError, TypeError):
        return []


def _fixed_places(known: list[str], fixed: Mapping[str, Any], origin: tuple[float, float, float]) -> Block:
    for name in fixed:
        if name not in known:
            raise ValueError(f"{name!r} is no joint of the skeleton: {', '.join(known)}")
    unknown = (math.nan,) * 3
    given = block_of([tuple(fixed.get(name, unknown)) for name in known], "fixed_joints", "f", 3)  # refused as they were given
    if not any(origin):
        return given
    places = [placed(fixed.get(name, unknown), (-origin[0], -origin[1], -origin[2])) for name in known]
    return block_of(places, "fixed_joints", "f", 3)


def _mapping(value: Any, name: str) -> dict[str, Any]:
    if not isinstance(value, Mapping):
        raise TypeError(f"{name} must be a mapping, not {type(value).__name__}")
    return dict(value)


def _joint_texts(known: list[str], joint_names: Any) -> list[bytes | None]:
    if isinstance(joint_names, Mapping):
        for name in joint_names:
            if name not in known:
                raise ValueError(f"{name!r} is no joint of the model: {', '.join(known)}")
        joint_names = [joint_names.get(name) for name in known]
    if isinstance(joint_names, (str, bytes)):
        raise TypeError("joint_names must be a mapping or a sequence of str, not one text")
    try:
        given = list(joint_names)
    except TypeError:
        raise TypeError(f"joint_names must be a mapping or a sequence, not {type(joint_names).__name__}") from None
    return [None if name is None else text(name, "each joint name") for name in given]
