"""Landmarks of the active mesh drawn over the 3D view: discs in colours of confidence, with names."""
import math

import blf
import bpy
import gpu
from bpy_extras.view3d_utils import location_3d_to_region_2d, region_2d_to_origin_3d
from gpu_extras.batch import batch_for_shader
from mathutils import Vector

from .display import colour_of

_handler = None
_SIDES = 12
_BEHIND = 0.35  # opacity of landmarks on the far side
_MOST_POLYGONS = 300_000
_CIRCLE = [(math.cos(2 * math.pi * i / _SIDES), math.sin(2 * math.pi * i / _SIDES)) for i in range(_SIDES)]
# Blender 4 dropped the dimension from the names of its shaders.
_SHADER = "2D_FLAT_COLOR" if bpy.app.version < (4, 0, 0) else "FLAT_COLOR"


def _draw():
    context = bpy.context
    obj, settings = context.active_object, context.scene.focal
    if not settings.overlay or obj is None or obj.type != "MESH" or not context.space_data.overlay.show_overlays:
        return
    if not obj.visible_get():
        return
    scale = context.preferences.system.ui_scale
    # Rays need a search tree that Blender builds after every change: too slow for meshes of millions.
    look = obj.mode == "OBJECT" and len(obj.data.polygons) < _MOST_POLYGONS
    discs = []
    for number, mark in enumerate(obj.focal.landmarks):
        if not mark.placed:
            continue
        place = location_3d_to_region_2d(context.region, context.region_data, obj.matrix_world @ mark.position)
        if place is not None:
            active = number == obj.focal.active
            seen = active or not look or _is_seen(context, obj, mark.position, place)
            discs.append((place, mark, active, 1.0 if seen else _BEHIND))
    _draw_discs(discs, scale)
    if settings.overlay_names:
        _draw_names(discs, scale)


def _is_seen(context, obj, position, place):
    """Whether nothing of the mesh itself lies before the point."""
    to_local = obj.matrix_world.inverted()
    origin = to_local @ region_2d_to_origin_3d(context.region, context.region_data, place)
    way = position - origin
    size = (Vector(obj.bound_box[6]) - Vector(obj.bound_box[0])).length
    hit, _location, _normal, _face = obj.ray_cast(origin, way.normalized(), distance=way.length - 0.01 * size)
    return not hit


def _draw_discs(discs, scale):
    points, colours, triangles = [], [], []
    for place, mark, active, alpha in sorted(discs, key=lambda disc: (disc[3], disc[2])):
        colour = [c ** (1 / 2.2) for c in colour_of(mark)[:3]] + [alpha]  # the view's overlay is not linear
        if active:
            _add_disc(points, colours, triangles, place, 8 * scale, (1, 1, 1, 1))
        _add_disc(points, colours, triangles, place, 6 * scale, (0, 0, 0, alpha))
        _add_disc(points, colours, triangles, place, 4.5 * scale, colour)
    if not triangles:
        return
    shader = gpu.shader.from_builtin(_SHADER)
    batch = batch_for_shader(shader, "TRIS", {"pos": points, "color": colours}, indices=triangles)
    gpu.state.blend_set("ALPHA")
    batch.draw(shader)
    gpu.state.blend_set("NONE")


def _add_disc(points, colours, triangles, centre, radius, colour):
    first = len(points)
    depth = (0.0,) if _SHADER == "FLAT_COLOR" else ()  # that one takes points of three dimensions
    points.extend((centre[0] + radius * x, centre[1] + radius * y, *depth) for x, y in _CIRCLE)
    colours.extend([colour] * _SIDES)
    triangles.extend((first, first + i, first + i + 1) for i in range(1, _SIDES - 1))


def _draw_names(discs, scale):
    font = 0
    if bpy.app.version < (4, 0, 0):
        blf.size(font, int(11 * scale), 72)
    else:
        blf.size(font, 11 * scale)
    blf.enable(font, blf.SHADOW)
    blf.shadow(font, 3, 0, 0, 0, 0.9)
    for place, mark, active, alpha in discs:
        blf.color(font, 1, 1, 1, 1.0 if active or mark.status == "UNCERTAIN" else 0.8 * alpha)
        blf.position(font, place[0] + 9 * scale, place[1] - 4 * scale, 0)
        blf.draw(font, mark.name)
    blf.disable(font, blf.SHADOW)


def register():
    global _handler
    if not bpy.app.background:
        _handler = bpy.types.SpaceView3D.draw_handler_add(_draw, (), "WINDOW", "POST_PIXEL")


def unregister():
    global _handler
    if _handler is not None:
        bpy.types.SpaceView3D.draw_handler_remove(_handler, "WINDOW")
        _handler = None
