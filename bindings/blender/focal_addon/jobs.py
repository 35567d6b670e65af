"""Long work in a thread, with progress and Esc, inside an operator that changes the scene only when all went well.

An operator derives from JobOperator and has two halves: prepare(context) reads the scene and returns the work, a
function of a Job that runs in the thread and must not touch bpy; apply(context, result) writes the result into the
scene, in the main thread. In background mode, or when called as a script's function, both run one after the other.
"""
import atexit
import os
import threading

import bpy

from .engine import FAILURES, message_of, package
from .geometry import Unusable
from .templates import TemplateError

TIMER_SECONDS = 0.02
_REDRAW_EVERY = 12  # timer events, a quarter of a second: drawing the interface costs time that the work could use

# At most one at a time: it would only compete with itself for the processor.
_current = None


class Cancelled(Exception):
    """The user gave up waiting."""


class Job:
    """One piece of long work. The thread reports through begin(); the main thread polls and may cancel."""

    def __init__(self, work):
        self._work = work
        self._lock = threading.Lock()
        self._task = None
        self._from, self._to = 0.0, 0.0
        self._thread = None
        self.stage = ""
        self.done = False
        self.cancelled = False
        self.result = None
        self.failure = ""

    def begin(self, stage, start=0.0, end=1.0):
        """The task to hand to the next call of focal, which takes the work from one share of the whole to another."""
        task = package().Task()
        with self._lock:
            if self.cancelled:
                raise Cancelled
            self._task, self.stage, self._from, self._to = task, stage, start, end
        return task

    def progress(self):
        if self.done:
            return 1.0
        with self._lock:
            task, start, end = self._task, self._from, self._to
        return start + (end - start) * (task.progress if task is not None else 0.0)

    def step_name(self):
        """What is being done, and which of the library's stages: 'Detecting on statue: spectrum'."""
        with self._lock:
            task, stage = self._task, self.stage
        detail = task.stage if task is not None and not self.done else ""
        if not stage:
            return "Starting"
        return stage[:1].upper() + stage[1:] + (f": {detail}" if detail else "")

    def cancel(self):
        with self._lock:
            self.cancelled = True
            if self._task is not None:
                self._task.cancel()

    def run(self):
        try:
            self.result = self._work(self)
            self.done = True
        except Cancelled:
            pass
        except (Unusable, TemplateError, *FAILURES) as error:
            if not self.cancelled:
                self.failure = message_of(error)
        except Exception as error:  # a bug of the add-on: the console shows where, the user sees that it happened
            import traceback
            traceback.print_exc()
            self.failure = f"{type(error).__name__}: {error}"

    def start(self):
        self._thread = threading.Thread(target=self._run_politely, name="focal", daemon=True)
        self._thread.start()

    def _run_politely(self):
        # On Linux each thread has its own niceness, and those that focal starts take it over: Blender stays quick.
        if os.name == "posix" and hasattr(threading, "get_native_id"):
            try:
                os.setpriority(os.PRIO_PROCESS, threading.get_native_id(), 2)
            except OSError:
                pass
        self.run()

    @property
    def started(self):
        return self._thread is not None

    @property
    def running(self):
        return self._thread is not None and self._thread.is_alive()

    def wait(self, seconds):
        if self._thread is not None:
            self._thread.join(seconds)


def current():
    """The job that runs now, or None."""
    return _current


