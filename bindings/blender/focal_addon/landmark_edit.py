"""The list of landmarks and what its buttons do."""
import bpy
from bpy.props import BoolProperty, EnumProperty, StringProperty

from . import correction, display, landmark_data, name_lists, names
from .geometry import Surface, Unusable
from .landmark_data import active_of, ensure, place_near
from .landmark_file import LandmarkFileError


class LandmarkOperator:
    """Works on the active mesh; what it cannot work on is reported, never raised."""
    bl_options = {"REGISTER", "UNDO"}
    corrected = False

    @classmethod
    def poll(cls, context):
        return context.active_object is not None and context.active_object.type == "MESH"

    def execute(self, context):
        try:
            self.corrected = self.change(context, context.active_object)
        except (Unusable, LandmarkFileError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        display.refresh(context, context.active_object)
        return {"FINISHED"}


class Correction(LandmarkOperator):
    """Sets places by hand; change() says whether it did. The other landmarks of a detected mesh follow."""
    _in_window = False

    def invoke(self, context, _event):
        self._in_window = not bpy.app.background
        return self.execute(context)

    def execute(self, context):
        done = super().execute(context)
        if done == {"FINISHED"} and self.corrected:
            try:
                correction.follow(context, context.active_object, self._in_window)
            except RuntimeError as error:  # with which an operator refuses: the correction itself stays
                self.report({"WARNING"}, str(error))
        return done


class FOCAL_OT_landmark_add(LandmarkOperator, bpy.types.Operator):
    """Add a name to the list; place it by clicking on the mesh"""
    bl_idname = "focal.landmark_add"
    bl_label = "Add Landmark"

    name: StringProperty(name="Name", default="point")

    def change(self, context, obj):
        mark = obj.focal.landmarks.add()
        mark.name = names.free_name(self.name, {m.name for m in obj.focal.landmarks})
        obj.focal.active = len(obj.focal.landmarks) - 1


class FOCAL_OT_landmark_remove(LandmarkOperator, bpy.types.Operator):
    """Remove landmarks from this mesh"""
    bl_idname = "focal.landmark_remove"
    bl_label = "Remove Landmark"

    all: BoolProperty(name="All", options={"SKIP_SAVE"})

    def change(self, context, obj):
        if self.all:
            obj.focal.landmarks.clear()
        else:
            obj.focal.landmarks.remove(obj.focal.active)
        obj.focal.active = max(0, min(obj.focal.active, len(obj.focal.landmarks) - 1))


class FOCAL_OT_landmark_unplace(LandmarkOperator, bpy.types.Operator):
    """Remove the place of this landmark"""
    bl_idname = "focal.landmark_unplace"
    bl_label = "Clear Place"

    absent: BoolProperty(name="Absent", options={"SKIP_SAVE"},
                         description="This mesh does not have it: training skips it")

    def change(self, context, obj):
        landmark_data.unplace(_active(obj), "ABSENT" if self.absent else "UNPLACED", by_hand=True)


class FOCAL_OT_landmark_cursor(Correction, bpy.types.Operator):
    """Place the active landmark at the surface point nearest to the 3D cursor"""
    bl_idname = "focal.landmark_cursor"
    bl_label = "Place at Cursor"

    def change(self, context, obj):
        surface = Surface(obj)
        mark = active_of(obj) or ensure(obj, "point")
        position = obj.matrix_world.inverted() @ context.scene.cursor.location
        place_near(obj, mark, surface, position)
        return True


class FOCAL_OT_landmark_snap(Correction, bpy.types.Operator):
    """Snap landmarks to the surface after the mesh was edited, or to where you moved their empties"""
    bl_idname = "focal.landmark_snap"
    bl_label = "Snap to Surface"

    def change(self, context, obj):
        surface = Surface(obj)
        moved, by_hand = landmark_data.snap_stale(obj, surface), 0
        for mark in obj.focal.landmarks:
            place = display.empty_place(obj, mark.name)
            if place is None or (mark.placed and (place - mark.position).length < 1e-5 * surface.size()):
                continue
            place_near(obj, mark, surface, place)
            by_hand += 1
        moved += by_hand
        self.report({"INFO"}, f"{moved} landmark{'' if moved == 1 else 's'} moved")
        return by_hand > 0


class FOCAL_OT_landmark_next(LandmarkOperator, bpy.types.Operator):
    """Go to the next landmark that has no place"""
    bl_idname = "focal.landmark_next"
    bl_label = "Next Unplaced"

    def change(self, context, obj):
        at = landmark_data.next_unplaced(obj, obj.focal.active)
        if at < 0:
            self.report({"INFO"}, "All landmarks are placed")
        else:
            obj.focal.active = at


class FOCAL_OT_landmark_accept(Correction, bpy.types.Operator):
    """Accept the place that a model found: keep it like a mark made by hand"""
    bl_idname = "focal.landmark_accept"
    bl_label = "Accept"

    all: BoolProperty(name="All", options={"SKIP_SAVE"}, description="Every landmark that a model found")

    @classmethod
    def poll(cls, context):
        return super().poll(context) and any(map(may_accept, context.active_object.focal.landmarks))

    def change(self, context, obj):
        chosen = [m for m in (obj.focal.landmarks if self.all else [_active(obj)]) if may_accept(m)]
        if not chosen:
            raise Unusable("There is nothing to accept: no model found this landmark")
        for mark in chosen:
            mark.status, mark.confidence, mark.expected_error = "MARKED", 1.0, 0.0
        return True


def may_accept(mark):
    """What was set by hand is accepted already, and what has no place cannot be."""
    return mark.placed and mark.status in {"FOUND", "UNCERTAIN"}


class FOCAL_OT_landmark_runner_up(LandmarkOperator, bpy.types.Operator):
    """Use the second-best place that the model found; press again to go back"""
    bl_idname = "focal.landmark_runner_up"
    bl_label = "Second Best"

    @classmethod
    def poll(cls, context):
        mark = active_of(context.active_object)
        return mark is not None and mark.runner_up_triangle >= 0

    def change(self, context, obj):
        mark, surface = _active(obj), Surface(obj)
        if mark.runner_up_triangle >= len(surface.triangles):
            raise Unusable("The mesh was changed since: detect again")
        old = mark.triangle, tuple(mark.barycentric), mark.confidence
        new = mark.runner_up_triangle, tuple(mark.runner_up_barycentric), mark.runner_up_confidence
        landmark_data.place(obj, mark, surface, new[0], new[1], "UNCERTAIN")
        mark.confidence = new[2]
        mark.runner_up_triangle, mark.runner_up_barycentric, mark.runner_up_confidence = old


class FOCAL_OT_landmark_mirror_names(LandmarkOperator, bpy.types.Operator):
    """Add the names of the other side: elbow.R for elbow.L, RightHand for LeftHand"""
    bl_idname = "focal.landmark_mirror_names"
    bl_label = "Add Other Side"

    def change(self, context, obj):
        missing = names.missing_mirrors([m.name for m in obj.focal.landmarks])
        for name in missing:
            ensure(obj, name)
        self.report({"INFO"}, ("Added " + ", ".join(missing)) if missing else "Every name has its other side")


class FOCAL_OT_landmark_copy_names(LandmarkOperator, bpy.types.Operator):
    """Copy the names of the first training mesh to this one, to be placed here"""
    bl_idname = "focal.landmark_copy_names"
    bl_label = "Names of the Training Meshes"

    def change(self, context, obj):
        sources = [i.object for i in context.scene.focal.training if i.object is not None and i.object != obj]
        wanted = [m.name for source in sources for m in source.focal.landmarks]
        if not wanted:
            raise Unusable("No training mesh has landmarks yet: mark one and add it to the training list")
        for name in wanted:
            ensure(obj, name)


class FOCAL_OT_landmark_names(LandmarkOperator, bpy.types.Operator):
    """Add the names of a list to this mesh, to be placed here"""
    bl_idname = "focal.landmark_names"
    bl_label = "Add Names of a List"

    kind: EnumProperty(name="List", items=tuple(
        (kind, text, f"{len(name_lists.LISTS[kind])} names: {', '.join(name_lists.LISTS[kind][:4])} ...")
        for kind, text in (("HUMANOID", "Humanoid"), ("QUADRUPED", "Quadruped"), ("HAND", "Hand"), ("FACE_68", "Face, 68 points"))))

    def change(self, context, obj):
        for name in name_lists.LISTS[self.kind]:
            ensure(obj, name)
        at = landmark_data.next_unplaced(obj)
        obj.focal.active = max(at, 0)


def _active(obj):
    mark = active_of(obj)
    if mark is None:
        raise Unusable(f"'{obj.name}' has no landmarks yet")
    return mark


CLASSES = (FOCAL_OT_landmark_add, FOCAL_OT_landmark_remove, FOCAL_OT_landmark_unplace, FOCAL_OT_landmark_cursor,
           FOCAL_OT_landmark_snap, FOCAL_OT_landmark_next, FOCAL_OT_landmark_accept, FOCAL_OT_landmark_runner_up,
           FOCAL_OT_landmark_mirror_names, FOCAL_OT_landmark_copy_names, FOCAL_OT_landmark_names)


register, unregister = bpy.utils.register_classes_factory(CLASSES)
