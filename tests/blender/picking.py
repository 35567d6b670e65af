"""Landmarks placed by clicks in a window: the view can be turned meanwhile, corrections bring others along, undo takes them back."""
import sys

import bpy

from common import MODULE, activate, check, step
from in_window import OTHER, call, jobs, press, view, wait_for_job


def test():
    yield from click()
    yield from look_around()
    yield from pass_over()
    yield from correct()
    yield from cancel_correction()


def start():
    call(bpy.ops.focal.landmark_pick, "INVOKE_DEFAULT")
    yield 0.1
    check(running(), "clicks are being placed")


def running():
    return sys.modules[MODULE + ".landmark_pick"]._running


def marks():
    return bpy.data.objects[OTHER].focal.landmarks


def click():
    """A click on the surface places the next landmark; Esc ends; undo takes it back."""
    obj = bpy.data.objects[OTHER]
    activate(obj)
    call(bpy.ops.focal.landmark_add, name="belly")
    call(bpy.ops.ed.undo_push, message="named")
    call(bpy.ops.view3d.view_selected)
    yield 0.3
    where = view()
    call(bpy.ops.focal.landmark_pick, "INVOKE_DEFAULT")
    yield 0.1
    yield from press(where, "LEFTMOUSE")
    check(bpy.data.objects[OTHER].focal.landmarks["belly"].placed, "the click placed it")
    yield from press(where, "ESC")
    call(bpy.ops.ed.undo)
    yield 0.1
    check(not bpy.data.objects[OTHER].focal.landmarks["belly"].placed, "undo takes the click back")
    call(bpy.ops.focal.landmark_remove, all=True)
    call(bpy.ops.ed.undo_push, message="no landmarks")
    step("placed by a click and undone")


def places():
    return [(m.name, m.status, tuple(m.position)) for m in bpy.data.objects[OTHER].focal.landmarks]


def correct():
    """On a detected mesh the others follow a correction: as a job, and undo takes the click back with them."""
    activate(bpy.data.objects[OTHER])
    call(bpy.ops.focal.detect, "INVOKE_DEFAULT")
    yield from wait_for_job(10)
    marks = bpy.data.objects[OTHER].focal.landmarks
    bpy.data.objects[OTHER].focal.active = marks.find("nose")
    call(bpy.ops.ed.undo_push, message="detected")
    detected = places()
    call(bpy.ops.focal.landmark_accept, "INVOKE_DEFAULT", True)
    check(jobs().current() is not None, "the others are looked for again")
    yield from wait_for_job(10)
    check(bpy.data.objects[OTHER].focal.landmarks["nose"].status == "MARKED", "accepted")
    accepted = places()
    where = view()
    call(bpy.ops.focal.landmark_pick, "INVOKE_DEFAULT")
    yield 0.1
    yield from press(where, "LEFTMOUSE")
    yield from wait_for_job(10)
    clicked = places()
    check(sum(a != b for a, b in zip(clicked, accepted)) > 1, "the click moves the nose, and others after it")
    yield from press(where, "ESC")
    check(places() == clicked, "the end of clicking changes nothing")
    for wanted in (accepted, None, detected):  # None: accepted, the others not yet looked for
        call(bpy.ops.ed.undo)
        yield 0.1
        check(wanted is None or places() == wanted, "undo goes back by one correction")
    call(bpy.ops.focal.landmark_remove, all=True)
    bpy.data.objects[OTHER].focal.model = ""
    call(bpy.ops.ed.undo_push, message="no landmarks again")
    step("accepted and clicked, the others followed, undone")


def answers_of_clicks():
    """{type of event: what the operator answered}, filled while it runs."""
    cls, answers = sys.modules[MODULE + ".landmark_pick"].FOCAL_OT_landmark_pick, {}
    handle = cls._handle

    def recorded(self, context, event):
        answer = handle(self, context, event)
        answers.setdefault(event.type, set()).update(answer)
        return answer
    cls._handle = recorded
    return answers, lambda: setattr(cls, "_handle", handle)


