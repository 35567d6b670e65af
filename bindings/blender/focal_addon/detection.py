"""Finding a model's landmarks on the active mesh, and looking at how sure it is."""
import collections
import os
import typing

import bpy
from bpy.props import BoolProperty

from . import display, engine, landmark_data
from .geometry import Surface, Unusable, hints_of, object_named
from .jobs import JobOperator
from .landmark_data import active_of
from .training import model_path

_ANALYSIS_SHARE = 0.6  # of the time that a detection takes, about

_STATUS = ("FOUND", "UNCERTAIN", "ABSENT")  # focal.LandmarkStatus in its order

# Rigs, parts and heat maps start from a detection, corrections from the mesh's analysis: a few MB each, so only the
# last ones are kept. A mesh that was changed has another key and never meets them.
_KEPT = 3
_detections = collections.OrderedDict()  # (surface key, model key, quality) -> Known
_model = (None, None)  # model key, Model


def clear_cache():
    global _model
    _detections.clear()
    _model = (None, None)


class Known(typing.NamedTuple):
    """What was found on a mesh, and what it takes to look again."""
    analysis: typing.Any
    fixed: typing.Any  # as Target's, when it was found
    detection: typing.Any


class Target:
    """What one mesh's detection needs, read from the scene in the main thread. With keep_marked, landmarks set by hand
    are fixed, and the others are chosen to suit them."""

    def __init__(self, context, obj, keep_marked=True):
        engine.focal()
        self.surface = Surface(obj)
        self.positions, self.faces = self.surface.positions(), self.surface.faces()
        self.path = model_path(context, must_exist=True)
        stat = os.stat(self.path)
        self.model_key = (self.path, stat.st_mtime_ns, stat.st_size, engine.context())
        self.quality = context.scene.focal.search.lower()
        self.key = (self.surface.key(), self.model_key, self.quality)
        self.fixed = landmark_data.fixed_places(obj, self.surface) if keep_marked else {}
        self.known = _detections.get(self.key)

    @property
    def ready(self):
        """Whether there is nothing left to detect."""
        return self.known is not None and self.known.fixed == self.fixed

    def detect(self, job, start=0.0, end=1.0):
        """The detection, from before where there is one; runs in the thread."""
        if not self.ready:
            stage, middle = f"detecting on {self.surface.name}", start
            model = _loaded(self.model_key)
            if self.known is None:
                middle += _ANALYSIS_SHARE * (end - start)
                analysis = self._analyse(model, job.begin(stage, start, middle))
            else:
                analysis = self.known.analysis
            found = model.detect(analysis, quality=self.quality, fixed=self._fixed_in(model),
                                 task=job.begin(stage, middle, end))
            self.known = Known(analysis, self.fixed, found)
        return self.known.detection

    def _analyse(self, model, task):
        mesh = engine.package().Mesh(self.positions, self.faces, context=self.model_key[-1])
        return model.analyse(mesh, quality=self.quality, task=task)

    def _fixed_in(self, model):
        """Those that the model knows; the paper's method finds each landmark on its own."""
        package = engine.package()
        if model.train_params["preset"] == package.Preset.PAPER:
            return {}
        names = set(model.landmark_names)
        return {name: package.SurfacePoint(*place) for name, place in self.fixed.items() if name in names}

    def remember(self):
        """In the main thread, after the work."""
        if self.known is not None:
            _detections[self.key] = self.known
            _detections.move_to_end(self.key)
            while len(_detections) > _KEPT:
                _detections.popitem(last=False)

    def object(self):
        """The mesh as it is now; Unusable when it is not the one that was looked at."""
        obj = object_named(self.surface.name)
        if Surface(obj).key() != self.surface.key():
            raise Unusable(f"'{obj.name}' was changed meanwhile: run it again")
        return obj


def _loaded(model_key):
    """The model of a file, kept until another one is asked for."""
    global _model
    if _model[0] != model_key:
        _model = (model_key, engine.package().Model.load(model_key[0], context=model_key[-1]))
    return _model[1]


