"""The add-on in a window: progress ticks while work runs, Esc cancels, undo restores, nothing leaks.

blender --enable-event-simulate --python window.py -- ZIP SAMPLES OUT. Events come through a timer, so the test is a
generator: each yield lets Blender handle what happened so far.
"""
import os
import sys
import time
import traceback

import bpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import picking  # noqa: E402
from common import MODULE, OUT, SAMPLES, activate, check, install, load_character, resident_bytes, step  # noqa: E402
from in_window import OTHER, call, jobs, view, wait_for_job  # noqa: E402

TRAINING = ("humanoid_00", "humanoid_01", "humanoid_02")
TICK = 0.050  # between timer events; some are left to drawing without a GPU, and to what else the machine does
STALL = 1.0
CYCLES = 100
WARM_UP = 20  # until caches, undo steps and the allocator have what they keep
MOST_GROWTH = 0.05
ticks = []


def record_ticks():
    """Times of the modal operator's timer events while work runs."""
    show = jobs().JobOperator._show_progress

    def timed(self, context):
        ticks.append(time.perf_counter())
        show(self, context)
    jobs().JobOperator._show_progress = timed


def gaps():
    """Seconds between timer events, shortest first."""
    return sorted(b - a for a, b in zip(ticks, ticks[1:]))


def prepare():
    for obj in list(bpy.data.objects):
        bpy.data.objects.remove(obj)
    for number, name in enumerate(TRAINING + (OTHER,)):
        obj = load_character(name)
        obj.location.x = 1.2 * number
        if name == OTHER:
            break
        activate(obj)
        path = os.path.join(SAMPLES, name + ".landmarks.json")
        obj.location.x = 0
        bpy.context.view_layer.update()
        call(bpy.ops.focal.landmark_import, filepath=path)
        obj.location.x = 1.2 * number
        bpy.ops.focal.training_add()
    settings = bpy.context.scene.focal
    settings.quality, settings.empties = "DRAFT", True
    settings.model_path = os.path.join(OUT, "window.focal")
    call(bpy.ops.ed.undo_push, message="prepared")
    bpy.context.preferences.system.viewport_aa = "OFF"  # without a GPU each of its passes takes a good part of a second
    call(bpy.ops.wm.redraw_timer, type="DRAW_WIN_SWAP", iterations=2)  # the first ones compile shaders
    step("characters loaded")


def train():
    """Progress rises, and the timer is never late."""
    ticks.clear()
    call(bpy.ops.focal.train, "INVOKE_DEFAULT")
    job, seen, stages = jobs().current(), [], set()
    check(job is not None, "training runs")
    while jobs().current() is not None:
        seen.append(job.progress())
        stages.add(job.step_name())
        yield 0.01
    check(job.progress() == 1.0, "progress ends at 100 %")
    check(len(stages) > 3 and stages <= {"Starting"} | {name for name in stages if name.startswith("Training")}, f"each stage has its name: {stages}")
    check(not job.failure and os.path.isfile(bpy.context.scene.focal.model_path), f"trained: {job.failure}")
    check(seen == sorted(seen) and len(set(seen)) > 5, "progress rises")
    found = gaps()
    most, nearly_all, longest = (1000 * found[int(share * (len(found) - 1))] for share in (0.9, 0.99, 1))
    step(f"trained: {len(ticks)} timer events, 90 % within {most:.0f} ms, 99 % within {nearly_all:.0f} ms, the longest "
         f"{longest:.0f} ms")
    check(most <= 1000 * TICK, f"the timer fires within {1000 * TICK:.0f} ms")
    check(longest <= 1000 * STALL, f"nothing stalls Blender for {longest:.0f} ms")


def cancel():
    """Esc stops the work soon and leaves no trace."""
    before = state()
    modified = os.path.getmtime(bpy.context.scene.focal.model_path)
    call(bpy.ops.focal.train, "INVOKE_DEFAULT")
    yield 0.5
    check(jobs().current() is not None, "training runs")
    began = time.perf_counter()
    view()["window"].event_simulate(type="ESC", value="PRESS", x=100, y=100)
    yield from wait_for_job(2)
    took = time.perf_counter() - began
    check(state() == before and os.path.getmtime(bpy.context.scene.focal.model_path) == modified, "nothing changed")
    step(f"cancelled within {1000 * took:.0f} ms")
    check(took < 0.5, "cancelled soon")


def state():
    return {o.name: (o.type, len(o.focal.landmarks), len(o.children), len(o.modifiers)) for o in bpy.data.objects}


def cycles():
    """Detect and undo again and again: the scene comes back, memory stays."""
    for area in view()["window"].screen.areas:  # without a GPU, drawing takes more time than the work
        area.type = "CONSOLE"
    bpy.context.scene.focal.search = "INTERACTIVE"
    call(bpy.ops.ed.undo_push, message="quick")
    yield 0.2
    before, sizes = state(), []
    detection = sys.modules[MODULE + ".detection"]
    for number in range(CYCLES):
        activate(bpy.data.objects[OTHER])
        detection._detections.clear()  # each time anew
        call(bpy.ops.focal.detect, "INVOKE_DEFAULT")
        yield from wait_for_job(10)
        check(len(bpy.data.objects[OTHER].focal.landmarks) == 24, "landmarks are found")
        yield 0.0
        call(bpy.ops.ed.undo)
        check(state() == before, f"undo restores the scene, cycle {number}")
        sizes.append(resident_bytes())
        yield 0.0
    print("MiB:", *[size >> 20 for size in sizes[::10]])
    growth = max(sizes[-10:]) / max(sizes[WARM_UP - 10:WARM_UP]) - 1
    step(f"{CYCLES} times detected and undone: {sizes[WARM_UP] / 2**20:.0f} MiB then {sizes[-1] / 2**20:.0f} MiB, "
         f"{100 * growth:+.1f} %")
    check(growth <= MOST_GROWTH, f"memory grew by {100 * growth:.1f} %")


def test():
    install()
    record_ticks()
    yield 0.5
    prepare()
    yield 0.5
    yield from train()
    yield from cancel()
    yield from picking.test()
    yield from cycles()
    call(bpy.ops.focal.train, "INVOKE_DEFAULT")  # Blender ends while it runs, and must end well
    yield 0.3
    check(jobs().current() is not None, "training runs")


def run(steps=test()):
    """A timer's function: seconds to the next call."""
    try:
        return next(steps)
    except StopIteration:
        print("all passed", flush=True)
        bpy.ops.wm.quit_blender()
    except BaseException:
        traceback.print_exc()
        sys.stdout.flush()
        os._exit(3)


bpy.app.timers.register(run, first_interval=0.5)
