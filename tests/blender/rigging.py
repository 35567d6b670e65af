"""Armatures with weights, out as glTF and in again."""
import os
import shutil

import bpy
import numpy

import pictures
from common import OTHERS, OUT, activate, check, in_two, load_character, refused, step, truth, weight_of, world

TEMPLATE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../samples/templates/humanoid.json")


def test_rig():
    settings = bpy.context.scene.focal
    settings.template_path, settings.bone_names = TEMPLATE, "MIXAMO"
    obj = bpy.data.objects[OTHERS[0]]
    activate(obj)
    pictures.render(os.path.join(OUT, "before.png"), [obj])
    before = [tuple(obj.matrix_world @ v.co) for v in obj.data.vertices[:50]]
    check(bpy.ops.focal.rig() == {"FINISHED"}, "a rig is made")
    armature = obj.modifiers[0].object
    bones = armature.data.bones
    check(armature["focal_verdict"].startswith("verdict: "), "the verdict is kept with the armature")
    check("mixamorig:LeftArm" in bones and bones["mixamorig:LeftForeArm"].parent.name == "mixamorig:LeftArm", "names")
    after = [tuple(obj.matrix_world @ v.co) for v in obj.data.vertices[:50]]
    check(numpy.allclose(before, after, atol=1e-5), "the mesh stays where it was")
    for bone, mark in (("mixamorig:LeftLeg", "knee.L"), ("mixamorig:RightForeArm", "elbow.R")):
        x, y, z = armature.matrix_world @ bones[bone].head_local
        off = numpy.linalg.norm(numpy.array([x, z, -y]) - truth(obj.name)[mark])
        check(off < 0.1, f"{bone} is {off} from {mark}")
    sums = [sum(g.weight for g in v.groups if not obj.vertex_groups[g.group].name.startswith("part "))
            for v in obj.data.vertices]
    check(abs(min(sums) - 1) < 1e-3 and abs(max(sums) - 1) < 1e-3, "weights sum to 1")
    check("already" in refused(bpy.ops.focal.rig), "a second rig needs Replace")
    pictures.render(os.path.join(OUT, "after.png"), [obj], armature=armature)
    step("rigged")
    test_bend(obj, armature)
    test_file(obj, armature)
    activate(obj)
    settings.replace_rig, old = True, armature.name
    check(bpy.ops.focal.rig() == {"FINISHED"} and len(obj.modifiers) == 1, "replaced")
    settings.replace_rig = False
    armatures = [o.name for o in bpy.data.objects if o.type == "ARMATURE"]
    check(len(armatures) == 1 and obj.modifiers[0].object.name in armatures, f"'{old}' is gone: {armatures}")
    bpy.data.objects.remove(bpy.data.objects[armatures[0]])
    step("rig replaced")


def test_bend(obj, armature):
    """A bent knee moves the foot and leaves the head."""
    bone = armature.pose.bones["mixamorig:LeftLeg"]
    bone.rotation_mode = "XYZ"
    bone.rotation_euler = (1.0, 0, 0)
    bpy.context.view_layer.update()
    moved = obj.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    shift = numpy.array([(a.co - b.co).length for a, b in zip(moved.vertices, obj.data.vertices)])
    heel = obj.focal.landmarks["heel.L"].triangle
    crown = obj.focal.landmarks["crown"].triangle
    obj.data.calc_loop_triangles()
    check(shift[obj.data.loop_triangles[heel].vertices[0]] > 0.05, "the heel follows the knee")
    check(shift[obj.data.loop_triangles[crown].vertices[0]] < 1e-4, "the head does not")
    bone.rotation_euler = (0, 0, 0)
    bpy.context.view_layer.update()
    step("bent")


