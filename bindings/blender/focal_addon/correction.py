"""Landmarks set or accepted by hand stay, and the model chooses the others to suit them."""
import bpy
from bpy.props import BoolProperty

from . import jobs, landmark_data
from .detection import Target, write_landmarks
from .geometry import Unusable, character_of, problem_of
from .jobs import JobOperator
from .model_files import file_of, model_path


class FOCAL_OT_resolve(JobOperator, bpy.types.Operator):
    """Find the landmarks again; those set or accepted by hand stay, and the others are chosen to be consistent with them. Esc
cancels"""
    bl_idname = "focal.resolve"
    bl_label = "Re-solve"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        obj = context.active_object
        return super().poll(context) and obj is not None and obj.type == "MESH" and obj.focal.model != ""

    with_step: BoolProperty(
        options={"SKIP_SAVE", "HIDDEN"},
        description="The correction before has no step of undo yet: it gets one also when this is cancelled")

    def prepare(self, context):
        self._target = Target(context, character_of(context, context.active_object))
        if not self._target.fixed:
            raise Unusable("Set or accept a landmark first: the others are then chosen to suit it")
        return lambda job: self._target.detect(job)

    def apply(self, context, detection):
        target, objects = self._target, self._target.objects()
        obj = objects[0]
        target.remember()
        before = _positions(objects)
        write_landmarks(context, objects, target, detection)
        least = 1e-6 * target.surface.size()
        moved = sum(key not in before or (position - before[key]).length > least
                    for key, position in _positions(objects).items())
        unsure = sum(landmark_data.counts(one)[2] for one in objects)
        self.report({"INFO"}, f"{moved} landmark{'' if moved == 1 else 's'} moved, {unsure} uncertain")
        in_window = self._job is not None
        if in_window and target.fixed_on(objects) != target.fixed:
            follow(context, obj, True)  # another correction came while this one was worked on


    @property
    def shows_progress(self):
        return not self.with_step

    def _finish(self, context, job):
        done = super()._finish(context, job)
        if done != {"FINISHED"} and self.with_step:
            bpy.ops.ed.undo_push(message="Correction")
        return done

    def report_cancelled(self):
        self.report({"INFO"}, "Cancelled: the correction stays, the others were not looked for")


def _positions(objects):
    return {(obj.name, mark.name): mark.position.copy() for obj in objects for mark in obj.focal.landmarks if mark.placed}


def follow(context, obj, in_window, with_step=False):
    """After landmarks were set by hand: the others are looked for again where that is wanted. Whether they are.
    in_window: as a job beside the user, else before this returns. with_step: see FOCAL_OT_resolve."""
    if not _wanted(context, obj):
        return False
    if jobs.current() is None:
        bpy.ops.focal.resolve("INVOKE_DEFAULT" if in_window else "EXEC_DEFAULT", with_step=with_step)
    return True


def _wanted(context, obj):
    """Of a mesh that the scene's model has looked at, when there is something left to look for."""
    if not context.scene.focal.resolve or obj.mode != "OBJECT" or not obj.focal.model:
        return False
    if problem_of(obj) or all(mark.by_hand for mark in obj.focal.landmarks):
        return False
    try:
        return model_path(context, must_exist=True) == file_of(obj.focal.model)
    except Unusable:
        return False


def register():
    bpy.utils.register_class(FOCAL_OT_resolve)


def unregister():
    bpy.utils.unregister_class(FOCAL_OT_resolve)
