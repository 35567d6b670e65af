"""Exceptions."""
from __future__ import annotations

from typing import Any

from ._abi import Status


class Error(Exception):
    """A call of focal failed.

    code     a focal.Status, such as Status.INVALID_MESH
    message  what went wrong, naming the object
    hint     what to do about it
    """

    def __init__(self, code: int, message: str, hint: str = "") -> None:
        super().__init__(f"{message}\nhint: {hint}" if hint else message)
        self.code = Status(code) if code in list(Status) else code  # a newer library may have codes of its own
        self.message = message
        self.hint = hint

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.code, self.message, self.hint)


class Cancelled(Error):
    """The call's Task was cancelled."""


class LibraryError(ImportError):
    """focal's shared library is missing, cannot be loaded, or is of another version than this package."""


def error_of(code: int, text: str) -> Error:
    """The exception for a status and the text of focal_last_error ("message\\nhint: ...")."""
    message, _, hint = text.partition("\nhint: ")
    return (Cancelled if code == Status.CANCELLED else Error)(code, message, hint)
