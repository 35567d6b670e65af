"""Finding a model's landmarks on the active mesh, and looking at how sure it is."""
import collections
import os
import typing

import bpy
from bpy.props import BoolProperty

from . import display, engine, landmark_data, vote_map
from .geometry import Character, Surface, Unusable, character_of, hints_of, object_named, remember_character
from .jobs import JobOperator
from .landmark_data import active_of
from .model_files import model_path, name_of

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
    """What one character's detection needs, read from the scene in the main thread: one object, or several that are one
    character, the first of which leads. With keep_marked, landmarks set by hand are fixed, and the others are chosen to suit them."""

    def __init__(self, context, objects, keep_marked=True):
        engine.focal()
        objects = list(objects) if isinstance(objects, (list, tuple)) else [objects]
        self.character = Character([Surface(obj) for obj in objects])
        self.surface = self.character.surfaces[0]
        self.parts = self.character.parts()
        path = model_path(context, must_exist=True)
        self.model_name = name_of(context.scene.focal.model_path)
        stat = os.stat(path)
        self.model_key = (path, stat.st_mtime_ns, stat.st_size, engine.context())
        self.quality = context.scene.focal.search.lower()
        self.key = (self.character.key(), self.model_key, self.quality)
        self.fixed = self.fixed_on(objects) if keep_marked else {}
        self.known = _detections.get(self.key)

    def fixed_on(self, objects):
        """Landmarks set by hand on any of the objects, on the triangles of the character."""
        fixed = {}
        for number, obj in enumerate(objects):
            first = self.character.first_triangle[number]
            for name, (triangle, weights) in landmark_data.fixed_places(obj, self.character.surfaces[number]).items():
                fixed.setdefault(name, (first + triangle, weights))
        return fixed

    @property
    def ready(self):
        """Whether there is nothing left to detect."""
        return self.known is not None and self.known.fixed == self.fixed

    def detect(self, job, start=0.0, end=1.0):
        """The detection, from before where there is one; runs in the thread."""
        if not self.ready:
            stage, middle = f"detecting on {self.surface.name}", start
            model = self.model()
            if self.known is None:
                middle += _ANALYSIS_SHARE * (end - start)
                analysis = self._analyse(model, job.begin(stage, start, middle))
            else:
                analysis = self.known.analysis
            found = model.detect(analysis, quality=self.quality, fixed=self._fixed_in(model),
                                 task=job.begin(stage, middle, end))
            self.known = Known(analysis, self.fixed, found)
        return self.known.detection

    def model(self):
        return _loaded(self.model_key)

    def _analyse(self, model, task):
        return model.analyse(self.mesh(), quality=self.quality, task=task)

    def mesh(self):
        return engine.package().Mesh.from_parts(self.parts, context=self.model_key[-1])

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

    def objects(self):
        """The meshes as they are now; Unusable if they changed since the detection."""
        objects = [object_named(surface.name) for surface in self.character.surfaces]
        for obj, surface in zip(objects, self.character.surfaces):
            if Surface(obj).key() != surface.key():
                raise Unusable(f"'{obj.name}' was changed meanwhile: run it again")
        return objects

    def object(self):
        """The first of them."""
        return self.objects()[0]


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
        self._target = Target(context, character_of(context, context.active_object), self.keep_marked)
        return lambda job: self._target.detect(job)

    def apply(self, context, detection):
        objects = self._target.objects()
        obj = objects[0]
        self._target.remember()
        write_landmarks(context, objects, self._target, detection, self.keep_marked)
        placed, total, unsure = (sum(numbers) for numbers in zip(*map(landmark_data.counts, objects)))
        hints = "; ".join(hints_of(obj))
        text = f"{placed} of {total} landmarks placed, {unsure} uncertain" + (f"; {hints}" if hints else "")
        self.report({"WARNING"} if obj.focal.category_fit < 0.2 else {"INFO"},
                    text if obj.focal.category_fit >= 0.2 else f"This mesh is hardly of the model's kind. {text}")


def write_landmarks(context, objects, target, detection, keep_marked=True):
    """A detection's landmarks into the lists of the objects on which they lie, in the model's order where a list was empty; what is
    absent into that of the first."""
    for found in detection:
        if keep_marked and any(_by_hand(obj, found.name) for obj in objects):
            continue
        absent = found.absent or found.point is None
        number, triangle = (0, -1) if absent else target.character.owner(found.point.triangle)
        for other in objects[:number] + objects[number + 1:]:
            landmark_data.forget(other, found.name)
        mark, surface = landmark_data.ensure(objects[number], found.name), target.character.surfaces[number]
        if absent:
            landmark_data.unplace(mark, "ABSENT")
        else:
            landmark_data.place(objects[number], mark, surface, triangle, surface.turned(found.point.barycentric),
                                _STATUS[int(found.status)])
        mark.confidence = found.confidence
        mark.expected_error = found.expected_error
        _write_runner_up(mark, target, number, found.runner_up)
    remember_character(objects)
    for obj in objects:
        obj.focal.model = target.model_name
        obj.focal.category_fit = detection.category_fit
        display.update_empties(context, obj)
        display.refresh(context, obj)


def _by_hand(obj, name):
    at = landmark_data.index_of(obj, name)
    return at >= 0 and obj.focal.landmarks[at].by_hand


def _write_runner_up(mark, target, number, place):
    """Only on the same object: a landmark does not change its list by a click."""
    mark.runner_up_triangle = -1
    if place is None:
        return
    owner, triangle = target.character.owner(place.point.triangle)
    if owner == number:
        mark.runner_up_triangle = triangle
        mark.runner_up_barycentric = target.character.surfaces[number].turned(place.point.barycentric)
        mark.runner_up_confidence = place.confidence


class FOCAL_OT_show_votes(JobOperator, bpy.types.Operator):
    """Colour the mesh by the model's votes for the active landmark: red for most votes, dark blue for none"""
    bl_idname = "focal.show_votes"
    bl_label = "Vote Map"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return super().poll(context) and active_of(context.active_object) is not None

    def prepare(self, context):
        self._target = Target(context, character_of(context, context.active_object))
        name = active_of(context.active_object).name

        def work(job):
            detection = self._target.detect(job)
            if name not in [found.name for found in detection]:
                raise Unusable(f"The model does not know '{name}'")
            return detection.votes(name)
        return work

    def apply(self, context, votes):
        objects = self._target.objects()
        self._target.remember()
        for number, obj in enumerate(objects):
            own = votes[self._target.character.vertices_of(number)]
            self._show(context, obj, self._target.character.surfaces[number], display.heat_colours(own))

    @staticmethod
    def _show(context, obj, surface, colours):
        """Drawn over the mesh; in its data, where exporters find it, only when that is asked for."""
        if not context.scene.focal.keep_votes:
            vote_map.show(context, obj, surface, colours)
            return
        vote_map.hide(obj)
        display.write_colours(obj.data, display.VOTES, "POINT", colours)
        display.show_colours(context)


class FOCAL_OT_next_uncertain(bpy.types.Operator):
    """Go to the next uncertain landmark"""
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
