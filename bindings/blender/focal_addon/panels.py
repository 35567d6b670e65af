"""The sidebar: press N in the 3D view, tab "focal"."""
import bpy

from . import engine, jobs, landmark_data, names, rigify
from .geometry import armature_of, problem_of, remembered_character
from .landmark_data import active_of
from .landmark_edit import may_accept
from .preferences import draw_problem, wrapped
from .properties import STATUS_ICON, STATUS_NAME


class FOCAL_UL_landmarks(bpy.types.UIList):
    def draw_item(self, context, layout, _data, item, _icon, _active_data, _active_property, _index):
        row = layout.row(align=True)
        if context.scene.focal.choose:
            row.prop(item, "chosen", text="")
        row.prop(item, "name", text="", emboss=False, icon=STATUS_ICON[item.status])
        right = row.row()
        right.alignment = "RIGHT"
        right.enabled = False
        if item.status in {"FOUND", "UNCERTAIN"}:
            right.alert = item.status == "UNCERTAIN"
            right.enabled = item.status == "UNCERTAIN"
            right.label(text=f"{100 * item.confidence:.0f} %")
        elif item.status == "ABSENT":
            right.label(text="absent")


class FOCAL_UL_training(bpy.types.UIList):
    def draw_item(self, context, layout, _data, item, _icon, _active_data, _active_property, _index):
        obj = item.object
        if obj is None:
            layout.label(text="(deleted)", icon="ERROR")
            return
        row = layout.split(factor=0.6)
        if context.scene.focal.source == "RIGS":
            armature = armature_of(obj)
            icon, text = "ARMATURE_DATA", f"{len(armature.data.bones)} bones" if armature is not None else "no rig"
            good = armature is not None
        else:
            placed, total, _ = (sum(numbers) for numbers in zip(*map(landmark_data.counts, remembered_character(obj))))
            icon, text, good = "MESH_DATA", f"{placed}/{total}" if total else "no marks", placed > 0
        others = len(remembered_character(obj)) - 1
        row.label(text=obj.name + (f" and {others} more" if others else ""), icon=icon if good else "ERROR")
        right = row.row()
        right.alignment = "RIGHT"
        right.alert = not good
        right.label(text=text)


class FOCAL_UL_errors(bpy.types.UIList):
    def draw_item(self, _context, layout, _data, item, _icon, _active_data, _active_property, _index):
        row = layout.row()
        row.label(text=item.name)
        right = row.row()
        right.alignment = "RIGHT"
        right.alert = item.share > 4
        right.label(text=f"{item.share:.1f} %")


class FOCAL_MT_names(bpy.types.Menu):
    bl_label = "Names of a List"

    def draw(self, _context):
        self.layout.operator_enum("focal.landmark_names", "kind")


class FOCAL_MT_landmarks(bpy.types.Menu):
    bl_label = "Landmark Tools"

    def draw(self, _context):
        layout = self.layout
        layout.operator("focal.landmark_copy_names", icon="COPYDOWN")
        layout.operator("focal.landmark_mirror_names", icon="MOD_MIRROR")
        layout.menu("FOCAL_MT_names", icon="PRESET")
        layout.separator()
        layout.operator("focal.landmark_accept", text="Accept All", icon="CHECKMARK").all = True
        layout.operator("focal.landmark_snap", icon="SNAP_ON")
        layout.operator("focal.landmark_remove", text="Remove All", icon="TRASH").all = True
        layout.separator()
        layout.operator("focal.landmark_import", icon="IMPORT")
        layout.operator("focal.landmark_export", icon="EXPORT")


class FOCAL_OT_use_model(bpy.types.Operator):
    """Use this stock model: it needs no training"""
    bl_idname = "focal.use_model"
    bl_label = "Use Stock Model"
    bl_options = {"REGISTER", "UNDO"}

    name: bpy.props.StringProperty()

    def execute(self, context):
        context.scene.focal.model_path = self.name
        return {"FINISHED"}


class FOCAL_MT_models(bpy.types.Menu):
    bl_label = "Stock Models"

    def draw(self, _context):
        found = sorted(engine.stock_models()) if engine.ready() else ()
        for name in found:
            self.layout.operator("focal.use_model", text=name.capitalize(), icon="OUTLINER_OB_ARMATURE").name = name
        if not found:
            self.layout.label(text="None is installed")


class SidebarPanel:
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "focal"


