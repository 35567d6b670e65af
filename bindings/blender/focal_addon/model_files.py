"""Where models lie: stock models by name, files beside the .blend file, and those of a file that is not saved yet."""
import filecmp
import os
import shutil

import bpy

from . import engine
from .geometry import Unusable
from .properties import TRAINED_MODEL

_waiting = set()  # models of this file, such as //landmarks.focal, that were trained before it was saved


def model_path(context, must_exist=False):
    """The model's file as the settings say, absolute."""
    raw = context.scene.focal.model_path
    if not raw:
        raise Unusable(f"Name a model file first. {engine.stock_hint()}")
    path = file_of(raw)
    if path is None:
        raise Unusable(f"There is no stock model '{raw}'. {engine.stock_hint()}")
    if must_exist and not os.path.isfile(path):
        raise Unusable(f"There is no model '{path}': train one, or choose another file. {engine.stock_hint()}")
    return path


def file_of(raw):
    """The absolute path of a model as settings and objects name it; None: a stock model that is not there."""
    if is_stock_name(raw):
        found = engine.stock_models().get(raw)
        return None if found is None else str(found)
    if raw.startswith("//") and not bpy.data.filepath:
        return os.path.join(bpy.app.tempdir, raw[2:])  # nothing is saved yet: gone when Blender ends
    return bpy.path.abspath(raw)


def name_of(raw):
    """How an object remembers the model that found its landmarks: beside the .blend file by the way from there, so that a project
    can be moved."""
    folder = os.path.dirname(bpy.data.filepath)
    if is_stock_name(raw) or raw.startswith("//") or not folder:
        return raw
    path = os.path.realpath(bpy.path.abspath(raw))
    inside = os.path.commonpath([path, os.path.realpath(folder)]) == os.path.realpath(folder) if os.path.isabs(path) else False
    return "//" + os.path.relpath(path, os.path.realpath(folder)) if inside else raw


def is_stock_name(raw):
    """A plain word: files have a folder or a suffix."""
    return raw != "" and not any(sign in raw for sign in "/\\.")


def path_to_train(context):
    """The file that training writes; a stock model is never written over."""
    settings = context.scene.focal
    settings.model_path = TRAINED_MODEL if is_stock_name(settings.model_path) else name_of(settings.model_path)
    if settings.model_path.startswith("//") and not bpy.data.filepath:
        _waiting.add(settings.model_path)
    return model_path(context)


@bpy.app.handlers.persistent
def _take_along(*_):
    """A model that was trained before the file had a place goes to where the file was saved."""
    for raw in sorted(_waiting):
        file = os.path.join(bpy.app.tempdir, raw[2:])
        _waiting.discard(raw)
        if not os.path.isfile(file):
            continue
        try:
            _rename(raw, _moved(file, raw))
        except OSError as error:
            print(f"focal: the model stays in {file}: {error}")


def _moved(file, raw):
    """What the model is called beside the saved file; another model that is there already is not written over."""
    stem, suffix = os.path.splitext(raw)
    number, name = 1, raw
    while os.path.exists(bpy.path.abspath(name)) and not filecmp.cmp(file, bpy.path.abspath(name), shallow=False):
        number += 1
        name = f"{stem}-{number}{suffix}"
    os.makedirs(os.path.dirname(bpy.path.abspath(name)), exist_ok=True)
    shutil.move(file, bpy.path.abspath(name))
    return name


def _rename(old, new):
    if new == old:
        return
    print(f"focal: there is another {old}: the model is called {new} now; save the file once more")
    for scene in bpy.data.scenes:
        if scene.focal.model_path == old:
            scene.focal.model_path = new
    for obj in bpy.data.objects:
        if obj.focal.model == old:
            obj.focal.model = new


@bpy.app.handlers.persistent
def _forget(*_):
    _waiting.clear()


def register():
    bpy.app.handlers.save_post.append(_take_along)
    bpy.app.handlers.load_post.append(_forget)


def unregister():
    bpy.app.handlers.load_post.remove(_forget)
    bpy.app.handlers.save_post.remove(_take_along)
