"""Landmarks found on one mesh, and results derived from them."""
from __future__ import annotations

import ctypes
import os
from dataclasses import dataclass
from typing import Any, Iterator, Mapping, Sequence

from . import _abi
from ._arrays import Floats, Labels, empty, result
from ._correspondence import Correspondence
from ._handle import Handle, handle_of
from ._landmark_files import landmarks_csv, landmarks_json, write_text
from ._library import call, create, library
from ._mesh import Mesh, placed
from ._pickled import detection_again, detection_state
from ._skeleton import Skeleton, skeleton_params
from ._task import Progress, Task, run
from ._values import SurfacePoint, as_dict, choice, floats, new, numbered, path_text, point_of, real


@dataclass(frozen=True)
class Place:
    """A place on the mesh."""

    point: SurfacePoint
    position: tuple[float, float, float]
    vertex: int        # the mesh's vertex nearest to it
    confidence: float  # as Landmark's


@dataclass(frozen=True)
class Landmark:
    """One landmark of a Detection. point, position and vertex are None when it has no place at all."""

    name: str
    status: _abi.LandmarkStatus  # FOUND, UNCERTAIN, ABSENT
    confidence: float            # probability of lying within 4 % of sqrt(surface area) of the truth
    expected_error: float        # a length, in the mesh's units
    point: SurfacePoint | None
    position: tuple[float, float, float] | None
    vertex: int | None           # the mesh's vertex nearest to it
    runner_up: Place | None      # the second-best place, when there is one

    @property
    def triangle(self) -> int | None:
        return self.point.triangle if self.point else None

    @property
    def barycentric(self) -> tuple[float, float, float] | None:
        """Weights of the triangle's three corners, >= 0, sum 1."""
        return self.point.barycentric if self.point else None

    @property
    def found(self) -> bool:
        return self.status == _abi.LandmarkStatus.FOUND

    @property
    def absent(self) -> bool:
        return self.status == _abi.LandmarkStatus.ABSENT


def _landmark_of(struct: _abi.focal_landmark, origin: Any) -> Landmark:
    point, runner_up = point_of(struct.point), point_of(struct.runner_up_point)
    second = None
    if struct.has_runner_up and runner_up:
        second = Place(runner_up, placed(struct.runner_up_position, origin), struct.runner_up_vertex,
                       struct.runner_up_confidence)
    return Landmark(struct.name.decode("utf-8", "replace"), _abi.LandmarkStatus(struct.status), struct.confidence,
                    struct.expected_error, point, placed(struct.position, origin) if point else None,
                    struct.vertex if point else None, second)


