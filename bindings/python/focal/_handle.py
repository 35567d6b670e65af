"""The base class of all objects that hold a handle of focal."""
from __future__ import annotations

import contextlib
import threading
from typing import Any, Iterator, TypeVar

from ._abi import Status
from ._errors import Error
from ._library import call, last_error, library

Made = TypeVar("Made", bound="Handle")


class Handle:
    """An object of the library. close() frees it; so does leaving a `with` block, or the last reference to it.

    Objects may be closed in any order: a result keeps what it needs. Any use of a closed one raises Error with
    Status.INVALID_HANDLE. Any number of threads may use one at once unless its class says otherwise.
    """

    _kind = ""              # focal_KIND
    _pointer: Any = None    # None: closed, or never made
    _context: Any = None    # the Context that it runs in stays open as long as it
    _borrowing: Any = None  # held while memory of the library is read, and to close

    @classmethod
    def _adopt(cls: type[Made], pointer: Any, context: Any = None) -> Made:
        self = cls.__new__(cls)
        self._take(pointer, context)
        return self

    def _take(self, pointer: Any, context: Any = None) -> None:
        self._borrowing = threading.RLock()
        self._context = context
        self._pointer = pointer

    @property
    def _handle(self) -> Any:
        pointer = self._pointer or self._made_now()
        if pointer is None:
            name = type(self).__name__
            raise Error(Status.INVALID_HANDLE, f"the {name} has been closed",
                        f"keep the {name} open until the last call that uses it")
        return pointer

    def _made_now(self) -> Any:
        """The handle of one that is made when it is first needed."""
        return None

    @contextlib.contextmanager
    def _borrow(self) -> Iterator[Any]:
        """The handle, which no other thread closes meanwhile."""
        with self._borrowing or contextlib.nullcontext():
            yield self._handle

    def _texts(self, getter: str, count: int) -> list[str]:
        with self._borrow() as handle:
            found = [getattr(library(), getter)(handle, i) for i in range(count)]
        if None in found:
            raise last_error(Status.INVALID_ARGUMENT)
        return [one.decode("utf-8", "replace") for one in found]

    @property
    def closed(self) -> bool:
        """Whether close() has been called."""
        return self._pointer is None

    def close(self) -> None:
        """Frees the object; closing twice is allowed. A call that another thread runs on it still completes."""
        if self._pointer is None:
            return
        with self._borrowing:
            pointer, self._pointer = self._pointer, None
        if pointer is not None:
            call(f"focal_{self._kind}_destroy", pointer)

    def __enter__(self: Made) -> Made:
        self._handle
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __del__(self) -> None:
        with contextlib.suppress(Exception):  # at the end of the process modules may be gone
            self.close()

    def __reduce__(self) -> tuple[Any, ...]:
        raise TypeError(f"a focal.{type(self).__name__} cannot be copied or pickled")

    def _facts(self) -> str:
        """What the repr of the object shows."""
        return ""

    def __repr__(self) -> str:
        facts = "closed" if self.closed else self._facts()
        return f"<focal.{type(self).__name__}{' ' + facts if facts else ''}>"


def handle_of(value: Any, kind: type[Handle], name: str) -> Any:
    """The handle of an argument, which must be a `kind`."""
    if not isinstance(value, kind):
        raise TypeError(f"{name} must be a focal.{kind.__name__}, not {type(value).__name__}")
    return value._handle
