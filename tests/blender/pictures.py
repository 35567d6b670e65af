"""Renders with Workbench, which needs no window and no materials."""
import bpy
from mathutils import Vector


def render(path, objects, armature=None, size=(360, 480), colour_type="MATERIAL"):
    """Some objects from the front, which is at +Y here; an armature's bones as solids, for overlays do not render."""
    if bpy.app.version >= (4, 0, 0):
        return  # its Workbench asks for a display or a GPU; the pictures are for people, of one Blender is enough
    scene = bpy.context.scene
    stand_ins = _bones_as_meshes(armature) if armature is not None else []
    shown = set(objects) | set(stand_ins)
    hidden = {o: o.hide_render for o in scene.objects if o not in stand_ins}
    for o in scene.objects:
        o.hide_render = o.name not in {s.name for s in shown}
    camera = _camera(objects)
    scene.render.engine = "BLENDER_WORKBENCH"
    shading = scene.display.shading
    shading.light, shading.color_type = "STUDIO", "OBJECT" if stand_ins else colour_type
    shading.show_xray, shading.xray_alpha = bool(stand_ins), 0.4
    scene.render.resolution_x, scene.render.resolution_y = size
    scene.render.resolution_percentage = 100
    scene.render.film_transparent = False
    scene.render.filepath = path
    bpy.ops.render.render(write_still=True)
    for o in stand_ins + [camera]:
        bpy.data.objects.remove(o)
    for o, state in hidden.items():
        o.hide_render = state


def _camera(objects):
    corners = [o.matrix_world @ Vector(c) for o in objects for c in o.bound_box]
    low = Vector(min(c[i] for c in corners) for i in range(3))
    high = Vector(max(c[i] for c in corners) for i in range(3))
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    bpy.context.scene.collection.objects.link(camera)
    camera.data.type = "ORTHO"
    camera.data.ortho_scale = 1.15 * max(high - low)
    camera.location = (low + high) / 2 + Vector((0.3, 1, 0.1)).normalized() * 10 * max(high - low)
    camera.data.clip_end = 1000
    camera.rotation_euler = ((low + high) / 2 - camera.location).to_track_quat("-Z", "Y").to_euler()
    bpy.context.scene.camera = camera
    return camera


def _bones_as_meshes(armature):
    """One octahedron a bone."""
    made = []
    for bone in armature.data.bones:
        mesh = bpy.data.meshes.new(bone.name)
        l, w = bone.length, 0.1 * bone.length
        mesh.from_pydata([(0, 0, 0), (w, w, w), (-w, w, w), (-w, w, -w), (w, w, -w), (0, l, 0)], [],
                         [(0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 1), (5, 2, 1), (5, 3, 2), (5, 4, 3), (5, 1, 4)])
        made.append(bpy.data.objects.new("bone " + bone.name, mesh))
        made[-1].matrix_world = armature.matrix_world @ bone.matrix_local
        made[-1].color = (0.9, 0.45, 0.05, 1)
        bpy.context.scene.collection.objects.link(made[-1])
    return made
