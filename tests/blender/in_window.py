"""What the tests in a window share: where the view is, operators called there, keys and clicks."""
import sys
import time

import bpy

from common import MODULE, check

OTHER = "humanoid_03"


def view():
    """The window's largest area, which is the 3D view."""
    window = bpy.context.window_manager.windows[0]
    area = max(window.screen.areas, key=lambda a: a.width * a.height)
    region = next(r for r in area.regions if r.type == "WINDOW")
    return {"window": window, "area": area, "region": region}


def call(operator, *arguments, **options):
    with bpy.context.temp_override(**view()):
        return operator(*arguments, **options)


def jobs():
    return sys.modules[MODULE + ".jobs"]


def wait_for_job(seconds):
    end = time.perf_counter() + seconds
    while jobs().current() is not None:
        check(time.perf_counter() < end, "the work ends in time")
        yield 0.005


def press(where, kind):
    """A key or button, pressed and released in the middle of the view."""
    x, y = (where["region"].x + where["region"].width // 2, where["region"].y + where["region"].height // 2)
    for value in ("PRESS", "RELEASE"):
        where["window"].event_simulate(type=kind, value=value, x=x, y=y)
        yield 0.1
