"""Models: training, loading, detection; and analyses of meshes."""
from __future__ import annotations

import ctypes
import itertools
import os
import tempfile
from typing import Any, Mapping, Sequence

from . import _abi
from ._arrays import Floats, empty, result
from ._context import Context, context_or_default
from ._detection import Detection
from ._handle import Handle, handle_of
from ._library import call, create, descriptors, distances, library
from ._mesh import Mesh, bytes_of, marked_point
from ._task import Progress, Task, run
from ._training_set import TrainingSet
from ._values import Mark, as_dict, choice, fill, given_of, listed, new, numbered, path_text


class Model(Handle):
    """A trained model. It is immutable and can be pickled. It contains geometry of its training meshes."""

    _kind = "model"
    _info: dict[str, Any] | None = None  # to count its bytes the library writes the whole model

    def __init__(self) -> None:
        raise TypeError("make a Model with Model.load_stock, Model.train, Model.load or Model.from_bytes")

    @classmethod
    def train(cls, training_set: TrainingSet, *, preset: _abi.Preset | str | None = None,
              eigenpair_count: int | None = None, tree_count: int | None = None, min_leaf_samples: int | None = None,
              components_per_split: int | None = None, sampling_rate: float | None = None,
              max_samples_per_shape: int | None = None, proxy_vertices: int | None = None, seed: int | None = None,
              learn_confidence: bool | None = None, rigged_shapes: int | None = None,
              descriptor: _abi.Descriptor | str | int | None = None, distance: _abi.Distance | str | int | None = None,
              task: Task | None = None, on_progress: Progress | None = None) -> Model:
        """Learns a model; seconds to minutes.

        preset                 "default", or "paper": exactly as in Xia et al. 2016
        eigenpair_count        of the Laplacian, 8..2000. Default 128 (paper: 200)
        tree_count             1..10000. Default 30
        min_leaf_samples       1 or more. Default 5
        components_per_split   1 or more. Default 5
        sampling_rate          of the vertices analysed, above 0 to 1. Default 1 (paper: 0.5)
        max_samples_per_shape  1 or more. Default 6250
        proxy_vertices         meshes with more are analysed on a copy with this many; 0: as they are. Default 3500 (paper: 0)
        seed                   the same seed gives the same model. Default 0
        learn_confidence       takes three quarters of the time; without it every confidence is about one half. Default True
        rigged_shapes          total learned from rigged characters, including posed copies. Default 16
        descriptor             "si-hks" or another name of focal.descriptors(). Default "si-hks"
        distance               "heat" or another name of focal.distances(). Default "heat"
        task, on_progress      see focal.Task; on_progress(progress in 0..1, stage: str) is called on this thread,
                               about twenty times a second; an exception that it raises cancels the training and is raised here

        Error: TOO_FEW_SHAPES (a landmark marked on fewer than two meshes), NOT_CONVERGED, INVALID_ARGUMENT; Cancelled.
        """
        handle_of(training_set, TrainingSet, "training_set")
        params = new(_abi.focal_train_params)
        if preset is not None:
            chosen = choice(_abi.Preset, preset, "preset")
            call("focal_train_params_set_preset", ctypes.byref(params), chosen)
        fill(params, eigenpair_count=eigenpair_count, tree_count=tree_count, min_leaf_samples=min_leaf_samples,
             components_per_split=components_per_split, sampling_rate=sampling_rate,
             max_samples_per_shape=max_samples_per_shape, proxy_vertices=proxy_vertices, seed=seed,
             learn_confidence=learn_confidence, rigged_shapes=rigged_shapes,
             descriptor=listed(descriptor, descriptors(), "descriptor"),
             distance=listed(distance, distances(), "distance"))

        def train(task_handle: Any) -> Model:
            return cls._adopt(create("focal_model_train", _abi.focal_model, set_handle, ctypes.byref(params),
                                     task_handle), training_set._context)

        with training_set._trained() as set_handle:
            return run(train, task, on_progress)

    @classmethod
    def load(cls, path: str | os.PathLike[str], *, context: Context | None = None) -> Model:
        """Error: FILE_NOT_FOUND, IO, INVALID_FILE (with the damaged section), UNSUPPORTED_VERSION."""
        file, running = path_text(path), context_or_default(context)
        return cls._adopt(create("focal_model_load", _abi.focal_model, running._handle, file), running)

    @classmethod
    def load_stock(cls, name: str, *, context: Context | None = None) -> Model:
        """One of the models that come with focal, by its name: focal.stock_models() lists them. Error: FILE_NOT_FOUND (no
        such stock model: the hint names those there are), and those of load()."""
        if not isinstance(name, str):
            raise TypeError(f"name must be a str, not {type(name).__name__}")
        running = context_or_default(context)
        return cls._adopt(create("focal_model_load_stock", _abi.focal_model, running._handle, name.encode("utf-8")), running)

    @classmethod
    def from_bytes(cls, data: Any, *, context: Context | None = None) -> Model:
        """From the bytes of to_bytes() (bytes-like). Errors as load()."""
        memory, running = bytes_of(data), context_or_default(context)
        return cls._adopt(create("focal_model_load_memory", _abi.focal_model, running._handle, memory, len(memory)),
                          running)

    def _facts(self) -> str:
        with self._borrow() as handle:  # to fill its info the library writes the whole model
            landmarks = next(i for i in itertools.count() if library().focal_model_landmark_name(handle, i) is None)
            joints = library().focal_model_joint_count(handle)
        return f"{landmarks} landmarks" + (f", {joints} joints" if joints else "")

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the model's file, completely or not at all. Error: IO, FILE_NOT_FOUND (no such folder)."""
        call("focal_model_save", self._handle, path_text(path))

    def to_bytes(self) -> bytes:
        """What save() would write."""
        blob = create("focal_model_save_memory", _abi.focal_blob, self._handle)
        try:
            return ctypes.string_at(library().focal_blob_data(blob), library().focal_blob_size(blob))
        finally:
            library().focal_blob_destroy(blob)

    def __reduce__(self) -> tuple[Any, ...]:
        return Model.from_bytes, (self.to_bytes(),)

    @property
    def info(self) -> dict[str, Any]:
        """preset, landmark_count, shape_count (training meshes), mean_vertex_count, sample_count, tree_node_count,
        file_bytes."""
        handle = self._handle
        if self._info is None:
            info = new(_abi.focal_model_info)
            call("focal_model_get_info", handle, ctypes.byref(info))
            self._info = as_dict(info)
        return dict(self._info)

    @property
    def train_params(self) -> dict[str, Any]:
        """The parameters of train() with which the model was trained."""
        params = new(_abi.focal_train_params)
        call("focal_model_get_train_params", self._handle, ctypes.byref(params))
        return {**as_dict(params), "descriptor": descriptors()[params.descriptor],
                "distance": distances()[params.distance]}

    @property
    def landmark_names(self) -> list[str]:
        return self._texts("focal_model_landmark_name", self.info["landmark_count"])

    @property
    def joint_names(self) -> list[str]:
        """Joint names of the skeleton learned from rigged characters, parents first, or of the template in the model; empty
        without either."""
        return self._texts("focal_model_joint_name", library().focal_model_joint_count(self._handle))

    @property
    def skeleton_template(self) -> str | None:
        """The skeleton template in the model, over its marked landmarks, as JSON text; see TrainingSet.set_skeleton()."""
        text = library().focal_model_skeleton_template(self._handle)
        return None if text is None else str(text, "utf-8")

    def detect(self, mesh: Mesh | Analysis, *, quality: _abi.Quality | str | None = None,
               orientation: _abi.Orientation | str | None = None, sampling_rate: float | None = None, max_samples: int | None = None,
               peaks_per_landmark: int | None = None, found_confidence: float | None = None,
               absent_confidence: float | None = None, keep_votes: bool | None = None, seed: int | None = None,
               fixed: Mapping[str, Mark] | None = None, task: Task | None = None,
               on_progress: Progress | None = None) -> Detection:
        """Finds the landmarks on a mesh, in a fraction of a second; on an Analysis of it in about 0.1 s.

        quality             "best", or "interactive": faster, for a viewport
        orientation         of models of rigs: "upright", which expects meshes to stand and face like the training characters and
                            tries others at a cost, or "any": all headings and up axes are equally likely. Default "upright"
        sampling_rate       of the vertices analysed, 0..1. Default 0: chosen for the model and quality
        max_samples         1 or more. Default 1250
        peaks_per_landmark  candidates among which the constellation chooses, 1..64. Default 8
        found_confidence    below it a landmark is uncertain. Default 0.5
        absent_confidence   below it a landmark is absent, 0..found_confidence. Default 0.05
        keep_votes          keep the vote maps. Default True
        seed                the same seed gives the same result. Default 1
        fixed               {name: vertex number, SurfacePoint or (x, y, z)}: known places, such as corrections by hand. They
                            stay, and the other landmarks are chosen to be consistent with them
        task, on_progress   as in train()

        ValueError: a fixed name that the model does not know. Error: NOT_CONVERGED, INVALID_ARGUMENT (also: an analysis made for a model with other parameters); Cancelled.
        """
        if isinstance(mesh, Analysis):
            given, surface, function = mesh._handle, mesh._mesh, "focal_model_detect_analysis"
        else:
            given, surface, function = handle_of(mesh, Mesh, "mesh"), mesh, "focal_model_detect"
        given_params = given_of(quality=quality, orientation=orientation, sampling_rate=sampling_rate, max_samples=max_samples,
                                peaks_per_landmark=peaks_per_landmark,
                                found_confidence=found_confidence, absent_confidence=absent_confidence, keep_votes=keep_votes, seed=seed)
        params = fill(new(_abi.focal_detect_params), **given_params)
        handle, names = self._handle, self.joint_names
        if fixed:
            given_params["fixed"] = fixed = dict(fixed)
            points = self._fixed(fixed, surface)
            params.fixed_points, params.fixed_point_count = points, len(points)

        def detect(task_handle: Any) -> Detection:
            found = Detection._adopt(create(function, _abi.focal_detection, handle, given, ctypes.byref(params),
                                            task_handle), self._context)
            found._joint_names, found._origin, found._made_of = names, surface.origin, (self, mesh, given_params)
            return found

        return run(detect, task, on_progress)

    def regress(self, analysis: Analysis, landmark: str | int, truth: Mark, *, task: Task | None = None,
                on_progress: Progress | None = None) -> tuple[Floats, Floats]:
        """Runs the regression on an analysis: for each sample point the distance to the landmark regressed from
        its descriptor, and the true distance to `truth`, a vertex number or a SurfacePoint. In units of
        sqrt(surface area); preset paper: shares of the sample's largest distance."""
        given, handle = handle_of(analysis, Analysis, "analysis"), self._handle
        index, place = numbered(landmark, self.landmark_names), marked_point(analysis._mesh, truth, "truth")
        count = library().focal_analysis_sample_count(given)
        regressed, true = empty("f", count), empty("f", count)
        run(lambda task_handle: call("focal_model_regress", handle, given, index, ctypes.byref(place), task_handle,
                                     count, regressed.pointer, true.pointer), task, on_progress)
        return result(regressed.owner), result(true.owner)

    def detect_many(self, meshes: Sequence[Mesh], *, quality: _abi.Quality | str | None = None,
                    orientation: _abi.Orientation | str | None = None, sampling_rate: float | None = None, max_samples: int | None = None,
                    peaks_per_landmark: int | None = None, found_confidence: float | None = None,
                    absent_confidence: float | None = None, keep_votes: bool | None = None, seed: int | None = None,
                    task: Task | None = None, on_progress: Progress | None = None) -> list[Detection]:
        """Runs detect() on many meshes in parallel, one per thread, with a higher throughput than single calls. It returns all
        results or none: an Error gives the number of the mesh that failed. Progress counts meshes: on_progress(0.3, "3 of 10 meshes")."""
        handles = [handle_of(mesh, Mesh, "meshes") for mesh in meshes]
        given_params = given_of(quality=quality, orientation=orientation, sampling_rate=sampling_rate, max_samples=max_samples,
                                peaks_per_landmark=peaks_per_landmark,
                                found_confidence=found_confidence, absent_confidence=absent_confidence, keep_votes=keep_votes, seed=seed)
        params = fill(new(_abi.focal_detect_params), **given_params)
        handle, names = self._handle, self.joint_names
        given: Any = (ctypes.POINTER(_abi.focal_mesh) * max(1, len(handles)))(*handles)
        found: Any = (ctypes.POINTER(_abi.focal_detection) * max(1, len(handles)))()
        run(lambda task_handle: call("focal_model_detect_many", handle, given, len(handles), ctypes.byref(params),
                                     task_handle, found), task, _counted(on_progress, len(handles)))
        detections = [Detection._adopt(one, self._context) for one in found[:len(handles)]]
        for one, mesh in zip(detections, meshes):
            one._joint_names, one._origin, one._made_of = names, mesh.origin, (self, mesh, given_params)
        return detections

    def _fixed(self, fixed: Mapping[str, Mark], mesh: Mesh) -> Any:
        names = self.landmark_names
        for name in fixed:
            if name not in names:
                raise ValueError(f"{name!r} is no landmark of this model: {', '.join(names)}")
        points = [marked_point(mesh, fixed.get(name), f"the fixed place of {name!r}") for name in names]
        return (_abi.focal_surface_point * len(points))(*points)

    def analyse(self, mesh: Mesh, *, quality: _abi.Quality | str | None = None, sampling_rate: float | None = None,
                max_samples: int | None = None, seed: int | None = None, task: Task | None = None,
                on_progress: Progress | None = None) -> Analysis:
        """The part of a detection that takes nearly all of its time, for reuse with every model that has the same
        eigenpair_count, proxy_vertices and preset. Parameters and errors as detect()."""
        given, handle = handle_of(mesh, Mesh, "mesh"), self._handle
        params = fill(new(_abi.focal_detect_params), quality=quality, sampling_rate=sampling_rate,
                      max_samples=max_samples, seed=seed)

        def analyse(task_handle: Any) -> Analysis:
            made = Analysis._adopt(create("focal_model_analyse", _abi.focal_analysis, handle, given,
                                          ctypes.byref(params), task_handle), self._context)
            made._mesh = mesh
            return made

        return run(analyse, task, on_progress)


