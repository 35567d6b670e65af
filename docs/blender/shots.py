"""Takes the pictures of docs/blender.md in a real window: see make.sh beside it."""
import json
import os
import shutil
import subprocess
import sys
import traceback

import bmesh
import bpy
from mathutils import Vector

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../tests/blender"))
from common import MODULE, OUT, SAMPLES, activate, install, load_character  # noqa: E402

TRAINING = [f"humanoid_{i:02}" for i in range(6)]
OTHER = "humanoid_06"
TEMPLATE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../samples/templates/humanoid.json")
GAME_CHARACTER, STOCK = (os.environ[name] for name in ("FOCAL_GAME_CHARACTER", "FOCAL_STOCK"))
TABS_X, FOCAL_TAB_Y = 13, 190  # from the right and the top of the area: below Item, Tool, View


def window():
    return bpy.context.window_manager.windows[0]


def area():
    return next(a for a in window().screen.areas if a.type == "VIEW_3D")


def region(kind="WINDOW"):
    return next(r for r in area().regions if r.type == kind)


def call(operator, *arguments, **options):
    with bpy.context.temp_override(window=window(), area=area(), region=region()):
        return operator(*arguments, **options)


def shoot(name):
    call(bpy.ops.screen.screenshot_area, filepath=os.path.join(OUT, name + ".png"))


def show(*objects, axis="BACK"):
    """Only these, from the front: the samples look to +Y."""
    for obj in bpy.data.objects:
        if obj.type == "MESH":
            obj.hide_set(obj not in objects)
    activate(objects[0])
    for obj in objects:
        obj.select_set(True)
    call(bpy.ops.view3d.view_axis, type=axis)
    call(bpy.ops.view3d.view_selected)
    for obj in objects:
        obj.select_set(False)
    bpy.context.view_layer.objects.active = objects[0]


shown = set()


def panels_by_label():
    """Makes the tab's panels show by their label, open: what a user does by clicking their headers."""
    main, skeleton = (sys.modules[f"{MODULE}.{name}"] for name in ("panels", "panel_skeleton"))
    for cls in main.CLASSES + skeleton.CLASSES:
        if not issubclass(cls, bpy.types.Panel) or cls is main.FOCAL_PT_main:
            continue
        bpy.utils.unregister_class(cls)
        cls.bl_options = set()
        cls.poll = classmethod(lambda cls, _context: cls.bl_label in shown)
        bpy.utils.register_class(cls)


def open_panels(*labels):
    shown.clear()
    shown.update(labels)


def click_tab():
    """Blender has no call that chooses a tab."""
    for x, y in ((area().width - TABS_X, FOCAL_TAB_Y), (300, 800)):
        y += window().height - area().y - area().height
        subprocess.run(["xdotool", "mousemove", str(x), str(y)], check=True)
        yield 0.3
        if x != 300:
            for press in ("mousedown", "mouseup"):
                subprocess.run(["xdotool", press, "1"], check=True)
                yield 0.3


def prepare():
    install()
    for obj in list(bpy.data.objects):
        bpy.data.objects.remove(obj)
    for number, name in enumerate(TRAINING + [OTHER]):
        obj = load_character(name)
        if name != OTHER:
            activate(obj)
            call(bpy.ops.focal.landmark_import, filepath=os.path.join(SAMPLES, name + ".landmarks.json"))
            bpy.ops.focal.training_add()
    settings = bpy.context.scene.focal
    bpy.ops.wm.save_as_mainfile(filepath=os.path.join(OUT, "pictures.blend"))
    shutil.copy(TEMPLATE, OUT)
    settings.model_path = "//humanoid.focal"
    space = area().spaces.active
    space.show_region_ui = True
    space.overlay.show_floor = space.overlay.show_axis_x = space.overlay.show_axis_y = False
    space.overlay.show_outline_selected = False
    space.show_gizmo = space.show_region_toolbar = space.show_region_tool_header = False
    space.overlay.show_text = False


