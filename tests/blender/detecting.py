"""Landmarks found, what is refused, and what is looked at afterwards."""
import os
import sys

import bpy
import numpy

from common import MODULE, OTHERS, OUT, SAMPLES, TRAINING, activate, check, load_character, refused, size, step, truth, world


def test_refusals():
    """What cannot be done is reported, and nothing is changed."""
    settings = bpy.context.scene.focal
    bpy.ops.mesh.primitive_cube_add()
    cube = bpy.context.active_object
    cube.scale = (1, 0, 1)
    bpy.context.view_layer.update()
    check("scales is 0" in refused(bpy.ops.focal.detect), "a flat object")
    cube.scale = (1, 1, 1)
    cube.data.clear_geometry()
    bpy.context.view_layer.update()
    check("no faces" in refused(bpy.ops.focal.detect), "an empty mesh")
    bpy.data.objects.remove(cube)
    bpy.ops.object.light_add()
    check("no mesh" in refused(bpy.ops.focal.detect), "a light")
    bpy.data.objects.remove(bpy.context.active_object)
    obj = bpy.data.objects[TRAINING[0]]
    activate(obj)
    obj.modifiers.new("Half", "MIRROR")
    check("apply it first" in refused(bpy.ops.focal.detect), "half a mesh")
    obj.modifiers.clear()
    path, settings.model_path = settings.model_path, "/nowhere/none.focal"
    check("no model" in refused(bpy.ops.focal.detect), "no model")
    settings.model_path = "dragon"
    check("no stock model 'dragon'" in refused(bpy.ops.focal.detect), "no stock model")
    check("mine" in refused(bpy.ops.focal.detect), "the stock models are named")
    settings.model_path = path
    twin = bpy.data.objects.new("twin", obj.data)
    check("shares its mesh" in refused(bpy.ops.focal.rig), "a mesh of two objects")
    bpy.data.objects.remove(twin)
    check(obj.parent is None or obj.parent.type != "ARMATURE", "nothing was changed")
    step("refusals")


def test_detection():
    """Within 4 % of the size for nearly all, on meshes that are scaled, mirrored and have shape keys."""
    settings = bpy.context.scene.focal
    errors = []
    for number, name in enumerate(OTHERS):
        obj = load_character(name)
        activate(obj)
        if number == 1:
            obj.scale = [2 * s for s in obj.scale]
        if number == 2:
            obj.shape_key_add(name="Basis")
            key = obj.shape_key_add(name="Moved")
            key.data.foreach_set("co", numpy.zeros(3 * len(obj.data.vertices), dtype=numpy.float32))
            key.value = 1.0
        bpy.context.view_layer.update()
        check(bpy.ops.focal.detect() == {"FINISHED"}, f"detected on {name}")
        scale = 2 if number == 1 else 1
        for mark in obj.focal.landmarks:
            check(mark.placed, f"{mark.name} of {name} is {mark.status}")
            errors.append(numpy.linalg.norm(world(obj, mark) - scale * truth(name)[mark.name]) / size(obj))
        if number == 2:
            obj.shape_key_clear()
    step(f"detected on three: mean {100 * numpy.mean(errors):.2f} %, worst {100 * max(errors):.2f} % of the size")
    check(numpy.mean(errors) < 0.03 and numpy.quantile(errors, 0.9) < 0.06, "places are right")
    test_mirrored_object(settings)
    test_empties(settings)


def test_mirrored_object(settings):
    """A negative scale turns the surface inside out unless it is seen to: left stays left."""
    obj = bpy.data.objects[OTHERS[0]]
    activate(obj)
    old = {mark.name: world(obj, mark) for mark in obj.focal.landmarks}
    obj.focal.landmarks.clear()
    obj.scale.x *= -1
    bpy.context.view_layer.update()
    bpy.ops.focal.detect()
    left, right = world(obj, obj.focal.landmarks["handTip.L"]), world(obj, obj.focal.landmarks["handTip.R"])
    swapped = old["handTip.R"] * [-1, 1, 1], old["handTip.L"] * [-1, 1, 1]
    check(numpy.linalg.norm(left - swapped[0]) < 0.1 and numpy.linalg.norm(right - swapped[1]) < 0.1,
          "the mirror image's left hand is the right one's image")
    obj.scale.x *= -1
    bpy.context.view_layer.update()
    bpy.ops.focal.detect(keep_marked=False)
    step("a mirrored object")


