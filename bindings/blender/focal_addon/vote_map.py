"""Vote maps drawn over the mesh: nothing of them is in the scene, so no exporter writes them and undo has nothing to take back."""
import typing

import bpy
import gpu
import numpy
from gpu_extras.batch import batch_for_shader
from mathutils import Matrix

from . import display

_SHADER = "3D_SMOOTH_COLOR" if bpy.app.version < (4, 0, 0) else "SMOOTH_COLOR"
_BEFORE = 2e-6  # of the depth range: before the mesh itself, or both would flicker
_OPACITY = 0.85  # so that shading shows the form

_maps = {}  # name of the object -> VoteMap
_handler = None


class VoteMap(typing.NamedTuple):
    positions: typing.Any
    triangles: typing.Any
    colours: typing.Any
    batch: list  # made at the first drawing, which has the GPU


def show(context, obj, surface, colours):
    colours = colours.copy()
    colours[:, 3] = _OPACITY
    _maps[obj.name] = VoteMap(surface.local, surface.triangles, colours, [])
    display.redraw(context)


def shown(obj):
    """The map of an object; None without a map, or if the mesh has other vertices now."""
    found = _maps.get(obj.name) if obj is not None and obj.type == "MESH" else None
    return found if found is not None and len(found.positions) == len(obj.data.vertices) else None


def hide(obj):
    """Before other colours of the mesh are shown, which it would cover."""
    _maps.pop(obj.name, None)


def _draw():
    for name in list(_maps):
        obj = bpy.data.objects.get(name)
        found = shown(obj)
        if found is None:
            del _maps[name]
        elif obj.visible_get() and bpy.context.space_data.overlay.show_overlays:
            _draw_one(obj, found)


def _draw_one(obj, found):
    shader = gpu.shader.from_builtin(_SHADER)
    if not found.batch:
        content = {"pos": found.positions, "color": found.colours}
        found.batch.append(batch_for_shader(shader, "TRIS", content, indices=found.triangles.astype(numpy.int32)))
    nearer = Matrix.Identity(4)
    nearer[2][3] = -_BEFORE
    gpu.state.blend_set("ALPHA")
    gpu.state.depth_test_set("LESS_EQUAL")
    with gpu.matrix.push_pop(), gpu.matrix.push_pop_projection():
        gpu.matrix.load_projection_matrix(nearer @ gpu.matrix.get_projection_matrix())
        gpu.matrix.multiply_matrix(obj.matrix_world)
        found.batch[0].draw(shader)
    gpu.state.depth_test_set("NONE")
    gpu.state.blend_set("NONE")


class FOCAL_OT_hide_votes(bpy.types.Operator):
    """Hide the vote map, and remove the colour attribute if it was kept"""
    bl_idname = "focal.hide_votes"
    bl_label = "Hide Vote Map"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return is_on(context)

    def execute(self, context):
        _maps.clear()
        for obj in context.scene.objects:
            if obj.type == "MESH" and display.remove_colours(obj.data, display.VOTES):
                display.hide_colours(context)
        display.redraw(context)
        return {"FINISHED"}


def is_on(context):
    """Whether there is a vote map to take off; cheap enough for a panel."""
    obj = context.active_object
    if obj is None or obj.type != "MESH":
        return bool(_maps)
    return shown(obj) is not None or display.VOTES in obj.data.color_attributes


@bpy.app.handlers.persistent
def _forget(*_):
    _maps.clear()


def register():
    global _handler
    bpy.utils.register_class(FOCAL_OT_hide_votes)
    bpy.app.handlers.load_post.append(_forget)
    if not bpy.app.background:
        _handler = bpy.types.SpaceView3D.draw_handler_add(_draw, (), "WINDOW", "POST_VIEW")


def unregister():
    global _handler
    _maps.clear()
    if _handler is not None:
        bpy.types.SpaceView3D.draw_handler_remove(_handler, "WINDOW")
        _handler = None
    bpy.app.handlers.load_post.remove(_forget)
    bpy.utils.unregister_class(FOCAL_OT_hide_votes)
