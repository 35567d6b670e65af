"""The part of the sidebar in which joints are made of landmarks."""
import bpy

from . import templates
from .panels import SidebarPanel, settings_column
from .preferences import wrapped


class FOCAL_UL_joints(bpy.types.UIList):
    def draw_item(self, _context, layout, _data, item, _icon, _active_data, _active_property, _index):
        row = layout.split(factor=0.62)
        row.prop(item, "name", text="", emboss=False, icon="BONE_DATA")
        right = row.row()
        right.enabled = False
        right.alignment = "RIGHT"
        right.label(text=item.parent)


class FOCAL_MT_templates(bpy.types.Menu):
    bl_label = "Skeleton Templates"

    def draw(self, _context):
        self.layout.operator_enum("focal.joint_template", "kind")
        self.layout.separator()
        self.layout.operator("focal.joint_mirror", icon="MOD_MIRROR")
        self.layout.operator("focal.joint_remove", text="Remove All", icon="TRASH").all = True
        self.layout.separator()
        self.layout.operator("focal.joint_export", icon="EXPORT")


class FOCAL_PT_skeleton(SidebarPanel, bpy.types.Panel):
    bl_label = "Skeleton"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context):
        return context.active_object is not None and context.active_object.type == "MESH"

    def draw(self, context):
        layout, settings, obj = self.layout, context.scene.focal, context.active_object
        layout.prop(settings, "choose", toggle=True, icon="CHECKBOX_HLT")
        layout.operator("focal.joint_add", icon="BONE_DATA")
        row = layout.row()
        row.template_list("FOCAL_UL_joints", "", settings, "joints", settings, "joint_active", rows=5)
        side = row.column(align=True)
        side.operator("focal.joint_remove", text="", icon="REMOVE")
        side.separator()
        side.menu("FOCAL_MT_templates", text="", icon="DOWNARROW_HLT")
        if 0 <= settings.joint_active < len(settings.joints):
            self._draw_joint(layout, settings, obj, settings.joints[settings.joint_active])
        elif not settings.joints:
            self._draw_hint(layout, obj)
        column = layout.column(align=True)
        column.operator("focal.joint_show", icon="ARMATURE_DATA")
        column.operator("focal.joint_take", icon="CHECKMARK")

    def _draw_joint(self, layout, settings, obj, joint):
        column = settings_column(layout.box())
        column.prop_search(joint, "parent", settings, "joints", icon="BONE_DATA")
        column.prop(joint, "kind")
        for place in joint.places:
            column.label(text=place.name, icon="DOT")
        if joint.kind == "BETWEEN":
            column.prop(joint, "share")
        column.prop_search(joint, "tip", obj.focal, "landmarks")

    def _draw_hint(self, layout, obj):
        marks = {mark.name for mark in obj.focal.landmarks}
        best = templates.best_for(marks) if marks else None
        if best is None:
            return
        name, _template, missing = best
        text = f"Without joints of your own the template '{name}' is used" if not missing else (
            f"The template '{name}' lacks {', '.join(missing)}")
        for number, line in enumerate(wrapped(text, 40)):
            layout.label(text=line, icon="BLANK1" if number else "INFO")


CLASSES = (FOCAL_UL_joints, FOCAL_MT_templates, FOCAL_PT_skeleton)


register, unregister = bpy.utils.register_classes_factory(CLASSES)
