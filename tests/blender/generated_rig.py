"""The metarig goes into Rigify, which comes with Blender: Generate makes controls, and a limb of what it makes moves the mesh."""
import bpy
import numpy

from common import check, step


def shape(obj):
    """Its vertices as they are shown."""
    mesh = obj.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    places = numpy.empty(3 * len(mesh.vertices), dtype=numpy.float32)
    mesh.vertices.foreach_get("co", places)
    return places.reshape(-1, 3)


def test(parts):
    settings = bpy.context.scene.focal
    settings.bone_names = "RIGIFY_METARIG"
    check(bpy.ops.focal.rig() == {"FINISHED"}, "rigged with the metarig's names")
    metarig = parts[0].modifiers[0].object
    bpy.ops.preferences.addon_enable(module="rigify")
    check(not bpy.ops.focal.rigify_bind.poll(), "nothing is generated yet")
    bpy.context.view_layer.objects.active = metarig
    check(bpy.ops.pose.rigify_generate() == {"FINISHED"}, "Generate makes controls")
    rig = metarig.data.rigify_target_rig
    for control in ("hand_ik.L", "foot_ik.R", "upper_arm_fk.L", "torso", "head"):
        check(control in rig.pose.bones, f"{control} is a control")
    bpy.context.view_layer.objects.active = parts[0]
    check(bpy.ops.focal.rigify_bind() == {"FINISHED"}, "the mesh follows what was generated")
    test_limb(parts, rig)
    step(f"Rigify made {len(rig.pose.bones)} bones, and they move the mesh")


def test_limb(parts, rig):
    """The hand's control takes the hand along and leaves the feet."""
    before = [shape(p) for p in parts]
    rig.pose.bones["hand_ik.L"].location = (0.0, 0.0, 0.1)
    bpy.context.view_layer.update()
    moved = [numpy.linalg.norm(shape(p) - b, axis=1) for p, b in zip(parts, before)]
    height = max(b[:, 2].max() for b in before) - min(b[:, 2].min() for b in before)
    check(max(m.max() for m in moved) > 0.03, "the mesh follows the hand's control")
    feet = [m[b[:, 2] < b[:, 2].min() + 0.02 * height] for m, b in zip(moved, before)]
    lowest = int(numpy.argmin([b[:, 2].min() for b in before]))
    check(feet[lowest].max() < 1e-3, "the feet stay")
