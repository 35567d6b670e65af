"""Joints and skin weights for one mesh."""
from __future__ import annotations

import ctypes
import json
import os
from dataclasses import dataclass
from typing import Any, Mapping

from . import _abi
from ._arrays import empty, result
from ._handle import Handle
from ._library import call
from ._mesh import placed
from ._values import as_dict, choice, fill, floats, new, path_text, text


@dataclass(frozen=True)
class Joint:
    """One joint of a Skeleton."""

    name: str
    parent: int        # number of a joint before it; -1: a root
    confidence: float  # 0..1: how well the training characters agree on its place
    position: tuple[float, float, float]
    rotation: tuple[float, float, float, float]  # quaternion x, y, z, w: from the joint's own axes to the mesh's
    tip: tuple[float, float, float]              # the far end of its part of the surface


class Skeleton(Handle):
    """Joints and skin weights, from Detection.rig."""

    _kind = "skeleton"
    _origin = (0.0, 0.0, 0.0)  # of the mesh

    def __init__(self) -> None:
        raise TypeError("make a Skeleton with Detection.rig")

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
    def weights(self) -> tuple[Any, Any]:
        """(joints, weights): for each of the mesh's vertices four joint numbers, (n, 4), heaviest first, and their
        weights, (n, 4) floats that sum to 1; all 0 where no triangle uses the vertex. Eight where rig was asked for
        more than four."""
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
        """GOOD, CHECK (some joints may lie wrong) or FAILED (not to be used); warnings say what speaks against it."""
        return self.info["verdict"]

    @property
    def quality(self) -> float:
        """0..1: what the verdict follows from."""
        return self.info["quality"]

    @property
    def warnings(self) -> list[str]:
        """Plain sentences on what was found and done."""
        return self._texts("focal_skeleton_warning", self.info["warning_count"])

    def write(self, path: str | os.PathLike[str]) -> None:
        """Writes the mesh's own glTF, nothing lost, with skeleton, skin and landmarks. Rules and errors as
        Detection.write."""
        call("focal_skeleton_write_gltf", self._handle, path_text(path))


def skeleton_params(known: list[str], *, names: Any, joint_names: Any, skeleton_template: Any,
                    **fields: Any) -> _abi.focal_skeleton_params:
    """known: the model's joint names, which a mapping of names is looked up in."""
    if names is not None:
        names = choice(_abi.BoneNames, names, "names")
    if skeleton_template is not None and not isinstance(skeleton_template, str):
        skeleton_template = json.dumps(_mapping(skeleton_template, "skeleton_template"))
    animations = fields.pop("animations")
    params = fill(new(_abi.focal_skeleton_params), names=names, skeleton_template=skeleton_template, **fields)
    if animations is not None:
        params.animations = animations
    if joint_names is not None:
        texts = _joint_texts(known, joint_names)
        params.joint_names = (ctypes.c_char_p * len(texts))(*texts)
        params.joint_name_count = len(texts)
    return params


def _mapping(value: Any, name: str) -> dict[str, Any]:
    if not isinstance(value, Mapping):
        raise TypeError(f"{name} must be JSON text or a mapping, not {type(value).__name__}")
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
