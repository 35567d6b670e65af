"""Models from marked meshes and from rigs."""
import os

import bpy

from common import OTHERS, OUT, SAMPLES, TRAINING, activate, check, load_character, step, truth


def test_training():
    settings = bpy.context.scene.focal
    settings.quality = "DRAFT"
    settings.model_path = os.path.join(OUT, "humanoid.focal")
    check(bpy.ops.focal.train() == {"FINISHED"}, "a model is trained")
    check(os.path.getsize(settings.model_path) > 10000, "the model's file is there")
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
