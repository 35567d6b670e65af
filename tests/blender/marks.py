"""Landmark lists and files."""
import os
import sys
import time

import bpy
import numpy
from mathutils import Vector

from common import MODULE, OUT, SAMPLES, TRAINING, activate, check, load_character, refused, step, truth, world


def test_marks():
    """Landmark files in, and each stands where it should."""
    for name in TRAINING:
        obj = load_character(name)
        activate(obj)
        path = os.path.join(SAMPLES, name + ".landmarks.json")
        check(bpy.ops.focal.landmark_import(filepath=path) == {"FINISHED"}, "landmarks are read")
        for mark in obj.focal.landmarks:
            off = numpy.linalg.norm(world(obj, mark) - truth(name)[mark.name])
            check(off < 1e-3, f"{mark.name} of {name} is {off} off")
        bpy.ops.focal.training_add()
    check(len(bpy.context.scene.focal.training) == len(TRAINING), "all meshes are in the list")
    out = os.path.join(OUT, "out.landmarks.json")
    bpy.ops.focal.landmark_export(filepath=out)
    bpy.ops.focal.landmark_remove(all=True)
    check(len(obj.focal.landmarks) == 0, "all are removed")
    bpy.ops.focal.landmark_import(filepath=out)
    for mark in obj.focal.landmarks:
        check(numpy.linalg.norm(world(obj, mark) - truth(name)[mark.name]) < 1e-3, f"{mark.name} comes back")
    step("landmarks of six characters read, written and read again")


def test_list():
    """The buttons of the list."""
    obj = bpy.context.active_object
    activate(obj)
    marks = obj.focal.landmarks
    index = marks.find("elbow.R")
    marks.remove(index)
    bpy.ops.focal.landmark_mirror_names()
    check("elbow.R" in marks, "the other side is added")
    bpy.ops.focal.landmark_next()
    check(marks[obj.focal.active].name == "elbow.R", "next goes to what has no place")
    x, y, z = truth(obj.name)["elbow.R"]
    bpy.context.scene.cursor.location = (x, -z, y + 0.002)
    bpy.ops.focal.landmark_cursor()
    off = numpy.linalg.norm(world(obj, marks["elbow.R"]) - truth(obj.name)["elbow.R"])
    check(off < 0.005, f"placed at the cursor: {off} off")
    before = world(obj, marks["elbow.R"])
    for vertex in obj.data.vertices:  # a mesh that was edited: landmarks follow
        vertex.co.x += 0.05
    obj.data.update()
    bpy.ops.focal.landmark_snap()
    after = world(obj, marks["elbow.R"])
    check(0 < numpy.linalg.norm(after - before) < 0.05, "snapped to the edited mesh")
    for vertex in obj.data.vertices:
        vertex.co.x -= 0.05
    obj.data.update()
    bpy.ops.focal.landmark_remove(all=True)
    path = os.path.join(SAMPLES, obj.name + ".landmarks.json")
    bpy.ops.focal.landmark_import(filepath=path)
    step("list: other side, next, cursor, snap")


def test_name_lists():
    """Lists to choose from; Accept is of no use where nothing was found."""
    bpy.ops.mesh.primitive_uv_sphere_add()
    obj = bpy.context.active_object
    for kind, count, some in (("HUMANOID", 24, "elbow.R"), ("QUADRUPED", 21, "hock.L"), ("HAND", 16, "palm"), ("FACE_68", 68, "chin")):
        obj.focal.landmarks.clear()
        check(bpy.ops.focal.landmark_names(kind=kind) == {"FINISHED"}, f"{kind} is added")
        check(len(obj.focal.landmarks) == count == len({m.name for m in obj.focal.landmarks}), f"{count} names, each once")
        check(some in obj.focal.landmarks and obj.focal.active == 0, "the first one is to be placed")
    bpy.ops.focal.landmark_names(kind="FACE_68")
    check(len(obj.focal.landmarks) == 68, "twice adds nothing")
    check(not bpy.ops.focal.landmark_accept.poll(), "nothing to accept")
    bpy.context.scene.cursor.location = (0, 0, 2)
    bpy.ops.focal.landmark_cursor()
    check(not bpy.ops.focal.landmark_accept.poll(), "what was set by hand is accepted already")
    obj.focal.landmarks[0].status = "FOUND"
    check(bpy.ops.focal.landmark_accept.poll(), "what a model found can be")
    obj.focal.active = 1
    check("nothing to accept" in refused(bpy.ops.focal.landmark_accept), "but not the one that has no place")
    check(bpy.ops.focal.landmark_accept(all=True) == {"FINISHED"} and obj.focal.landmarks[0].status == "MARKED", "accepted")
    bpy.data.objects.remove(obj)
    step("lists of names, accept")


def test_million():
    """A click and the cursor on a million faces; the same place on each way."""
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=1001, y_subdivisions=501, size=2)
    obj = bpy.context.active_object
    surface = sys.modules[MODULE + ".geometry"].Surface(obj)
    check(len(surface.triangles) > 1000000, f"{len(surface.triangles)} triangles")
    took = {"click": [], "nearest": []}
    for number in range(3):
        place = Vector((0.31 * number - 0.4, 0.1, 0))
        began = time.process_time()
        location, triangle = surface.cast(place + Vector((1, 2, 3)), Vector((-1, -2, -3)).normalized())
        took["click"].append(time.process_time() - began)
        check((location - place).length < 1e-5, f"the ray meets the surface at {location}")
        check((surface.at(triangle, surface.barycentric(triangle, location)) - place).length < 1e-5, "on that triangle")
        began = time.process_time()
        location, triangle, distance = surface.nearest(place + Vector((0, 0, 0.3)))
        took["nearest"].append(time.process_time() - began)
        check((location - place).length < 1e-5 and abs(distance - 0.3) < 1e-5, f"{location} is nearest, {distance} away")
    check(surface.cast(Vector((3, 0, 1)), Vector((0, 0, -1))) is None, "beside the mesh")
    check(surface.cast(Vector((0, 0, 1)), Vector((0, 0, 1))) is None, "away from the mesh")
    bpy.data.objects.remove(obj)
    best = {name: min(times) for name, times in took.items()}
    step(f"a click on a million triangles within {1000 * best['click']:.0f} ms, the nearest place {1000 * best['nearest']:.0f} ms")
    check(max(best.values()) < 0.2, "quick enough")
