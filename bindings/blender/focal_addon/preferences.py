"""Edit > Preferences > Add-ons > focal."""
import bpy
from bpy.props import EnumProperty, IntProperty, StringProperty

from . import engine


class FOCAL_OT_check_library(bpy.types.Operator):
    """Look for the library again"""
    bl_idname = "focal.check_library"
    bl_label = "Check"

    def execute(self, _context):
        if engine.waits_for_restart():
            self.report({"WARNING"}, "Restart Blender to use this library")
        elif engine.ready():
            self.report({"INFO"}, f"focal {engine.version()} is ready")
        else:
            self.report({"ERROR"}, engine.problem())
        return {"FINISHED"}


class FocalPreferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    library_path: StringProperty(
        name="Library", subtype="FILE_PATH",
        description="focal's shared library; empty: the one inside the add-on. Another one is used after a restart")
    threads: IntProperty(name="Threads", min=0, max=1024, default=0,
                         description="Threads that work; 0: one less than there are processors, so that Blender stays quick")
    backend: EnumProperty(name="Backend", items=(
        ("AUTO", "Automatic", "The fastest available"),
        ("CPU", "CPU", "The processor"),
        ("CUDA", "CUDA", "An NVIDIA GPU if there is one, otherwise the processor")))

    def draw(self, _context):
        layout = self.layout
        layout.use_property_split = True
        if engine.problem():
            draw_problem(layout)
        else:
            row = layout.row()
            row.alignment = "RIGHT"
            row.label(text=f"focal {engine.version()} is ready, with {engine.threads()} threads", icon="CHECKMARK")
        row = layout.row(align=True)
        row.prop(self, "library_path")
        row.operator("focal.check_library", text="", icon="FILE_REFRESH")
        if engine.waits_for_restart():
            layout.label(text="Restart Blender to use this library", icon="INFO")
        layout.prop(self, "threads")
        layout.prop(self, "backend")


def draw_problem(layout):
    """Why the library is not there, wrapped: panels are narrow and do not wrap by themselves."""
    box = layout.box()
    box.alert = True
    icon = "ERROR"
    for paragraph in engine.problem().split("\n"):
        for line in wrapped(paragraph, 48):
            box.label(text=line, icon=icon)
            icon = "BLANK1"


def wrapped(text, width):
    """Lines of about so many letters; a path longer than that is cut where it must."""
    lines, line = [], ""
    for word in text.split():
        while len(word) > width:
            room = width - len(line) - 1 if line else width
            line = f"{line} {word[:room]}".strip()
            word = word[room:]
            lines.append(line)
            line = ""
        if line and len(line) + 1 + len(word) > width:
            lines.append(line)
            line = ""
        line = f"{line} {word}".strip()
    return lines + [line] if line else lines


CLASSES = (FOCAL_OT_check_library, FocalPreferences)


register, unregister = bpy.utils.register_classes_factory(CLASSES)