def model_of(target):
    return _loaded(target.model_key)


class FOCAL_OT_detect(JobOperator, bpy.types.Operator):
    """Find the model's landmarks on the active mesh. Esc cancels"""
    bl_idname = "focal.detect"
    bl_label = "Detect"
    bl_options = {"REGISTER", "UNDO"}

    keep_marked: BoolProperty(
        name="Keep marks", default=True,
        description="Landmarks set or accepted by hand stay, and the others are chosen to suit them")

    def prepare(self, context):
        self._target = Target(context, context.active_object, self.keep_marked)
        return lambda job: self._target.detect(job)

    def apply(self, context, detection):
        obj = self._target.object()
        self._target.remember()
        write_landmarks(context, obj, self._target, detection, self.keep_marked)
        placed, total, unsure = landmark_data.counts(obj)
        hints = "; ".join(hints_of(obj))
        text = f"{placed} of {total} landmarks placed, {unsure} uncertain" + (f"; {hints}" if hints else "")
        self.report({"WARNING"} if obj.focal.category_fit < 0.2 else {"INFO"},
                    text if obj.focal.category_fit >= 0.2 else f"This mesh is hardly of the model's kind. {text}")


def write_landmarks(context, obj, target, detection, keep_marked=True):
    """A detection's landmarks into the object's list, in the model's order where the list was empty."""
    for found in detection:
        mark = landmark_data.ensure(obj, found.name)
        if keep_marked and mark.by_hand:
            continue
        if found.absent or found.point is None:
            landmark_data.unplace(mark, "ABSENT")
        else:
            landmark_data.place(obj, mark, target.surface, found.point.triangle,
                                target.surface.turned(found.point.barycentric), _STATUS[int(found.status)])
        mark.confidence = found.confidence
        mark.expected_error = found.expected_error
        _write_runner_up(mark, target.surface, found.runner_up)
    obj.focal.model = target.path
    obj.focal.category_fit = detection.category_fit
    display.update_empties(context, obj)
    display.refresh(context, obj)


def _write_runner_up(mark, surface, place):
    mark.runner_up_triangle = -1 if place is None else place.point.triangle
    if place is not None:
        mark.runner_up_barycentric = surface.turned(place.point.barycentric)
        mark.runner_up_confidence = place.confidence


class FOCAL_OT_show_votes(JobOperator, bpy.types.Operator):
    """Colour the mesh by where the model looked for the active landmark: red is where most votes fell"""
    bl_idname = "focal.show_votes"
    bl_label = "Vote Map"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return super().poll(context) and active_of(context.active_object) is not None

    def prepare(self, context):
        self._target = Target(context, context.active_object)
        name = active_of(context.active_object).name

        def work(job):
            detection = self._target.detect(job)
            if name not in [found.name for found in detection]:
                raise Unusable(f"The model does not know '{name}'")
            return detection.votes(name)
        return work

    def apply(self, context, votes):
        obj = self._target.object()
        self._target.remember()
        display.write_colours(obj.data, display.VOTES, "POINT", display.heat_colours(votes))
        display.show_colours(context)


class FOCAL_OT_next_uncertain(bpy.types.Operator):
    """Go to the next landmark that the model is not sure of"""
    bl_idname = "focal.next_uncertain"
    bl_label = "Next Uncertain"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return active_of(context.active_object) is not None

    def execute(self, context):
        obj = context.active_object
        marks = obj.focal.landmarks
        for step in range(1, len(marks) + 1):
            at = (obj.focal.active + step) % len(marks)
            if marks[at].status == "UNCERTAIN":
                obj.focal.active = at
                return {"FINISHED"}
        self.report({"INFO"}, "No landmark is uncertain")
        return {"CANCELLED"}


CLASSES = (FOCAL_OT_detect, FOCAL_OT_show_votes, FOCAL_OT_next_uncertain)


def register():
    for cls in CLASSES:
        bpy.utils.register_class(cls)


def unregister():
    clear_cache()
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
