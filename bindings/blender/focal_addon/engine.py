"""The focal package inside the add-on: its library found and loaded once, its context as the preferences say."""
import functools
import os
import platform

import bpy

from . import focal as _package

# The library stays loaded as long as Blender runs, also when the add-on is switched off and on again.
_problem = ""
_loaded_from = None


def package():
    """The package, in any thread; what started the thread has called focal()."""
    return _package


def focal():
    """The package, in the main thread; EngineMissing when its library cannot be used."""
    if not ready():
        raise EngineMissing(_problem)
    return _package


class EngineMissing(Exception):
    """Why there is no library, in words for the user."""


# What work may fail with for reasons outside of the add-on.
FAILURES = (EngineMissing, _package.Error, _package.LibraryError, OSError, ValueError)


def message_of(error):
    """For operator reports: one line, the hint as a second sentence."""
    hint = getattr(error, "hint", "")
    text = getattr(error, "message", "") or str(error)
    return f"{text.rstrip('.')}. {hint[:1].upper()}{hint[1:]}" if hint else text


def ready():
    """Whether the library is loaded; tries to when it is not."""
    global _problem, _loaded_from
    if _loaded_from is None:
        try:
            _loaded_from = _package.load_library(_wanted_path())
            _problem = ""
        except _package.LibraryError as error:
            _problem = _explained(str(error))
    return _loaded_from is not None


def waits_for_restart():
    """Whether the preferences name another library than the one that runs."""
    wanted = _wanted_path()
    return bool(_loaded_from and wanted and os.path.realpath(wanted) != os.path.realpath(_loaded_from))


def problem():
    """Why not ready, '' when it is; found by the last call of ready()."""
    return _problem


def stock_models():
    """{name: path} of the models that came with the add-on, or lie where focal looks for them."""
    return context().stock_models


def stock_hint():
    """Which there are, as a sentence."""
    names = sorted(stock_models())
    if not names:
        return "No stock model is installed: this zip was made without them"
    return f"Stock models: {', '.join(names)}"


def version():
    return _package.version()


def _wanted_path():
    path = bpy.path.abspath(preferences().library_path)
    return path if path else None


def preferences():
    return bpy.context.preferences.addons[__package__].preferences


def _explained(text):
    """The package's message is for programmers: say what to do in Blender."""
    first = text.split("\n")[0]
    return f"{first}\n{library_advice(text, _wanted_path(), os.environ.get('FOCAL_LIBRARY'))}"


def library_advice(text, chosen, named):
    """What helps against a message of the package. chosen: the path in the preferences; named: that of FOCAL_LIBRARY."""
    if chosen:
        return "The add-on's preferences name this library: correct the path there, or empty it for the one that came with the add-on."
    if named:
        return "The environment variable FOCAL_LIBRARY names this library: unset it for the one that came with the add-on."
    if "GLIBC" in text:
        return "This system is older than those that the zip is built for (Debian 12, Ubuntu 24.04): update it, or build focal here."
    if "cannot open shared object file" in text:
        return "A library that focal needs is missing, or the installation is damaged: install the zip again."
    if "is focal " in text or "older than this package" in text or "no focal_version" in text:
        return "Parts of another version are left: remove the add-on, restart Blender, and install the zip again."
    return f"This zip may be for another system: install focal_addon-{_platform()}.zip."


def _platform():
    system = {"Linux": "linux", "Windows": "windows", "Darwin": "macos"}.get(platform.system(), platform.system())
    machine = {"x86_64": "x64", "AMD64": "x64", "aarch64": "arm64", "arm64": "arm64"}.get(
        platform.machine(), platform.machine())
    return f"{system}-{machine}"


def threads():
    """One processor is left to Blender unless the preferences say otherwise."""
    return preferences().threads or max(1, (os.cpu_count() or 2) - 1)


@functools.lru_cache(maxsize=4)
def _context(thread_count, backend):
    return _package.Context(thread_count=thread_count, backend=backend)


def context():
    """How calls run now. Read it in the main thread, use it in any."""
    focal()
    return _context(threads(), preferences().backend.lower())