class FOCAL_PT_main(SidebarPanel, bpy.types.Panel):
    """What concerns all others: the model, a library that is missing, work that runs."""
    bl_label = "Model"

    def draw(self, context):
        layout, job = self.layout, jobs.current()
        if engine.problem():
            draw_problem(layout)
            layout.operator("preferences.addon_show", text="Preferences", icon="PREFERENCES").module = __package__
        if job is not None:
            draw_progress(layout, context, job)
        row = settings_column(layout).row(align=True)
        row.prop(context.scene.focal, "model_path")
        row.menu("FOCAL_MT_models", text="", icon="DOWNARROW_HLT")


def settings_column(layout):
    """Names on the left, values on the right, no dots for animation."""
    column = layout.column()
    column.use_property_split = True
    column.use_property_decorate = False
    return column


def draw_progress(layout, context, job):
    box = layout.box()
    box.label(text=job.step_name(), icon="TIME")
    if hasattr(box, "progress"):  # Blender 4
        box.progress(factor=job.progress(), text=f"{100 * job.progress():.0f} %")
    else:
        box.prop(context.window_manager, "focal_progress", slider=True, text="")
    box.operator("focal.cancel", text="Cancel  (Esc)", icon="CANCEL")


class FOCAL_PT_landmarks(SidebarPanel, bpy.types.Panel):
    bl_label = "Landmarks"

    def draw(self, context):
        layout, obj = self.layout, context.active_object
        if problem_of(obj):
            for line in wrapped(problem_of(obj), 40):
                layout.label(text=line)
            return
        row = layout.row()
        row.template_list("FOCAL_UL_landmarks", "", obj.focal, "landmarks", obj.focal, "active", rows=6)
        side = row.column(align=True)
        side.operator("focal.landmark_add", text="", icon="ADD")
        side.operator("focal.landmark_remove", text="", icon="REMOVE")
        side.separator()
        side.menu("FOCAL_MT_landmarks", text="", icon="DOWNARROW_HLT")
        side.separator()
        side.prop(context.scene.focal, "overlay", text="", icon="HIDE_OFF", toggle=True)
        side.prop(context.scene.focal, "overlay_names", text="", icon="SORTALPHA", toggle=True)
        row = layout.row(align=True)
        row.scale_y = 1.3
        row.operator("focal.landmark_pick", icon="RESTRICT_SELECT_OFF")
        row.operator("focal.landmark_cursor", text="", icon="PIVOT_CURSOR")
        row.operator("focal.landmark_next", text="", icon="TRIA_RIGHT_BAR")
        self._draw_active(context, layout, obj)

    def _draw_active(self, context, layout, obj):
        mark = active_of(obj)
        if mark is None:
            layout.label(text="Add names, or click on the mesh", icon="INFO")
            layout.menu("FOCAL_MT_names", icon="PRESET")
            return
        placed, total, unsure = landmark_data.counts(obj)
        layout.label(text=f"{placed} of {total} placed" + (f", {unsure} uncertain" if unsure else ""))
        box = layout.box()
        row = box.row()
        row.label(text=mark.name, icon=STATUS_ICON[mark.status])
        right = row.row()
        right.alignment = "RIGHT"
        right.label(text=STATUS_NAME[mark.status])
        other = names.mirrored(mark.name)
        if other and landmark_data.index_of(obj, other) < 0:
            box.label(text=f"Other side missing: {other}", icon="MOD_MIRROR")
        if mark.status in {"FOUND", "UNCERTAIN"}:
            box.label(text=f"{100 * mark.confidence:.0f} % sure, about {length_text(context, mark.expected_error)} off")
        column = box.column(align=True)
        row = column.row(align=True)
        accept = row.row(align=True)
        accept.enabled = may_accept(mark)
        accept.operator("focal.landmark_accept")
        row.operator("focal.landmark_runner_up")
        row = column.row(align=True)
        row.operator("focal.landmark_unplace", text="Clear")
        row.operator("focal.landmark_unplace", text="Absent").absent = True


def length_text(context, value):
    """In the scene's units."""
    units = context.scene.unit_settings
    return bpy.utils.units.to_string(units.system, "LENGTH", value * units.scale_length, precision=3)


