"""Models from marked meshes and from rigs."""
import os
import sys

import bpy
import numpy

from common import (MODULE, OTHERS, OUT, SAMPLES, TRAINING, activate, check, in_two, load_character, refused, step,
                    truth)


def test_training():
    settings = bpy.context.scene.focal
    settings.quality = "DRAFT"
    settings.model_path = os.path.join(OUT, "humanoid.focal")
    check(bpy.ops.focal.train() == {"FINISHED"}, "a model is trained")
    check(os.path.getsize(settings.model_path) > 10000, "the model's file is there")
    carried = sys.modules[MODULE + ".engine"].package().Model.load(settings.model_path).skeleton_template
    check(carried and "leftUpperArm" in carried, "the model carries the template whose landmarks are all marked")
    step("trained on six")


def test_unsaved():
    """A model that was trained before the file was saved goes along; so does the project when it is moved."""
    settings, home = bpy.context.scene.focal, os.path.join(OUT, "project")
    trained, settings.model_path = settings.model_path, "humanoid"
    check(bpy.ops.focal.train() == {"FINISHED"} and settings.model_path == "//landmarks.focal", "no stock model is written over")
    check(os.path.isfile(os.path.join(bpy.app.tempdir, "landmarks.focal")), "it waits")
    obj = bpy.data.objects[TRAINING[0]]
    activate(obj)
    bpy.ops.focal.detect(keep_marked=False)
    os.makedirs(home)
    with open(os.path.join(home, "landmarks.focal"), "w", encoding="ascii") as file:
        file.write("another model")
    bpy.ops.wm.save_as_mainfile(filepath=os.path.join(home, "work.blend"))
    check(settings.model_path == "//landmarks-2.focal" == obj.focal.model, f"{settings.model_path}: no other is written over")
    check(os.path.getsize(os.path.join(home, "landmarks-2.focal")) > 10000, "the model is beside the file")
    bpy.ops.wm.save_mainfile()
    os.rename(home, home + " moved")
    bpy.ops.wm.open_mainfile(filepath=os.path.join(home + " moved", "work.blend"))
    obj, settings = bpy.data.objects[TRAINING[0]], bpy.context.scene.focal
    activate(obj)
    obj.focal.active = obj.focal.landmarks.find("nose")
    before = [tuple(mark.position) for mark in obj.focal.landmarks]
    x, y, z = truth(obj.name)["knee.L"]
    bpy.context.scene.cursor.location = (x, -z, y)
    bpy.ops.focal.landmark_cursor()
    after = [tuple(mark.position) for mark in obj.focal.landmarks]
    check(sum(a != b for a, b in zip(before, after)) > 1, "the others follow a correction after the project was moved")
    settings.model_path = os.path.join(home + " moved", "landmarks-2.focal")
    bpy.ops.focal.detect()
    check(obj.focal.model == "//landmarks-2.focal", "a file in the project's folder is remembered by its way from there")
    settings.model_path = trained
    bpy.ops.focal.landmark_remove(all=True)
    bpy.ops.focal.landmark_import(filepath=os.path.join(SAMPLES, obj.name + ".landmarks.json"))
    step("trained before the file was saved; the project moved")


def test_measure():
    """Errors on meshes left out, worst first."""
    settings = bpy.context.scene.focal
    while len(settings.training) > 3:
        settings.training.remove(0)
    check(bpy.ops.focal.cross_validate() == {"FINISHED"}, "measured")
    shares = [item.share for item in settings.errors]
    check(len(shares) == 24 and shares == sorted(shares, reverse=True), "every landmark, worst first")
    check(0.1 < sum(shares) / len(shares) < 8, f"a mean of {sum(shares) / len(shares):.1f} %")
    step(f"measured on three left out in turn: mean {sum(shares) / len(shares):.1f} %")


def test_parts():
    """A character of two objects, each with marks of its own, is one row and teaches as one."""
    settings, kept = bpy.context.scene.focal, {}
    settings.training.clear()
    for name in TRAINING[:2]:
        bpy.data.objects[name].name = f"whole {name}"
        obj = load_character(name)
        other = in_two(obj)
        kept[name] = obj, other
        places = truth(name)
        for landmark, (x, y, z) in places.items():
            upper = y > numpy.median([place[1] for place in places.values()])
            bpy.context.scene.cursor.location = (x, -z, y)
            activate(other if upper else obj)
            bpy.ops.focal.landmark_add(name=landmark)
            bpy.ops.focal.landmark_cursor()
        for one in (other, obj):
            one.select_set(True)
        bpy.context.view_layer.objects.active = obj
        bpy.ops.focal.training_add()
    check(len(settings.training) == 2, f"a row for each character: {[i.object.name for i in settings.training]}")
    training = sys.modules[MODULE + ".training"]
    meshes, names = training.marked_meshes(bpy.context)
    check(len(names) == 24 and all(len(mesh.marks) == 24 and len(mesh.parts) == 2 for mesh in meshes), "all marks of both objects")
    for mesh in meshes:
        places, origin = truth(mesh.name), _origin(kept[mesh.name][0])
        errors = [numpy.linalg.norm(mesh.place(n) + origin - places[n]) for n in names]
        check(max(errors) < 0.02, f"the marks are where they were put: {max(errors)}")
    settings.model_path = os.path.join(OUT, "parts.focal")
    check(bpy.ops.focal.train() == {"FINISHED"}, "learned")
    obj, other = kept[TRAINING[0]]
    twice = obj.focal.landmarks.add()
    twice.name = other.focal.landmarks[0].name
    activate(obj)
    obj.focal.active = len(obj.focal.landmarks) - 1
    bpy.ops.focal.landmark_cursor()
    check("and on another object" in refused(bpy.ops.focal.train), "a landmark of two objects is refused")
    for pair in kept.values():
        for one in pair:
            bpy.data.objects.remove(one)
    for name in kept:
        bpy.data.objects[f"whole {name}"].name = name
    settings.training.clear()
    step("trained on characters of two objects")


def _origin(obj):
    x, y, z = obj.matrix_world.translation
    return numpy.array([x, z, -y])


def test_rigs():
    """A model from a rigged character, by way of a file."""
    settings = bpy.context.scene.focal
    settings.training.clear()
    obj = load_character("humanoid_00", rigged=True)
    activate(obj)
    bpy.ops.focal.training_add()
    settings.source, settings.model_path = "RIGS", os.path.join(OUT, "rig.focal")
    settings.template_path, settings.bone_names, settings.replace_rig = "", "RIGIFY", True
    check(bpy.ops.focal.train() == {"FINISHED"}, "learned from a rig")
    step("trained on a rigged character")
    other = bpy.data.objects[OTHERS[1]]
    activate(other)
    check(bpy.ops.focal.rig() == {"FINISHED"}, "rigged with it")
    check("DEF-upper_arm.L" in other.modifiers[0].object.data.bones, "Rigify's names")
    step("rigged by it")