def look_around():
    """Keys of the view, the numpad, its pies and its gizmo are left to Blender; other keys are not; a second instance does not start."""
    activate(bpy.data.objects[OTHER])
    call(bpy.ops.focal.landmark_add, name="belly")
    where = view()
    answers, restore = answers_of_clicks()
    yield from start()
    with bpy.context.temp_override(**where):
        check(not bpy.ops.focal.landmark_pick.poll(), "one at a time")
    for key in ("NUMPAD_3", "NUMPAD_PERIOD", "NUMPAD_SLASH", "HOME", "N", "WHEELUPMOUSE", "MIDDLEMOUSE", "TIMER1"):
        yield from press(where, key)
        check(answers.get(key) == {"PASS_THROUGH"}, f"{key} is the view's: {answers.get(key)}")
    for key in ("X", "G", "DEL", "ONE"):
        yield from press(where, key)
        check(answers.get(key) == {"RUNNING_MODAL"}, f"{key} would change the scene: {answers.get(key)}")
    yield from over_gizmo(where, answers)
    check(OTHER in bpy.data.objects and running() and not marks()["belly"].placed, "nothing was placed, and clicks still are")
    yield from press(where, "Z")
    check(answers.get("Z") == {"PASS_THROUGH"}, f"Z opens a pie: {answers.get('Z')}")
    restore()
    for _ in range(2):  # a pie that is open takes the first one
        if running():
            yield from press(where, "ESC")
    check(not running(), "Esc ends it")
    call(bpy.ops.focal.landmark_remove, all=True)
    call(bpy.ops.view3d.view_selected)
    yield 0.5
    step("the view's events are left to it while landmarks are placed")


def over_gizmo(where, answers):
    """A press on the ball in the corner is the view's."""
    events = sys.modules[MODULE + ".view_events"]
    with bpy.context.temp_override(**where):
        right, top = events._free_corner(where["area"])
        x, y = int(right - 50), int(top - 50)
        check(events.over_gizmo(bpy.context, x, y), "the gizmo is in the corner")
        check(not events.over_gizmo(bpy.context, right - 200, top - 200), "and not everywhere")
    answers.pop("LEFTMOUSE", None)
    for value in ("PRESS", "RELEASE"):
        where["window"].event_simulate(type="LEFTMOUSE", value=value, x=x, y=y)
        yield 0.2
    check(answers.get("LEFTMOUSE") == {"PASS_THROUGH"}, "the gizmo gets its clicks")


def pass_over():
    """Tab leads past a pair and does not come back to it."""
    obj = bpy.data.objects[OTHER]
    for name in ("elbow.L", "elbow.R", "nose", "chin"):
        call(bpy.ops.focal.landmark_add, name=name)
    obj.focal.active = 0
    where, seen = view(), []
    yield from start()
    for _ in range(3):
        yield from press(where, "TAB")
        seen.append(marks()[bpy.data.objects[OTHER].focal.active].name)
    check(seen == ["elbow.R", "nose", "chin"], f"Tab leads on: {seen}")
    yield from press(where, "ESC")
    call(bpy.ops.focal.landmark_remove, all=True)
    step("Tab passes over a pair")


def cancel_correction():
    """Esc while the others are looked for leaves the correction, with a step of undo of its own."""
    activate(bpy.data.objects[OTHER])
    call(bpy.ops.focal.detect, "INVOKE_DEFAULT")
    yield from wait_for_job(20)
    bpy.data.objects[OTHER].focal.active = marks().find("nose")
    call(bpy.ops.ed.undo_push, message="detected")
    detected = places()
    sys.modules[MODULE + ".detection"].clear_cache()  # so that it takes long enough
    where = view()
    yield from start()
    send = where["window"].event_simulate
    x, y = (where["region"].x + where["region"].width // 2, where["region"].y + where["region"].height // 2)
    send(type="LEFTMOUSE", value="PRESS", x=x, y=y)
    yield 0.05
    check(jobs().current() is not None, "the others are looked for")
    send(type="ESC", value="PRESS", x=x, y=y)
    yield from wait_for_job(20)
    check(running(), "Esc ends the looking, not the placing")
    corrected = places()
    check(sum(a != b for a, b in zip(corrected, detected)) == 1 and marks()["nose"].status == "MARKED", "the correction stays alone")
    yield from press(where, "ESC")
    check(not running(), "the second Esc ends the placing")
    call(bpy.ops.ed.undo)
    yield 0.1
    check(places() == detected, "undo takes the correction back")
    call(bpy.ops.ed.redo)
    yield 0.1
    check(places() == corrected, "and redo brings it")
    call(bpy.ops.focal.landmark_remove, all=True)
    bpy.data.objects[OTHER].focal.model = ""
    call(bpy.ops.ed.undo_push, message="no landmarks once more")
    step("Esc left the correction")
