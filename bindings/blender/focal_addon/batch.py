"""All meshes of a collection in one go, each for itself or as one character, and one step of undo."""
import bpy

from .detection import Target, write_landmarks
from .engine import FAILURES, message_of
from .geometry import Unusable
from .jobs import Cancelled, JobOperator
from .rigging import RigTarget, write_rig
from .templates import TemplateError


class FOCAL_OT_batch(JobOperator, bpy.types.Operator):
    """Detect landmarks on every mesh of the collection, and rig it if that is ticked. Meshes that fail are reported at
the end and do not stop the others. Esc cancels"""
    bl_idname = "focal.batch"
    bl_label = "Run on Collection"
    bl_options = {"REGISTER", "UNDO"}

    def prepare(self, context):
        settings = context.scene.focal
        if settings.batch is None:
            raise Unusable("Choose a collection")
        self._rig, self._failed, targets = settings.batch_rig, [], []
        meshes = [obj for obj in settings.batch.all_objects if obj.type == "MESH"]
        for group in [meshes] if settings.batch_together and meshes else [[obj] for obj in meshes]:
            try:
                targets.append((RigTarget if self._rig else Target)(context, group))
            except Unusable as error:
                self._failed.append(str(error))
        if not targets:
            raise Unusable("; ".join(self._failed) or f"'{settings.batch.name}' holds no mesh")
        return lambda job: self._work(job, targets)

    def _work(self, job, targets):
        done = []
        for number, target in enumerate(targets):
            share = number / len(targets), (number + 1) / len(targets)
            try:
                result = target.rig(job, *share) if self._rig else target.detect(job, *share)
            except (Unusable, TemplateError, *FAILURES) as error:
                if job.cancelled:
                    raise Cancelled from error
                self._failed.append(f"'{target.surface.name}': {message_of(error)}")
                continue
            target.known = target.parts = None  # a long list would fill the memory
            done.append((target, result))
        return done

    def apply(self, context, done):
        written = 0
        for target, result in done:
            try:
                objects = target.objects()
                if self._rig:
                    write_rig(context, objects, target, result)
                else:
                    write_landmarks(context, objects, target, result)
                written += 1
            except Unusable as error:
                self._failed.append(str(error))
        context.scene.focal.report = "\n".join(self._failed)
        what = "character" if context.scene.focal.batch_together else "meshes"
        text = f"{written} {what}" + (f", {len(self._failed)} left out: {self._failed[0]}" if self._failed else "")
        self.report({"WARNING"} if self._failed else {"INFO"}, text)


def register():
    bpy.utils.register_class(FOCAL_OT_batch)


def unregister():
    bpy.utils.unregister_class(FOCAL_OT_batch)
