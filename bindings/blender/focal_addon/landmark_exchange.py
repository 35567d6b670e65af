"""Landmark files in and out: focal's own, and what an imported glTF file holds."""
import os

import bpy
from bpy.props import StringProperty
from bpy_extras.io_utils import ExportHelper, ImportHelper
from mathutils import Vector

from . import landmark_data, landmark_file
from .geometry import FROM_GLTF, TO_GLTF, Surface, Unusable, remember_character
from .landmark_data import ensure, place_near
from .landmark_edit import LandmarkOperator

_GROUP = "focal_landmarks"  # the node in a glTF file that holds a node for each landmark
_STATUS = {"found": "FOUND", "uncertain": "UNCERTAIN", "absent": "ABSENT"}  # any other was set by hand


class FOCAL_OT_landmark_import(LandmarkOperator, bpy.types.Operator, ImportHelper):
    """Read a landmark file of focal for the active mesh"""
    bl_idname = "focal.landmark_import"
    bl_label = "Import Landmarks"

    filename_ext = ".json"
    filter_glob: StringProperty(default="*.json", options={"HIDDEN"})

    def change(self, context, obj):
        marks = landmark_file.read(self.filepath)
        surface = Surface(obj)
        to_local = obj.matrix_world.inverted() @ FROM_GLTF
        worst = 0.0
        for entry in marks:
            mark = ensure(obj, entry["name"])
            if entry.get("status") == "absent":
                landmark_data.unplace(mark, "ABSENT")
                continue
            status = _STATUS.get(entry.get("status"), "MARKED")
            position = _local_place(entry, surface, to_local)
            worst = max(worst, place_near(obj, mark, surface, position, status))
            mark.confidence = entry.get("confidence", 1.0)
        if worst > 0.02 * surface.size():
            self.report({"WARNING"}, f"Some landmarks were {worst:.3g} away from the surface: is it their mesh?")
        else:
            self.report({"INFO"}, f"{len(marks)} landmarks")


class FOCAL_OT_landmark_export(LandmarkOperator, bpy.types.Operator, ExportHelper):
    """Write the landmarks of the active mesh to a file that focal reads"""
    bl_idname = "focal.landmark_export"
    bl_label = "Export Landmarks"
    bl_options = {"REGISTER"}

    filename_ext = ".landmarks.json"
    filter_glob: StringProperty(default="*.json", options={"HIDDEN"})

    def change(self, context, obj):
        surface = Surface(obj)
        landmark_data.snap_stale(obj, surface)
        to_file = TO_GLTF @ obj.matrix_world
        entries = [_entry_of(mark, surface, to_file) for mark in obj.focal.landmarks if mark.status != "UNPLACED"]
        if not entries:
            raise Unusable(f"'{obj.name}' has no landmarks")
        landmark_file.write(self.filepath, obj.name + ".glb", entries)
        self.report({"INFO"}, f"{len(entries)} landmarks in {os.path.basename(self.filepath)}")


def _local_place(entry, surface, to_local):
    """Positions come first: numbers of triangles hold only for a mesh whose triangles are in the file's order."""
    if "position" in entry:
        return to_local @ Vector(entry["position"])
    if "triangle" in entry and entry["triangle"] < len(surface.triangles):
        return surface.at(entry["triangle"], entry["barycentric"])
    if "vertex" in entry and entry["vertex"] < len(surface.local):
        return Vector(surface.local[entry["vertex"]])
    raise Unusable(f"Landmark '{entry['name']}' lies on a triangle or vertex that '{surface.name}' does not have")


def _entry_of(mark, surface, to_file):
    entry = {"name": mark.name}
    status = {"FOUND": "found", "UNCERTAIN": "uncertain", "ABSENT": "absent"}.get(mark.status)
    if status:
        entry["status"] = status
        entry["confidence"] = round(mark.confidence, 6)
    if mark.placed:
        entry["triangle"] = mark.triangle
        entry["barycentric"] = [round(w, 7) for w in surface.turned(mark.barycentric)]
        entry["position"] = [round(x, 7) for x in to_file @ Vector(mark.position)]
    return entry


class SettingsStay:
    """What Blender's glTF exporter calls: with its option for custom properties it would write the add-on's own lists and settings as
    extras.focal of nodes, which has another meaning in focal's files."""

    def gather_node_hook(self, node, _obj, _settings):
        _drop(node)

    def gather_scene_hook(self, scene, _blender_scene, _settings):
        _drop(scene)


def _drop(element):
    if isinstance(element.extras, dict):
        element.extras.pop("focal", None)


class LandmarksOfFile:
    """What Blender's glTF importer calls when it has made the objects: extras.focal of the meshes becomes their lists again, and the nodes
    that show the landmarks to other programs are not kept beside them."""

    def gather_import_scene_after_animation_hook(self, _scene, _blender_scene, gltf):
        bpy.context.view_layer.update()
        places = _places(gltf)
        objects = []
        for vnode in gltf.vnodes.values():
            entries = _entries(gltf, vnode)
            if entries:
                objects.append(vnode.blender_object)
                _write_list(objects[-1], entries, places)
        if objects:
            remember_character(objects)
            _remove_nodes(gltf)


def _entries(gltf, vnode):
    """The landmarks that the file has for a mesh, or None."""
    obj = getattr(vnode, "blender_object", None)
    if getattr(vnode, "mesh_node_idx", None) is None or not isinstance(obj, bpy.types.Object) or obj.type != "MESH":
        return None
    extras = gltf.data.meshes[gltf.data.nodes[vnode.mesh_node_idx].mesh].extras
    focal = extras.get("focal") if isinstance(extras, dict) else None
    entries = focal.get("landmarks") if isinstance(focal, dict) else None
    return [e for e in entries if isinstance(e, dict) and isinstance(e.get("name"), str)] if isinstance(entries, list) else None


def _group(gltf):
    """Number of the landmarks' node, or None."""
    return next((i for i, node in enumerate(gltf.data.nodes or ()) if node.name == _GROUP), None)


def _places(gltf):
    """{landmark: place in the scene}"""
    group = _group(gltf)
    children = [gltf.data.nodes[i] for i in gltf.data.nodes[group].children or ()] if group is not None else ()
    return {node.name: FROM_GLTF @ Vector(node.translation) for node in children if node.translation}


def _write_list(obj, entries, places):
    surface, to_local = Surface(obj), obj.matrix_world.inverted()
    for entry in entries:
        mark, status = ensure(obj, entry["name"]), _STATUS.get(entry.get("status"), "MARKED")
        confidence = entry.get("confidence")
        if status == "ABSENT":
            landmark_data.unplace(mark, "ABSENT")
        elif entry["name"] in places:
            place_near(obj, mark, surface, to_local @ places[entry["name"]], status)
        if isinstance(confidence, (int, float)):
            mark.confidence = confidence


def _remove_nodes(gltf):
    group = _group(gltf)
    if group is None:
        return
    for number in (*(gltf.data.nodes[group].children or ()), group):
        vnode = gltf.vnodes.get(number)
        obj = getattr(vnode, "blender_object", None)
        if isinstance(obj, bpy.types.Object) and obj.type == "EMPTY":
            vnode.type = None  # else the importer would select it
            bpy.data.objects.remove(obj)


CLASSES = (FOCAL_OT_landmark_import, FOCAL_OT_landmark_export)


register, unregister = bpy.utils.register_classes_factory(CLASSES)
