"""Progress and cancellation of long calls."""
from __future__ import annotations

import threading
from typing import Any, Callable, TypeVar, cast

from . import _abi
from ._handle import Handle
from ._library import call, create, library

Result = TypeVar("Result")
Progress = Callable[[float, str], Any]

POLL_SECONDS = 0.05


class Task(Handle):
    """Pass one to a long call (task=...), then poll or cancel it from any thread.

    It serves one call at a time; a second one meanwhile raises Error with Status.INVALID_ARGUMENT. A cancelled task
    stays cancelled until reset(), so a cancel just before the call starts is not lost.
    """

    _kind = "task"

    def __init__(self) -> None:
        self._take(create("focal_task_create", _abi.focal_task))

    def _facts(self) -> str:
        return "cancelled" if self.cancelled else f"{self.progress:.0%} {self.stage}".rstrip()

    def cancel(self) -> None:
        """The call that runs with it raises Cancelled within about 0.1 s."""
        call("focal_task_cancel", self._handle)

    def reset(self) -> None:
        """Resets to progress 0 and not cancelled. Error with Status.INVALID_ARGUMENT while a call runs with it."""
        call("focal_task_reset", self._handle)

    @property
    def progress(self) -> float:
        """0..1; never falls during a call."""
        return float(library().focal_task_progress(self._handle))

    @property
    def stage(self) -> str:
        """The current stage: "spectrum", ...; "" before the start."""
        return (library().focal_task_stage(self._handle) or b"").decode()

    @property
    def cancelled(self) -> bool:
        """Whether cancel() was called since it was made or reset."""
        return bool(library().focal_task_is_cancelled(self._handle))


def run(work: Callable[[Any], Result], task: Task | None, on_progress: Progress | None) -> Result:
    """Runs work(task handle), a long call, reports progress and responds to Ctrl-C.

    Python runs neither callbacks nor signal handlers inside a C call. So on the main thread, or when progress is to be
    reported, the call runs on a separate thread while this one waits.
    """
    if task is not None and not isinstance(task, Task):
        raise TypeError(f"task must be a focal.Task, not {type(task).__name__}")
    if on_progress is not None and not callable(on_progress):
        raise TypeError(f"on_progress must be callable, not {type(on_progress).__name__}")
    used = Task() if task is None else task
    try:
        if on_progress is None and threading.current_thread() is not threading.main_thread():
            return work(used._handle)
        return cast(Result, _Watched(work, used).wait(on_progress))
    finally:
        if task is None:
            used.close()


class _Watched:
    def __init__(self, work: Callable[[Any], Any], task: Task) -> None:
        self._task = task
        self._result: Any = None
        self._error: BaseException | None = None
        self._done = threading.Event()
        self._thread = threading.Thread(target=self._run, args=(work, task._handle), name="focal call")
        self._thread.start()

    def _run(self, work: Callable[[Any], Any], handle: Any) -> None:
        try:
            self._result = work(handle)
        except BaseException as error:  # pylint: disable=broad-except
            self._error = error
        finally:
            self._done.set()

    def wait(self, on_progress: Progress | None) -> Any:
        try:
            self._watch(on_progress or (lambda progress, stage: None))
        except BaseException:  # from on_progress, or Ctrl-C: nobody will fetch the result
            self._task.cancel()
            self._thread.join()
            raise
        error, self._error = self._error, None
        try:
            if error is not None:
                raise error
        finally:
            del error  # its traceback holds this frame
        return self._result

    def _watch(self, report: Progress) -> None:
        reported = None
        while not self._done.wait(POLL_SECONDS):
            state = self._task.progress, self._task.stage
            if state != reported:
                report(*state)
                reported = state
        self._thread.join()
        if self._error is None:
            report(1.0, self._task.stage)
