"""How calls are run."""
from __future__ import annotations

import ctypes
import functools
import itertools
import os
import pathlib
import threading
from typing import Any, Callable

from . import _abi
from ._handle import Handle
from ._library import create, library
from ._values import fill, new, path_text

_numbers = itertools.count(1)
_logs: dict[int, Callable[[_abi.LogLevel, str], Any]] = {}
_lock = threading.Lock()
_default: Context | None = None


@functools.lru_cache(maxsize=None)
def _forward() -> Any:
    """One callback for all contexts: it lives for ever, so none is ever called after its end."""
    def forward(number: int, level: int, message: bytes) -> None:
        log = _logs.get(number)
        if log:
            log(_abi.LogLevel(level), message.decode("utf-8", "replace"))
    return _abi.focal_log_fn(forward)


class Context(Handle):
    """How calls are run: threads and log. Without one, calls share a context with the defaults.

    thread_count  threads that one call may use, 0..1024; None or 0: one a core. Results are the same for any number
    backend       focal.Backend or its name: "auto", "cpu", "cuda"
    device_index  of the GPU, from 0
    memory_budget_bytes  calls fail with Status.OUT_OF_MEMORY instead of letting the library hold more than this in the process;
                  None or 0: no budget
    models_folder  a folder of your own stock models, searched before the others (see focal.stock_models)
    log           log(level: focal.LogLevel, message: str), called while a focal call runs, on the thread that runs it,
                  which may not be the one that made the call. It must not raise
    """

    _kind = "context"
    _number = 0

    def __init__(self, *, thread_count: int | None = None, backend: _abi.Backend | str | None = None,
                 device_index: int | None = None, memory_budget_bytes: int | None = None,
                 models_folder: str | os.PathLike[str] | None = None,
                 log: Callable[[_abi.LogLevel, str], Any] | None = None) -> None:
        params = fill(new(_abi.focal_context_params), thread_count=thread_count, backend=backend,
                      device_index=device_index, memory_budget_bytes=memory_budget_bytes)
        if models_folder is not None:
            params.models_folder = path_text(models_folder)
        if log is not None:
            if not callable(log):
                raise TypeError(f"log must be callable, not {type(log).__name__}")
            self._number = next(_numbers)
            _logs[self._number] = log
            params.log = _forward()
            params.log_user_data = self._number
        self._take(create("focal_context_create", _abi.focal_context, ctypes.byref(params)))

    def close(self) -> None:
        super().close()
        _logs.pop(self._number, None)

    def _facts(self) -> str:
        return f"{self.backend.name.lower()}, {self.thread_count} threads"

    @property
    def backend(self) -> _abi.Backend:
        """The backend in use, never AUTO."""
        return _abi.Backend(library().focal_context_backend(self._handle))

    @property
    def backend_reason(self) -> str:
        """Why it was chosen, in one sentence."""
        with self._borrow() as handle:
            return str(library().focal_context_backend_reason(handle).decode("utf-8", "replace"))

    @property
    def thread_count(self) -> int:
        """The number of threads that a call may use."""
        return int(library().focal_context_thread_count(self._handle))

    @property
    def memory_held(self) -> int:
        """Bytes that the library holds in this process now, for all contexts together."""
        return int(library().focal_context_memory_held(self._handle))

    @property
    def stock_models(self) -> dict[str, pathlib.Path]:
        """The stock models of this installation, by name, with their files. See Model.load_stock."""
        with self._borrow() as handle:
            found = range(library().focal_context_stock_count(handle))
            return {library().focal_context_stock_name(handle, i).decode("utf-8"):
                    pathlib.Path(os.fsdecode(library().focal_context_stock_path(handle, i))) for i in found}


def context_or_default(context: Context | None) -> Context:
    global _default
    if context is None:
        with _lock:
            if _default is None:
                _default = Context()
            return _default
    if not isinstance(context, Context):
        raise TypeError(f"context must be a focal.Context, not {type(context).__name__}")
    return context


def stock_models(context: Context | None = None) -> dict[str, pathlib.Path]:
    """The stock models of this installation, by name, with their files: what Model.load_stock takes."""
    return context_or_default(context).stock_models
