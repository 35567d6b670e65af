"""What the tests of the Blender add-on share. Runs inside Blender: blender -b --python TEST.py -- ZIP SAMPLES OUT."""
import json
import os
import sys
import time

import bpy
import numpy
from mathutils import Vector

if not hasattr(numpy, "bool"):  # the glTF add-on of Blender 3.4 asks NumPy for it
    numpy.bool = bool

ZIP, SAMPLES, OUT = sys.argv[sys.argv.index("--") + 1:]
AS_EXTENSION = bpy.app.version >= (4, 2, 0)
MODULE = "bl_ext.user_default.focal_addon" if AS_EXTENSION else "focal_addon"
TRAINING = [f"humanoid_{i:02}" for i in range(6)]
OTHERS = [f"humanoid_{i:02}" for i in range(6, 9)]
_began = time.perf_counter()
_last = _began


def step(text):
    """Where the time goes."""
    global _last
    now = time.perf_counter()
    print(f"{now - _began:7.1f} s  (+{now - _last:.1f})  {text}", flush=True)
    _last = now


def check(condition, text):
    """Fails the test: Blender ends with the exit code of --python-exit-code."""
    if not condition:
        raise AssertionError(text)


def install():
    if AS_EXTENSION:
        bpy.ops.extensions.package_install_files(filepath=ZIP, repo="user_default", enable_on_install=True)
        return sys.modules[MODULE]
    bpy.ops.preferences.addon_install(filepath=ZIP, overwrite=True)
    check(bpy.ops.preferences.addon_enable(module=MODULE) == {"FINISHED"}, "the add-on is enabled")
    return sys.modules[MODULE]


def empty_scene():
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=False)
    if MODULE not in bpy.context.preferences.addons:
        bpy.ops.preferences.addon_enable(module=MODULE)


def load_character(name, rigged=False):
    """The mesh of a sample character."""
    before = set(bpy.data.objects)
    suffix = ".rig.glb" if rigged else ".glb"
    bpy.ops.import_scene.gltf(filepath=os.path.join(SAMPLES, name + suffix))
    new = [o for o in bpy.data.objects if o not in before]
    mesh = max((o for o in new if o.type == "MESH"), key=lambda o: len(o.data.vertices))
    mesh.name = name
    return mesh


def truth(name):
    """{landmark: position} of a sample character, in glTF's axes."""
    with open(os.path.join(SAMPLES, name + ".landmarks.json"), encoding="utf-8") as file:
        return {mark["name"]: numpy.array(mark["position"]) for mark in json.load(file)["landmarks"]}


def world(obj, mark):
    """A landmark's place in glTF's axes."""
    x, y, z = obj.matrix_world @ mark.position
    return numpy.array([x, z, -y])


def size(obj):
    """sqrt of the surface's area, in the world."""
    area = sum(p.area for p in obj.data.polygons)
    return (area ** 0.5) * obj.matrix_world.median_scale


def activate(obj):
    for other in bpy.context.selected_objects:
        other.select_set(False)
    obj.select_set(True)
    bpy.context.view_layer.objects.active = obj


def in_two(obj):
    """The object with its upper half as another object."""
    activate(obj)
    middle = numpy.mean([v.co.z for v in obj.data.vertices])
    for polygon in obj.data.polygons:
        polygon.select = polygon.center.z > middle
    for vertex in obj.data.vertices:
        vertex.select = vertex.co.z > middle
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.separate(type="SELECTED")
    bpy.ops.object.mode_set(mode="OBJECT")
    other = next(o for o in bpy.context.selected_objects if o != obj)
    bpy.context.view_layer.update()
    other.matrix_world.translation.x += 1  # each object has an origin of its own
    for vertex in other.data.vertices:
        vertex.co = other.matrix_world.inverted() @ (other.matrix_world @ vertex.co - Vector((1, 0, 0)))
    return other


def weight_of(obj, bone):
    """The sum of a bone's weights on an object."""
    group = obj.vertex_groups.get(bone)
    return 0 if group is None else sum(g.weight for v in obj.data.vertices for g in v.groups if g.group == group.index)


def refused(operator, **arguments):
    """The message with which an operator refuses; fails when it does not."""
    try:
        operator(**arguments)
    except RuntimeError as error:
        return str(error)
    raise AssertionError(f"{operator} did not refuse")


def resident_bytes():
    with open("/proc/self/statm", encoding="ascii") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")
