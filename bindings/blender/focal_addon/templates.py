"""Skeleton templates: joints over landmarks, as docs/rigs.md describes the file. Knows nothing of Blender."""
import json
import os

from .json_file import read_json

_FOLDER = os.path.join(os.path.dirname(os.path.abspath(__file__)), "templates")
_PLACES = ("centre", "surface", "between")


class TemplateError(Exception):
    """What is wrong with a template, or that none fits, in words for the user."""


def shipped():
    """{name: path} of the templates that came with the add-on."""
    files = sorted(os.listdir(_FOLDER)) if os.path.isdir(_FOLDER) else []
    return {os.path.splitext(file)[0]: os.path.join(_FOLDER, file) for file in files if file.endswith(".json")}


def read(path):
    template = read_json(path, TemplateError)
    if not isinstance(template, dict) or template.get("format") != "focal-skeleton-template":
        raise TemplateError(f'{path} is no skeleton template: "format": "focal-skeleton-template" is missing')
    if not isinstance(template.get("joints"), list) or not all(isinstance(j, dict) and j.get("name") for j in template["joints"]):
        raise TemplateError(f"{path} has no list of joints with names")
    return template


def place_of(joint):
    """(kind, names): how a joint lies, '' without one."""
    return next(((kind, list(joint[kind])) for kind in _PLACES if joint.get(kind)), ("", []))


def landmarks_of(template):
    """Those that it names, in the order of first appearance."""
    joints = {joint["name"] for joint in template["joints"]}
    found = {}
    for joint in template["joints"]:
        kind, names = place_of(joint)
        for name in names + ([joint["tip"]] if joint.get("tip") else []):
            if kind != "between" or name not in joints or name == joint.get("tip"):
                found[name] = True
    return list(found)


def missing_of(template, landmarks):
    """What it names and the landmarks are not."""
    return [name for name in landmarks_of(template) if name not in landmarks]


def best_for(landmarks):
    """(name, template, missing) of the shipped one of whose landmarks the largest share is there."""
    found = [(name, read(path)) for name, path in shipped().items()]
    rows = [(name, template, missing_of(template, set(landmarks))) for name, template in found]
    return min(rows, key=lambda row: len(row[2]) / len(landmarks_of(row[1])), default=None)


def fits(landmarks):
    """Whether all landmarks of a shipped one are there."""
    best = best_for(landmarks)
    return best is not None and not best[2]


def _some(names):
    return ", ".join(names[:8]) + (" ..." if len(names) > 8 else "")


def text_for(landmarks, own=None):
    """The JSON of the user's own template, or of the shipped one that suits the landmarks; TemplateError names what is lacking."""
    if own is not None:
        missing = missing_of(own, set(landmarks))
        if missing:
            raise TemplateError(f"The joints under Skeleton name landmarks that the model does not know: {_some(missing)}")
        return json.dumps(own)
    best = best_for(landmarks)
    if best is None:
        raise TemplateError("The model has no skeleton, and no template came with the add-on")
    name, template, missing = best
    if missing:
        raise TemplateError(f"The model was not learned from rigged characters and has no skeleton. The template '{name}' lacks the "
                            f"landmarks {_some(missing)}: mark and train them, or name "
                            "joints under Skeleton")
    return json.dumps(template)
