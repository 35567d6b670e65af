"""Skeletons for models of marks: templates that come along, and joints made in the editor."""
import os
import sys

import bpy
import numpy

from common import MODULE, OTHERS, OUT, activate, check, refused, step, truth


def place(armature, bone):
    x, y, z = armature.matrix_world @ armature.data.bones[bone].head_local
    return numpy.array([x, z, -y])


def choose(obj, *names):
    for mark in obj.focal.landmarks:
        mark.chosen = mark.name in names


def add(obj, name, parent, *landmarks):
    """As the user does: choose, press, rename."""
    settings = bpy.context.scene.focal
    settings.joint_active = settings.joints.find(parent) if parent else len(settings.joints)
    choose(obj, *landmarks)
    check(bpy.ops.focal.joint_add() == {"FINISHED"}, f"{name} is made")
    settings.joints[settings.joint_active].name = name


def test(obj):
    activate(obj)
    test_shipped(obj)
    test_editor(obj)
    test_dragged(obj)
    bpy.context.scene.focal.joints.clear()


def test_shipped(obj):
    """Without a word about joints the template is taken whose landmarks are there; what is missing is named."""
    templates = sys.modules[MODULE + ".templates"]
    check(set(templates.shipped()) == {"humanoid", "quadruped", "hand"}, "templates come along")
    lists = sys.modules[MODULE + ".name_lists"].LISTS
    for name, path in templates.shipped().items():
        check(not templates.missing_of(templates.read(path), set(lists[name.upper()])), f"{name}: all landmarks are of the list")
    check(bpy.ops.focal.rig() == {"FINISHED"}, "rigged by the humanoid template")
    armature = obj.modifiers[0].object
    check("leftLowerArm" in armature.data.bones, "its joints")
    off = numpy.linalg.norm(place(armature, "leftLowerArm") - truth(obj.name)["elbow.L"])
    check(off < 0.1, f"the elbow is {off} off")
    unrig(obj)
    try:
        templates.text_for([name for name in lists["HUMANOID"] if name != "chin"])
        check(False, "a landmark that is missing is no template")
    except templates.TemplateError as error:
        check("'humanoid' lacks the landmarks chin" in str(error), f"reported: {error}")
    check(bpy.ops.focal.joint_template(kind="quadruped") == {"FINISHED"}, "another template is read")
    check("does not know: croup" in refused(bpy.ops.focal.rig), "what this model does not know is named")
    bpy.ops.focal.joint_remove(all=True)
    step("templates")


def unrig(obj):
    bpy.data.objects.remove(obj.modifiers[0].object)
    obj.modifiers.clear()
    obj.vertex_groups.clear()


def test_editor(obj):
    settings = bpy.context.scene.focal
    choose(obj)
    check("Choose one landmark" in refused(bpy.ops.focal.joint_add), "nothing is chosen")
    add(obj, "root", "", "navel", "lowerBack", "crotch")
    add(obj, "upper", "root", "upperBack", "chest")
    add(obj, "elbow.L", "upper", "elbow.L")
    add(obj, "hand.L", "elbow.L", "elbow.L", "handTip.L")
    settings.joints["hand.L"].share, settings.joints["hand.L"].tip = 0.6, "handTip.L"
    check([j.kind for j in settings.joints] == ["SURFACE", "BETWEEN", "CENTRE", "BETWEEN"], "how each lies follows from how many")
    settings.joints["elbow.L"].name = "arm.L"
    settings.joints["hand.L"].parent = "arm.L"
    bpy.ops.focal.joint_mirror()
    check(settings.joints["hand.R"].parent == "arm.R" and settings.joints["hand.R"].tip == "handTip.R", "the other side")
    path = os.path.join(OUT, "own.json")
    bpy.ops.focal.joint_export(filepath=path)
    template = sys.modules[MODULE + ".templates"].read(path)
    check([row["name"] for row in template["joints"]] == ["root", "upper", "arm.L", "arm.R", "hand.L", "hand.R"], "parents first")
    names, settings.bone_names = settings.bone_names, "AS_TRAINED"
    check(bpy.ops.focal.rig() == {"FINISHED"}, "rigged by own joints")
    armature = obj.modifiers[0].object
    check(set(armature.data.bones.keys()) == {"root", "upper", "arm.L", "arm.R", "hand.L", "hand.R"}, "own bones")
    for bone, landmark in (("arm.L", "elbow.L"), ("arm.R", "elbow.R")):
        off = numpy.linalg.norm(place(armature, bone) - truth(obj.name)[landmark])
        check(off < 0.1, f"{bone} is {off} off")
    settings.bone_names = names
    unrig(obj)
    step("joints of chosen landmarks")


def test_dragged(obj):
    """A bone that was dragged lies between two landmarks afterwards."""
    settings = bpy.context.scene.focal
    check(bpy.ops.focal.joint_show() == {"FINISHED"}, "shown")
    preview = next(o for o in obj.children if o.type == "ARMATURE")
    check(len(preview.data.bones) == len(settings.joints), "a bone for each joint")
    a, b = (obj.focal.landmarks[name].position.copy() for name in ("shoulder.L", "elbow.L"))
    activate(preview)
    bpy.ops.object.mode_set(mode="EDIT")
    preview.data.edit_bones["arm.L"].head = a.lerp(b, 0.25)
    bpy.ops.object.mode_set(mode="OBJECT")
    activate(obj)
    check(bpy.ops.focal.joint_take() == {"FINISHED"}, "taken over")
    joint = settings.joints["arm.L"]
    check(joint.kind == "BETWEEN" and {p.name for p in joint.places} == {"shoulder.L", "elbow.L"}, "between shoulder and elbow")
    found = sys.modules[MODULE + ".template_edit"].places_of(settings, obj)["arm.L"]
    check((found - a.lerp(b, 0.25)).length < 1e-3, "where it was dragged to")
    check(settings.joints["arm.R"].kind == "CENTRE", "others stay")
    bpy.data.objects.remove(preview)
    step("a dragged bone")