def test_file(obj, armature):
    """Out as glTF and in again: bones and weights are still there."""
    path = os.path.join(OUT, "rigged.glb")
    activate(obj)
    armature.select_set(True)
    bpy.ops.export_scene.gltf(filepath=path, export_format="GLB", export_extras=True, use_selection=True)
    with open(path, "rb") as file:
        check(b'"landmarks"' not in file.read(), "the add-on's lists stay out of the file")
    before = set(bpy.data.objects)
    bpy.ops.import_scene.gltf(filepath=path)
    new = [o for o in bpy.data.objects if o not in before]
    back = next(o for o in new if o.type == "ARMATURE")
    mesh = max((o for o in new if o.type == "MESH"), key=lambda o: len(o.data.vertices))
    check({b.name for b in armature.data.bones} <= {b.name for b in back.data.bones}, "all bones come back")
    check(len(mesh.vertex_groups) >= len(armature.data.bones) and len(mesh.modifiers) == 1, "so do weights")
    for bone in armature.data.bones:
        a, b = armature.matrix_world @ bone.head_local, back.matrix_world @ back.data.bones[bone.name].head_local
        check((a - b).length < 1e-3, f"{bone.name} comes back where it was")
    for o in new:
        bpy.data.objects.remove(o)
    step("exported and imported again")


def test_collection():
    """Two good meshes and one that cannot be done: one report, one step."""
    settings = bpy.context.scene.focal
    collection = bpy.data.collections.new("batch")
    bpy.context.scene.collection.children.link(collection)
    for name in OTHERS[1:]:
        collection.objects.link(bpy.data.objects[name])
    collection.objects.link(bpy.data.objects.new("bad", bpy.data.meshes.new("bad")))
    settings.batch, settings.batch_rig = collection, True
    check(bpy.ops.focal.batch() == {"FINISHED"}, "the collection is done")
    check("'bad' has no faces" in settings.report, "what was left out is reported")
    for name in OTHERS[1:]:
        check(bpy.data.objects[name].modifiers[0].type == "ARMATURE", f"{name} is rigged")
    step("a collection")


def test_character():
    """A character of two objects, by a stock model: one armature, groups on both; then other weights for bones that were moved."""
    settings = bpy.context.scene.focal
    shutil.copy(settings.model_path, os.path.join(OUT, "models", "mine.focal"))
    bpy.ops.focal.use_model(name="mine")
    obj = load_character(OTHERS[2])
    other = in_two(obj)
    for one in (other, obj):
        one.select_set(True)
    bpy.context.view_layer.objects.active = obj
    settings.bone_names, settings.ground_root = "RIGIFY_METARIG", True
    check(bpy.ops.focal.rig() == {"FINISHED"}, "two objects are rigged")
    armature = obj.modifiers[0].object
    check(other.modifiers[0].object == armature and other.parent == armature, "one armature")
    check({"root", "upper_arm.L", "thigh.L", "spine"} <= {b.name for b in armature.data.bones}, "the metarig's names")
    check(not obj.focal.landmarks and not other.focal.landmarks, "a model of rigs keeps its landmarks to itself")
    check(weight_of(other, "spine.006") > 100 and weight_of(obj, "spine.006") == 0, "the head moves the upper half only")
    check(weight_of(obj, "foot.L") > 10 and weight_of(other, "foot.L") == 0, "the foot moves the lower half only")
    places = {b.name: tuple(b.head_local) for b in armature.data.bones}
    obj.vertex_groups.clear(), other.vertex_groups.clear()
    for one in (other, obj):
        one.select_set(True)
    bpy.context.view_layer.objects.active = obj
    check(bpy.ops.focal.bind() == {"FINISHED"}, "weights only")
    check(places == {b.name: tuple(b.head_local) for b in armature.data.bones}, "bones stay to the bit")
    check(weight_of(obj, "foot.L") > 10 and weight_of(other, "foot.L") == 0, "weights are there again")
    for vertex in obj.data.vertices:
        check(abs(sum(g.weight for g in vertex.groups) - 1) < 1e-3, "weights sum to 1")
    activate(other)
    check("has no armature" in refused(lambda: (other.modifiers.clear(), setattr(other, "parent", None),
                                                bpy.ops.focal.bind())[-1]), "bind needs an armature")
    settings.bone_names, settings.ground_root = "RIGIFY", False
    settings.model_path = os.path.join(OUT, "rig.focal")
    for one in (obj, other, armature):
        bpy.data.objects.remove(one)
    step("a character of two objects")