def test_empties(settings):
    """None unless they are wanted, and none that is stale."""
    obj = bpy.data.objects[OTHERS[1]]
    activate(obj)
    check(not obj.children, "no empties unless asked for")
    settings.empties = True
    check({c["focal_landmark"] for c in obj.children} == {m.name for m in obj.focal.landmarks}, "an empty for each landmark")
    obj.focal.active = 0
    bpy.ops.focal.landmark_unplace()
    check(len(obj.children) == len(obj.focal.landmarks) - 1, "none for what has no place")
    settings.empties = False
    check(not obj.children and f"{obj.name} landmarks" not in bpy.data.collections, "none when they are not wanted any more")
    bpy.ops.focal.detect()
    step("empties")


def exported_colours(obj):
    """Whether the mesh leaves Blender with colours."""
    path = os.path.join(OUT, "colours.glb")
    activate(obj)
    bpy.ops.export_scene.gltf(filepath=path, export_format="GLB", use_selection=True)
    with open(path, "rb") as file:
        return b"COLOR_0" in file.read()


def test_vote_map(obj):
    """Drawn only, unless it is to be kept; and off again."""
    votes = sys.modules[MODULE + ".vote_map"]
    bpy.ops.focal.show_votes()
    check(votes.shown(obj) is not None and not obj.data.color_attributes, "the map is no data of the mesh")
    check(not exported_colours(obj), "nor of what is exported")
    shown = votes.shown(obj).colours
    check(bpy.ops.focal.hide_votes() == {"FINISHED"} and votes.shown(obj) is None, "off")
    bpy.context.scene.focal.keep_votes = True
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.focal.show_votes()
    check(exported_colours(obj), "kept, it is exported")
    return shown


def test_extras():
    """What focal wrote into a glTF file becomes the list again, and its nodes do not stay beside it."""
    focal, name = sys.modules[MODULE + ".engine"].package(), OTHERS[2]
    path = os.path.join(OUT, "marked.glb")
    model = focal.Model.load(bpy.context.scene.focal.model_path)
    detection = model.detect(focal.Mesh.load(os.path.join(SAMPLES, name + ".glb")))
    detection.write(path)
    before = set(bpy.data.objects)
    bpy.ops.import_scene.gltf(filepath=path)
    new = [o for o in bpy.data.objects if o not in before]
    check([o.type for o in new] == ["MESH"], f"the mesh alone: {[o.name for o in new]}")
    marks = new[0].focal.landmarks
    for found in detection:
        mark = marks[found.name]
        check(mark.status == found.status.name and abs(mark.confidence - found.confidence) < 1e-4, f"{mark.name}: {mark.status}")
        check(found.absent or numpy.linalg.norm(world(new[0], mark) - found.position) < 1e-3, f"{mark.name} is where it was")
    bpy.data.objects.remove(new[0])
    step("a file's landmarks are the list again")


def test_votes_and_parts():
    obj = bpy.data.objects[OTHERS[0]]
    activate(obj)
    obj.focal.active = obj.focal.landmarks.find("nose")
    shown = test_vote_map(obj)
    colours = numpy.empty(4 * len(obj.data.vertices), dtype=numpy.float32)
    obj.data.color_attributes["focal votes"].data.foreach_get("color", colours)
    check(numpy.allclose(colours.reshape(-1, 4)[:, :3], shown[:, :3]), "drawn and kept are alike")
    hottest = int(colours.reshape(-1, 4)[:, 0].argmax())
    x, y, z = obj.matrix_world @ obj.data.vertices[hottest].co
    check(numpy.linalg.norm(numpy.array([x, z, -y]) - truth(obj.name)["nose"]) < 0.25, "the map is hot at the nose")
    check(bpy.ops.focal.hide_votes() == {"FINISHED"} and "focal votes" not in obj.data.color_attributes, "the kept one goes too")
    bpy.context.scene.focal.keep_votes = False
    bpy.ops.focal.segment()
    parts = numpy.empty(len(obj.data.polygons), dtype=numpy.int32)
    obj.data.attributes["focal part"].data.foreach_get("value", parts)
    check(len(numpy.unique(parts)) > 10 and parts.min() >= 0, "every face is in a part")
    groups = [g for g in obj.vertex_groups if g.name.startswith("part ")]
    check(len(groups) == len(numpy.unique(parts)), "a group a part")
    step("vote map and parts")