class FOCAL_PT_training(SidebarPanel, bpy.types.Panel):
    bl_label = "Train"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        layout, settings = self.layout, context.scene.focal
        layout.row().prop(settings, "source", expand=True)
        row = layout.row()
        row.template_list("FOCAL_UL_training", "", settings, "training", settings, "training_active", rows=4)
        side = row.column(align=True)
        side.operator("focal.training_add", text="", icon="ADD")
        side.operator("focal.training_add", text="", icon="LINKED").together = True
        side.operator("focal.training_remove", text="", icon="REMOVE")
        settings_column(layout).row().prop(settings, "quality", expand=True)
        row = layout.row(align=True)
        row.scale_y = 1.3
        row.operator("focal.train", icon="PLAY")
        if settings.source == "MARKS":
            row.operator("focal.cross_validate", text="Measure", icon="DRIVER_DISTANCE")
        if settings.errors:
            layout.label(text="Errors on meshes left out")
            layout.template_list("FOCAL_UL_errors", "", settings, "errors", settings, "errors_active", rows=4)


class FOCAL_PT_detection(SidebarPanel, bpy.types.Panel):
    bl_label = "Detect"

    def draw(self, context):
        layout, settings, obj = self.layout, context.scene.focal, context.active_object
        column = settings_column(layout)
        column.row().prop(settings, "search", expand=True)
        column.prop(settings, "empties")
        row = layout.row()
        row.scale_y = 1.3
        row.operator("focal.detect", icon="VIEWZOOM")
        if problem_of(obj) or not obj.focal.model:
            return
        row = layout.row(align=True)
        row.operator("focal.show_votes", icon="BRUSH_DATA")
        row.operator("focal.hide_votes", text="", icon="X")
        layout.prop(settings, "keep_votes", text="Keep as colour attribute")
        row = layout.row()
        row.alert = obj.focal.category_fit < 0.2
        row.label(text=f"Fits the model's kind: {100 * obj.focal.category_fit:.0f} %")
        unsure = [mark.name for mark in obj.focal.landmarks if mark.status == "UNCERTAIN"]
        if unsure:
            box = layout.box()
            for line in wrapped("To look at: " + ", ".join(unsure), 40):
                box.label(text=line)
            box.operator("focal.next_uncertain", icon="TRIA_RIGHT")
        layout.operator("focal.resolve", icon="FILE_REFRESH")
        layout.prop(settings, "resolve", text="After each correction")


class FOCAL_PT_rig(SidebarPanel, bpy.types.Panel):
    bl_label = "Rig"

    def draw(self, context):
        layout, settings, obj = self.layout, context.scene.focal, context.active_object
        column = settings_column(layout)
        column.prop(settings, "bone_names")
        column.prop(settings, "template_path")
        column.prop(settings, "symmetric")
        column.prop(settings, "ground_root")
        column.prop(settings, "rig_landmarks")
        if obj is not None and obj.type == "MESH" and armature_of(obj) is not None:
            column.prop(settings, "replace_rig", text="Replace")
        row = layout.row()
        row.scale_y = 1.3
        row.operator("focal.rig", icon="ARMATURE_DATA")
        row.operator("focal.bind", icon="MOD_VERTEX_WEIGHT")
        if rigify.metarig_of(obj) is not None:
            layout.operator("focal.rigify_bind", icon="OUTLINER_OB_ARMATURE")


class FOCAL_PT_segmentation(SidebarPanel, bpy.types.Panel):
    bl_label = "Segment"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        layout, settings = self.layout, context.scene.focal
        column = settings_column(layout)
        column.prop(settings, "segmentation")
        column.prop(settings, "parts_as_groups")
        column.prop(settings, "parts_as_colours")
        layout.operator("focal.segment", icon="MOD_EXPLODE")


class FOCAL_PT_batch(SidebarPanel, bpy.types.Panel):
    bl_label = "Collection"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        layout, settings = self.layout, context.scene.focal
        column = settings_column(layout)
        column.prop(settings, "batch")
        column.prop(settings, "batch_together")
        column.prop(settings, "batch_rig")
        layout.operator("focal.batch", icon="OUTLINER_COLLECTION")
        for paragraph in settings.report.split("\n")[:6] if settings.report else ():
            for number, line in enumerate(wrapped(paragraph, 40)):
                layout.label(text=line, icon="BLANK1" if number else "ERROR")


CLASSES = (FOCAL_UL_landmarks, FOCAL_UL_training, FOCAL_UL_errors, FOCAL_OT_use_model, FOCAL_MT_models, FOCAL_MT_names,
           FOCAL_MT_landmarks, FOCAL_PT_main,
           FOCAL_PT_landmarks, FOCAL_PT_training, FOCAL_PT_detection, FOCAL_PT_rig, FOCAL_PT_segmentation,
           FOCAL_PT_batch)


register, unregister = bpy.utils.register_classes_factory(CLASSES)