class Analysis(Handle):
    """An analysed mesh, from Model.analyse; pass it to Model.detect of many models. It contains the mesh's geometry and can be
    pickled."""

    _kind = "analysis"
    _mesh: Mesh  # that was analysed

    def __init__(self) -> None:
        raise TypeError("make an Analysis with Model.analyse or Analysis.load")

    def __reduce__(self) -> tuple[Any, ...]:
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "analysis")
            self.save(path)
            with open(path, "rb") as file:
                return _analysis_again, (self._mesh, file.read())

    @classmethod
    def load(cls, mesh: Mesh, path: str | os.PathLike[str], *, context: Context | None = None) -> Analysis:
        """Reads a file of save(), for the same mesh. Error: INVALID_FILE (damaged, or of another mesh), FILE_NOT_FOUND,
        IO, UNSUPPORTED_VERSION."""
        given, file, running = handle_of(mesh, Mesh, "mesh"), path_text(path), context_or_default(context)
        made = cls._adopt(create("focal_analysis_load", _abi.focal_analysis, running._handle, given, file), running)
        made._mesh = mesh
        return made

    def _facts(self) -> str:
        return f"{self._mesh.vertex_count} vertices, {library().focal_analysis_sample_count(self._handle)} samples"

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the analysis to a file of a few MB. Error: IO, FILE_NOT_FOUND (no such folder)."""
        call("focal_analysis_save", self._handle, path_text(path))


def _analysis_again(mesh: Mesh, data: bytes) -> Analysis:
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "analysis")
        with open(path, "wb") as file:
            file.write(data)
        return Analysis.load(mesh, path)


def _counted(report: Progress | None, count: int) -> Progress | None:
    if report is None:
        return None
    call = report
    return lambda progress, _: call(progress, f"{round(progress * count)} of {count} meshes")