class Detection(Handle):
    """The landmarks that a Model found on a Mesh, in the order of the model's names. It is immutable.
    It can be pickled, with landmarks, info, warnings, model and mesh; everything else is computed again when you ask for it.

        for landmark in detection: print(landmark.name, landmark.position, landmark.confidence)
        detection["nose"].triangle
    """

    _kind = "detection"
    _joint_names: list[str] = []
    _origin = (0.0, 0.0, 0.0)  # of the mesh
    _made_of: tuple[Any, Any, dict[str, Any]] | None = None  # model, mesh or analysis, parameters
    _kept: dict[str, Any] | None = None  # of one that came from a pickle

    def __reduce__(self) -> tuple[Any, ...]:
        return detection_again, (Detection, detection_state(self))

    def _made_now(self) -> Any:
        if self._made_of is None or self._kept is None:
            return None
        with self._borrowing:
            if self._pointer is None:
                model, mesh, parameters = self._made_of
                again = model.detect(mesh, **parameters)
                self._pointer, again._pointer = again._pointer, None
            return self._pointer

    @property
    def closed(self) -> bool:
        """Whether close() has been called."""
        return self._pointer is None and self._kept is None

    def close(self) -> None:
        self._kept = self._made_of = None
        super().close()

    def _facts(self) -> str:
        found = sum(not landmark.absent for landmark in self)
        return f"{found} of {len(self)} landmarks, category fit {self.category_fit:.2f}"

    @property
    def joint_names(self) -> list[str]:
        """Of the model's skeleton, see Model.joint_names."""
        return list(self._joint_names)

    def __init__(self) -> None:
        raise TypeError("make a Detection with Model.detect")

    @property
    def landmarks(self) -> list[Landmark]:
        if self._kept:
            return list(self._kept["landmarks"])
        struct, found = new(_abi.focal_landmark), []
        with self._borrow() as handle:
            for index in range(library().focal_detection_landmark_count(handle)):
                call("focal_detection_get_landmark", handle, index, ctypes.byref(struct))
                found.append(_landmark_of(struct, self._origin))
        return found

    def __iter__(self) -> Iterator[Landmark]:
        return iter(self.landmarks)

    def __len__(self) -> int:
        return int(self.info["landmark_count"])

    def __getitem__(self, which: str | int) -> Landmark:
        """By name or number. KeyError, IndexError."""
        landmarks = self.landmarks
        return landmarks[numbered(which, [landmark.name for landmark in landmarks])]

    @property
    def info(self) -> dict[str, Any]:
        """landmark_count, warning_count, has_votes, vertex_count, triangle_count, category_fit, backend."""
        if self._kept:
            return dict(self._kept["info"])
        info = new(_abi.focal_detection_info)
        call("focal_detection_get_info", self._handle, ctypes.byref(info))
        return as_dict(info)

    @property
    def category_fit(self) -> float:
        """0..1: how far this mesh belongs to the model's category."""
        return float(self.info["category_fit"])

    @property
    def seconds(self) -> dict[str, float]:
        """Wall time of each stage; "total": all of them and the time between."""
        if self._kept:
            return dict(self._kept["seconds"])
        seconds = new(_abi.focal_stage_seconds)
        call("focal_detection_get_seconds", self._handle, ctypes.byref(seconds))
        return as_dict(seconds)

    @property
    def warnings(self) -> list[str]:
        """Plain sentences, the mesh's own first."""
        if self._kept:
            return list(self._kept["warnings"])
        return self._texts("focal_detection_warning", self.info["warning_count"])

    def votes(self, landmark: str | int) -> Floats:
        """(vertex_count,) floats in 0..1: the vote map of one landmark. Error with Status.UNSUPPORTED when votes were
        not kept."""
        return self._per_vertex("focal_detection_votes", landmark)

    def distances(self, landmark: str | int) -> Floats:
        """(vertex_count,) floats: distances along the surface from the landmark, in the mesh's units; infinite where
        no triangle uses the vertex. Error with Status.INVALID_LANDMARK when it has no place at all."""
        return self._per_vertex("focal_detection_distances", landmark)

    def region(self, landmark: str | int, radius: float) -> Floats:
        """(vertex_count,) floats: 1 within `radius` of the landmark along the surface, 0 outside, in between at its
        border. radius is a share of sqrt(surface area), so one number means the same region on every mesh."""
        return self._per_vertex("focal_detection_region", landmark, real(radius, "radius"))

    def _per_vertex(self, getter: str, landmark: str | int, *arguments: Any) -> Floats:
        room = empty("f", self.info["vertex_count"])
        index = numbered(landmark, [one.name for one in self.landmarks])
        call(getter, self._handle, index, *arguments, room.rows, room.pointer)
        found: Floats = result(room.owner)
        return found

    def segment(self, method: _abi.Segmentation | str = "auto", *, task: Task | None = None,
                on_progress: Progress | None = None) -> Labels:
        """(triangle_count,) labels; -1: no label.

        method  "skeleton": the joint that moves a triangle most (numbers of Model.joint_names); "geodesic": the
                landmark nearest along the surface (numbers of landmarks); "k_means": clusters that start at the
                landmarks; "auto": skeleton if the model has one, otherwise geodesic
        """
        chosen, room = choice(_abi.Segmentation, method, "method"), empty("i", self.info["triangle_count"])
        handle = self._handle
        run(lambda task_handle: call("focal_detection_segment", handle, chosen, task_handle, room.rows, room.pointer),
            task, on_progress)
        labels: Labels = result(room.owner)
        return labels

    def correspond(self, target: Detection, *, task: Task | None = None,
                   on_progress: Progress | None = None) -> Correspondence:
        """A point of the target's mesh for every vertex of this one's; both detected with the same model. About a
        second. Error: INVALID_ARGUMENT (different models; fewer than three landmarks found on both); Cancelled."""
        handle, other = self._handle, handle_of(target, Detection, "target")
        counts = self.info["vertex_count"], target.info["vertex_count"]

        def correspond(task_handle: Any) -> Correspondence:
            found = Correspondence._adopt(create("focal_correspondence_create", _abi.focal_correspondence, handle,
                                                 other, task_handle), self._context)
            found._counts = counts
            return found

        return run(correspond, task, on_progress)

    def rig(self, *, names: _abi.BoneNames | str | None = None,
            joint_names: Sequence[str | None] | Mapping[str, str] | None = None, animations: Mesh | None = None,
            rest_pose: bool | _abi.Pose | str | None = None, symmetric: bool | None = None, max_influences: int | None = None,
            skeleton_template: str | Mapping[str, Any] | None = None,
            fixed_joints: Mapping[str, Sequence[float]] | None = None, ground_root: bool | None = None,
            drop_helpers: bool | None = None, task: Task | None = None, on_progress: Progress | None = None) -> Skeleton:
        """Joints and skin weights for this mesh, in its current pose. Takes about a second.

        names              "as_trained" (default), "vrm", "mixamo", "unreal", "rigify", "unity", "rigify_metarig"
        joint_names        your own names: {name in the model: yours}, or one (or None) for each joint in order
        animations         a rigged character, loaded from glTF, whose animations Skeleton.write adds
        rest_pose          the pose that the file shows: "mesh" (default), "teachers" (True): the rest pose of the training
                           characters, "t": the same with level arms, "a": with arms 45 degrees below the level
        symmetric          joints and weights become mirror images if the mesh is symmetric; otherwise bones of both sides get
                           the same length, with a warning
        max_influences     joints that move one vertex, 1 to 8 (default 4)
        skeleton_template  your own skeleton over the landmarks, as JSON text or as a mapping
        fixed_joints       {name in the model or template: (x, y, z)}: known joints, such as corrections by hand. They
                           stay exactly there; the others follow, less so with distance along the bones
        ground_root        adds a joint, "root", first and above all others, on the ground
        drop_helpers       omits twist bones and helpers (recognised by their names); their parent joints take over what they moved

        Error: INVALID_ARGUMENT (no template, and the model was not trained on rigged characters; fewer than three
        landmarks found), INVALID_FILE (the template is not JSON); Cancelled.
        """
        character = None if animations is None else handle_of(animations, Mesh, "animations")
        params = skeleton_params(self._joint_names, names=names, joint_names=joint_names, animations=character,
                                 rest_pose=rest_pose, symmetric=symmetric, max_influences=max_influences, ground_root=ground_root, drop_helpers=drop_helpers,
                                 skeleton_template=skeleton_template, fixed_joints=fixed_joints, origin=self._origin)
        handle = self._handle

        def rig(task_handle: Any) -> Skeleton:
            made = Skeleton._adopt(create("focal_skeleton_create", _abi.focal_skeleton, handle, ctypes.byref(params),
                                          task_handle), self._context)
            made._origin = self._origin
            return made

        return run(rig, task, on_progress)

    def write(self, path: str | os.PathLike[str]) -> None:
        """Writes a file; its suffix, in upper or lower case, chooses the format. .glb, .gltf, .vrm: the mesh's own glTF, nothing lost, with a
        node for each landmark that is not absent; a mesh that has no file as a plain .glb. .landmarks.json, .csv: the
        landmarks alone (`focal convert` makes other programs' files of them). ValueError: another ending. Error:
        INVALID_ARGUMENT (the suffix of the other kind of glTF), IO, FILE_NOT_FOUND."""
        name = os.fsdecode(path).lower()
        if name.endswith((".glb", ".gltf", ".vrm")):
            call("focal_detection_write_gltf", self._handle, path_text(path))
        elif name.endswith(".json") and not name.endswith(".mrk.json"):
            write_text(path, landmarks_json(self.landmarks))
        elif name.endswith(".csv"):
            write_text(path, landmarks_csv(self.landmarks))
        else:
            raise ValueError(f"{os.fsdecode(path)!r} ends in none of .glb, .gltf, .vrm, .landmarks.json and .csv")

    def write_votes(self, path: str | os.PathLike[str]) -> None:
        """Writes a .glb with the vote maps as vertex colours. Error: UNSUPPORTED when votes were not kept."""
        call("focal_detection_write_votes_gltf", self._handle, path_text(path))

    def write_segments(self, path: str | os.PathLike[str], method: _abi.Segmentation | str = "auto") -> None:
        """Writes a .glb with the parts as vertex colours. method: as in segment()."""
        call("focal_detection_write_segments_gltf", self._handle, choice(_abi.Segmentation, method, "method"),
             path_text(path))
