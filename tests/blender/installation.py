"""Switching on and off, a library that is missing, what undo and files keep."""
import os
import sys

import bpy

from common import MODULE, OUT, TRAINING, activate, check, empty_scene, install, refused, step


def test_library_missing():
    """Without its library the add-on can be switched on, says what to do, and is well again when there is one."""
    os.environ["FOCAL_LIBRARY"] = "/nowhere/libfocal.so.0"
    install()
    empty_scene()
    engine = sys.modules[MODULE + ".engine"]
    check("/nowhere" in engine.problem() and "unset it" in engine.problem(), f"reported: {engine.problem()}")
    bpy.ops.mesh.primitive_uv_sphere_add()
    check("/nowhere" in refused(bpy.ops.focal.detect), "operators report it too")
    del os.environ["FOCAL_LIBRARY"]
    bpy.ops.focal.check_library()
    check(not engine.problem() and engine.ready(), "and well again")
    bpy.context.preferences.addons[MODULE].preferences.library_path = "/nowhere/libfocal.so"
    check(engine.waits_for_restart() and engine.ready(), "another path waits for the next start")
    bpy.context.preferences.addons[MODULE].preferences.library_path = ""
    bpy.data.objects.remove(bpy.context.active_object)
    test_advice(engine)
    step("installed, without its library first")


def test_advice(engine):
    """Each reason has its own way out."""
    package, folder = engine.package(), os.path.join(OUT, "damaged")
    os.makedirs(folder)
    for name, content in (("text.so", b"no library at all"), ("other.so", b"\x7fELF\x02\x01\x01" + bytes(57))):
        with open(os.path.join(folder, name), "wb") as file:
            file.write(content)
        try:
            package._library._open(os.path.join(folder, name))
        except package.LibraryError as error:
            check("focal_addon-linux-x64.zip" in engine.library_advice(str(error), None, None), f"another zip: {error}")
    for text, wanted in (("libfocal.so: version `GLIBC_2.38' not found", "older"),
                         ("libm.so.9: cannot open shared object file", "install the zip again"),
                         ("libfocal.so is focal 0.0.9, this package is for 0.1.0.", "another version"),
                         ("libfocal.so has no focal_task_stage: it is older than this package.", "another version")):
        check(wanted in engine.library_advice(text, None, None), text)
    check("preferences name" in engine.library_advice("x", "/my/libfocal.so", None), "a path of the user's")


def test_off_and_on():
    bpy.ops.preferences.addon_disable(module=MODULE)
    check(not hasattr(bpy.types.Scene, "focal") and not hasattr(bpy.types.Object, "focal"), "no trace when off")
    bpy.ops.preferences.addon_enable(module=MODULE)
    check(sys.modules[MODULE + ".engine"].ready(), "and on again")
    step("off and on")


def scene_state():
    """What undo must bring back."""
    return {o.name: (o.type, len(o.focal.landmarks), [tuple(round(x, 5) for x in m.position) for m in o.focal.landmarks],
                     len(o.modifiers), len(o.vertex_groups), len(o.children)) for o in bpy.data.objects}


def test_undo_and_file():
    """Landmarks survive saving; undo takes an operator back whole."""
    path = os.path.join(OUT, "scene.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    before = scene_state()
    bpy.ops.wm.open_mainfile(filepath=path)
    check(scene_state() == before, "the file holds all that was")
    activate(bpy.data.objects[TRAINING[1]])
    bpy.ops.ed.undo_push(message="before")
    before = scene_state()
    settings = bpy.context.scene.focal
    settings.replace_rig = True
    check(bpy.ops.focal.rig() == {"FINISHED"}, "rigged")
    bpy.ops.ed.undo_push(message="rig")
    check(scene_state() != before, "the scene was changed")
    bpy.ops.ed.undo()
    check(scene_state() == before, "undo brings the scene back")
    step("saved, opened, undone")
