"""Finds and loads the shared library, and calls it.

Searched, in this order: the file that the environment variable FOCAL_LIBRARY names; the package's own folder and its
lib/; the folder that holds the package; the system's libraries. The first existing file is used. It is loaded
at the first call that needs it and never unloaded.
"""
from __future__ import annotations

import ctypes
import ctypes.util
import os
import pathlib
import sys
import threading
from typing import Any

from . import _abi
from ._errors import LibraryError, error_of

VERSION = (_abi.FOCAL_VERSION_MAJOR, _abi.FOCAL_VERSION_MINOR, _abi.FOCAL_VERSION_PATCH)

_lock = threading.RLock()
_loaded: tuple[ctypes.CDLL, str] | None = None


def file_names() -> list[str]:
    """What the library is called on this system."""
    if sys.platform == "win32":
        return ["focal.dll"]
    if sys.platform == "darwin":
        return [f"libfocal.{VERSION[0]}.{VERSION[1]}.dylib", "libfocal.dylib"]
    return [f"libfocal.so.{VERSION[0]}.{VERSION[1]}", "libfocal.so"]


def _find() -> str:
    named = os.environ.get("FOCAL_LIBRARY")
    if named:
        if not os.path.isfile(named):
            raise LibraryError(f"FOCAL_LIBRARY names {named!r}, which is not a file.\n"
                               "Set it to the full path of focal's shared library, or unset it.")
        return named
    package = pathlib.Path(__file__).resolve().parent
    for folder in (package / "lib", package, package.parent):
        for name in file_names():
            if (folder / name).is_file():
                return str(folder / name)
    found = ctypes.util.find_library("focal")
    if found:
        return found
    raise LibraryError(
        f"focal's shared library ({file_names()[0]}) was not found.\n"
        f"Searched: FOCAL_LIBRARY (not set), {package / 'lib'}, {package}, {package.parent}, the system's "
        "libraries.\n"
        "Build the package with its library (cmake --build build/release --target focal_python_package), install "
        "focal, or set FOCAL_LIBRARY to the full path of the library.")


def _check_version(library: ctypes.CDLL, path: str) -> None:
    try:
        library.focal_version.restype = ctypes.c_uint32
        number = library.focal_version()
    except AttributeError:
        raise LibraryError(f"{path} is not focal's shared library: it has no focal_version.") from None
    found = (number >> 16, number >> 8 & 0xFF, number & 0xFF)
    # Before 1.0 each minor version may change the ABI.
    same = found[0] == VERSION[0] and (VERSION[0] > 0 or found[1] == VERSION[1])
    if not same:
        raise LibraryError(f"{path} is focal {'.'.join(map(str, found))}, this package is for "
                           f"{'.'.join(map(str, VERSION))}.\nUse the library that came with the package, or the "
                           "package of the library's version.")


def _open(path: str) -> ctypes.CDLL:
    try:
        library = ctypes.CDLL(path)
    except OSError as error:
        raise LibraryError(f"focal's shared library {path} cannot be loaded: {error}\n"
                           "Is it for this system and processor, and are the libraries beside it there?") from error
    _check_version(library, path)
    for name, (result, arguments) in _abi.FUNCTIONS.items():
        try:
            function = getattr(library, name)
        except AttributeError:
            raise LibraryError(f"{path} has no {name}: it is older than this package.\n"
                               "Use the library that came with the package.") from None
        function.restype, function.argtypes = result, arguments
    return library


def load_library(path: str | os.PathLike[str] | None = None) -> str:
    """Loads focal's shared library now and returns its path.

    path: the library's file; None: search (see the head of this module). Every other call does this automatically when
    the library is first needed. Raises LibraryError when the library is missing, damaged or of another version, and when
    a library other than `path` is already loaded.
    """
    global _loaded
    with _lock:
        wanted = os.fsdecode(path) if path is not None else None
        if _loaded is None:
            found = wanted or _find()
            _loaded = _open(found), found
        elif wanted and os.path.realpath(wanted) != os.path.realpath(_loaded[1]):
            raise LibraryError(f"{_loaded[1]} is loaded already: one process uses one library.")
        return _loaded[1]


def library() -> ctypes.CDLL:
    if _loaded is None:
        load_library()
    return _loaded[0]  # type: ignore[index]


def last_error(code: int) -> Exception:
    return error_of(code, library().focal_last_error().decode("utf-8", "replace"))


def call(name: str, *arguments: Any) -> None:
    """Calls a function that returns focal_status; raises Error."""
    code = getattr(library(), name)(*arguments)
    if code:
        raise last_error(code)


def create(name: str, kind: type[ctypes.Structure], *arguments: Any) -> Any:
    """Calls a function whose last argument receives a handle; returns the handle."""
    out: Any = ctypes.POINTER(kind)()
    call(name, *arguments, ctypes.byref(out))
    return out


def descriptors() -> list[str]:
    """The names of the descriptors that Model.train can choose from, in the order of focal.Descriptor."""
    return [library().focal_descriptor_name(i).decode() for i in range(library().focal_descriptor_count())]


def distances() -> list[str]:
    """The names of the distances that Model.train can choose from, in the order of focal.Distance."""
    return [library().focal_distance_name(i).decode() for i in range(library().focal_distance_count())]


def version() -> str:
    """The version of the loaded library, such as "0.1.0"."""
    return str(library().focal_version_string().decode())


def peak_memory_bytes() -> int:
    """The largest resident memory of this process so far, in bytes; 0 if the system does not report it."""
    return int(library().focal_peak_memory_bytes())