class JobOperator:
    """Mixed into an operator beside bpy.types.Operator."""

    _job = None
    _target = None  # what prepare() read for apply()
    shows_progress = True  # in the status bar, unless another operator below this one does
    _timer = None
    _ticks = 0

    @classmethod
    def poll(cls, context):
        return _current is None

    def execute(self, context):
        try:
            job = self._prepared(context)
        except (Unusable, *FAILURES) as error:
            return self.refuse(message_of(error))
        job.run()
        return self._finish(context, job)

    def invoke(self, context, event):
        global _current
        if bpy.app.background or context.window is None:
            return self.execute(context)
        try:
            self._job = self._prepared(context)
        except (Unusable, *FAILURES) as error:
            return self.refuse(message_of(error))
        _current = self._job  # started by the first timer event
        manager = context.window_manager
        manager.progress_begin(0, 100)
        self._timer = manager.event_timer_add(TIMER_SECONDS, window=context.window)
        manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if event.type == "ESC" and event.value == "PRESS":
            self._job.cancel()
            return {"RUNNING_MODAL"}
        if event.type != "TIMER":
            # Looking around is fine. Keys would start undo, deletion or another mode below the running work.
            looking = event.type in {"LEFTMOUSE", "MIDDLEMOUSE", "MOUSEMOVE", "INBETWEEN_MOUSEMOVE", "WHEELUPMOUSE",
                                     "WHEELDOWNMOUSE", "TRACKPADPAN", "TRACKPADZOOM", "NDOF_MOTION", "WINDOW_DEACTIVATE"}
            return {"PASS_THROUGH"} if looking else {"RUNNING_MODAL"}
        if not self._job.started:
            # Not in invoke(): Blender 3.4 crashes when it writes a step of undo while a thread runs Python, and an
            # operator that called this one has got its step by now.
            self._job.start()
        if self._job.running:
            self._show_progress(context)
            return {"PASS_THROUGH"}
        job = self._job
        context.window_manager.progress_update(100 * job.progress())
        self._end(context)
        return self._finish(context, job)

    def cancel(self, context):
        """Blender closes the file or the window: the work must not outlive the operator."""
        self._job.cancel()
        self._job.wait(5)
        self._end(context)

    def _prepared(self, context):
        """Results are written to meshes, which takes object mode."""
        if context.active_object is not None and context.active_object.mode != "OBJECT":
            bpy.ops.object.mode_set(mode="OBJECT")
        return Job(self.prepare(context))

    def report_cancelled(self):
        self.report({"INFO"}, "Cancelled: nothing was changed")

    def refuse(self, message):
        self.report({"ERROR"}, message)
        return {"CANCELLED"}

    def _show_progress(self, context):
        self._ticks += 1
        context.window_manager.progress_update(100 * self._job.progress())
        if self._ticks % _REDRAW_EVERY == 0:
            redraw_sidebars(context)
            if self.shows_progress:
                text = f"{self._job.step_name()}, {100 * self._job.progress():.0f} %      Esc: cancel"
                context.workspace.status_text_set(text)

    def _end(self, context):
        global _current
        _current = None
        context.window_manager.event_timer_remove(self._timer)
        context.window_manager.progress_end()
        if self.shows_progress:
            context.workspace.status_text_set(None)
        redraw_sidebars(context)

    def _finish(self, context, job):
        try:
            if job.cancelled:
                self.report_cancelled()
                return {"CANCELLED"}
            if job.failure:
                return self.refuse(job.failure)
            self.apply(context, job.result)
            return {"FINISHED"}
        except Unusable as error:
            return self.refuse(str(error))
        finally:
            self._job = self._target = None  # Blender keeps the last operators; they need not keep meshes


def redraw_sidebars(context):
    """Only the sidebars: the view itself may hold millions of triangles."""
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                for region in area.regions:
                    if region.type == "UI":
                        region.tag_redraw()


class FOCAL_OT_cancel(bpy.types.Operator):
    """Stop the running work; the scene stays as it was"""
    bl_idname = "focal.cancel"
    bl_label = "Cancel"

    @classmethod
    def poll(cls, context):
        return _current is not None

    def execute(self, context):
        _current.cancel()
        return {"FINISHED"}


def stop():
    """Before the add-on or Blender goes: a thread inside the library must not see it vanish."""
    if _current is not None:
        _current.cancel()
        _current.wait(5)


def register():
    bpy.utils.register_class(FOCAL_OT_cancel)
    bpy.types.WindowManager.focal_progress = bpy.props.FloatProperty(
        name="Progress", subtype="PERCENTAGE", min=0, max=100, precision=0,
        get=lambda _: 100 * _current.progress() if _current else 0.0)
    atexit.register(stop)


def unregister():
    stop()
    atexit.unregister(stop)
    del bpy.types.WindowManager.focal_progress
    bpy.utils.unregister_class(FOCAL_OT_cancel)