def without_a_hand(obj):
    """A copy that lacks a forearm: what is not there cannot be found."""
    hurt = obj.copy()
    hurt.data = obj.data.copy()
    bpy.context.scene.collection.objects.link(hurt)
    with open(os.path.join(SAMPLES, OTHER + ".landmarks.json"), encoding="utf-8") as file:
        x, y, z = next(m["position"] for m in json.load(file)["landmarks"] if m["name"] == "handTip.L")
    mesh = bmesh.new()
    mesh.from_mesh(hurt.data)
    gone = [v for v in mesh.verts if (v.co - Vector((x, -z, y))).length < 0.25]
    bmesh.ops.delete(mesh, geom=gone, context="VERTS")
    mesh.to_mesh(hurt.data)
    mesh.free()
    return hurt


def shots():
    prepare()
    open_panels("Landmarks", "Detect")
    panels_by_label()
    yield 1
    show(bpy.data.objects[TRAINING[0]])
    yield 1
    yield from click_tab()
    yield 1
    shoot("landmarks")
    yield from training_shot()
    yield from detection_shots(bpy.data.objects[OTHER])


def training_shot():
    settings, jobs = bpy.context.scene.focal, sys.modules[MODULE + ".jobs"]
    open_panels("Landmarks", "Train")
    settings.quality = "DRAFT"
    call(bpy.ops.focal.cross_validate, "INVOKE_DEFAULT")
    while jobs.current() is not None:
        yield 0.5
    settings.quality = "FULL"
    call(bpy.ops.focal.train, "INVOKE_DEFAULT")
    while jobs.current().progress() < 0.35:
        yield 0.5
    shoot("train")
    while jobs.current() is not None:
        yield 0.5


def detection_shots(other):
    settings = bpy.context.scene.focal
    settings.empties, settings.template_path = False, "//humanoid.json"
    open_panels("Landmarks", "Detect")
    show(without_a_hand(other))
    call(bpy.ops.focal.detect)
    yield 1
    shoot("detect")
    show(other)
    call(bpy.ops.focal.detect)
    other.focal.active = other.focal.landmarks.find("elbow.L")
    call(bpy.ops.focal.show_votes)
    yield 1
    shoot("votes")
    open_panels("Segment")
    call(bpy.ops.focal.segment)
    yield 1
    shoot("parts")
    area().spaces.active.shading.color_type = "MATERIAL"
    yield from skeleton_shot(other)
    yield from rig_shot()


def skeleton_shot(other):
    """The template over this mesh's landmarks, as bones."""
    settings = bpy.context.scene.focal
    settings.template_path = ""
    open_panels("Skeleton")
    call(bpy.ops.focal.joint_template, kind="humanoid")
    settings.joint_active = settings.joints.find("leftUpperArm")
    call(bpy.ops.focal.joint_show)
    activate(other)
    yield 1
    shoot("skeleton")
    call(bpy.ops.focal.joint_remove, all=True)


def rig_shot():
    """A game character of several objects, by a model of others."""
    settings = bpy.context.scene.focal
    for obj in list(bpy.data.objects):
        obj.hide_set(True)
    before = set(bpy.data.objects)
    call(bpy.ops.import_scene.gltf, filepath=GAME_CHARACTER)
    parts = [obj for obj in bpy.data.objects if obj not in before and obj.type == "MESH"]
    shutil.copy(STOCK, OUT)
    settings.model_path = "//" + os.path.basename(STOCK)
    open_panels("Detect", "Rig")
    show(*parts, axis="FRONT")  # it is turned
    for obj in parts:
        obj.select_set(True)
    call(bpy.ops.focal.rig)
    yield 1
    shoot("rig")


def run(steps=shots()):
    try:
        return next(steps)
    except StopIteration:
        print("all passed", flush=True)
        bpy.ops.wm.quit_blender()
    except BaseException:
        traceback.print_exc()
        os._exit(3)


bpy.context.preferences.view.show_splash = False
bpy.app.timers.register(run, first_interval=0.5)
