"""From nothing but the zip: a character of many objects is selected, rigged by the stock model, exported and imported again.

blender -b --python stock.py -- ZIP SAMPLES OUT. With FOCAL_WILD, a folder of game characters, also the one with the most parts.
"""
import os
import sys

import bpy
import numpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import generated_rig  # noqa: E402
from common import MODULE, OUT, SAMPLES, check, install, step  # noqa: E402

WILD = "q_women_adventurer"  # 16 parts
HUMAN = ("Hips", "Spine", "Head", "LeftArm", "LeftForeArm", "RightForeArm", "LeftUpLeg", "LeftLeg", "RightLeg", "RightFoot")


def load_parts(path):
    """Every mesh of a file, loose pieces as objects of their own, all selected."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=False)
    bpy.ops.import_scene.gltf(filepath=path)
    meshes = [o for o in bpy.data.objects if o.type == "MESH"]
    select(meshes)
    if len(meshes) < 4:
        bpy.ops.mesh.separate(type="LOOSE")
    parts = [o for o in bpy.data.objects if o.type == "MESH" and o.data.polygons]
    select(parts)
    return parts


def select(objects):
    for obj in bpy.context.selected_objects:
        obj.select_set(False)
    for obj in objects:
        obj.select_set(True)
    bpy.context.view_layer.objects.active = objects[0]


def bounds(objects):
    corners = numpy.array([tuple(o.matrix_world @ v.co) for o in objects for v in o.data.vertices])
    return corners.min(axis=0), corners.max(axis=0)


def test_rig(path):
    """The first click, then the names of an engine."""
    parts = load_parts(path)
    settings = bpy.context.scene.focal
    check(settings.model_path == "humanoid", "the stock humanoid is what a new file starts with")
    settings.bone_names = "MIXAMO"
    check(bpy.ops.focal.rig() == {"FINISHED"}, "the first click makes a rig")
    armatures = [o for o in bpy.data.objects if o.type == "ARMATURE"]
    check(len(armatures) == 1 and all(p.modifiers[0].object == armatures[0] for p in parts), "one armature moves all parts")
    bones = armatures[0].data.bones
    check({"mixamorig:" + name for name in HUMAN} <= set(bones.keys()), f"Mixamo's names: {sorted(bones.keys())}")
    for part in parts:
        sums = [sum(g.weight for g in v.groups) for v in part.data.vertices]
        check(abs(min(sums) - 1) < 1e-3 and abs(max(sums) - 1) < 1e-3, f"{part.name}: weights sum to 1")
        check(not part.focal.landmarks, "the model's own landmarks are not listed")
    test_places(armatures[0], parts)
    step(f"{os.path.basename(path)}: {len(parts)} objects rigged with {len(bones)} bones")
    return parts, armatures[0]


def test_places(armature, parts):
    """Inside the body's box, the head above, each side on its side."""
    low, high = bounds(parts)
    heads = {b.name[10:]: armature.matrix_world @ b.head_local for b in armature.data.bones}
    for name in HUMAN:
        check(all(low[i] - 0.05 * (high[2] - low[2]) < heads[name][i] < high[i] + 0.05 * (high[2] - low[2]) for i in range(3)), name)
    check(heads["Head"].z > heads["Spine"].z > heads["LeftLeg"].z, "the head is above")
    check((heads["LeftLeg"].x - heads["RightLeg"].x) * (heads["LeftForeArm"].x - heads["RightForeArm"].x) > 0, "sides agree")


def test_export(parts, armature):
    """Out as glTF and in again: one armature with the same bones at the same places, weights on every part."""
    path = os.path.join(OUT, "character.glb")
    select([*parts, armature])
    bpy.ops.export_scene.gltf(filepath=path, export_format="GLB", use_selection=True)
    places = {b.name: armature.matrix_world @ b.head_local for b in armature.data.bones}
    names = {p.name for p in parts}
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=False)
    bpy.ops.import_scene.gltf(filepath=path)
    back = [o for o in bpy.data.objects if o.type == "ARMATURE"]
    check(len(back) == 1, "one armature")
    meshes = [o for o in bpy.data.objects if o.type == "MESH" and any(m.type == "ARMATURE" for m in o.modifiers)]
    check({m.name for m in meshes} == names, "every part comes back, moved by an armature")
    for name, place in places.items():
        check((back[0].matrix_world @ back[0].data.bones[name].head_local - place).length < 1e-3, f"{name} is where it was")
    step("exported and imported again")


def main():
    os.environ.pop("FOCAL_MODELS", None)
    install()
    engine = sys.modules[MODULE + ".engine"]
    found = engine.stock_models()
    check("humanoid" in found, f"the zip carries the stock models: {found}")
    addon = os.path.dirname(os.path.realpath(sys.modules[MODULE].__file__))
    check(os.path.realpath(found["humanoid"]).startswith(addon), "from the zip, not from elsewhere")
    parts, armature = test_rig(os.path.join(SAMPLES, "game_humanoid_00.glb"))
    check(len(parts) >= 8, f"{len(parts)} parts")
    test_export(parts, armature)
    wild = os.path.join(os.environ.get("FOCAL_WILD", ""), WILD + ".glb")
    if os.path.isfile(wild):
        test_export(*test_rig(wild))
    parts = load_parts(os.path.join(SAMPLES, "game_humanoid_00.glb"))
    generated_rig.test(parts)
    print("all passed")


if __name__ == "__main__":
    main()
