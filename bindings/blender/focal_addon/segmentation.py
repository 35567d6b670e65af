"""The parts of a mesh: vertex groups, a face attribute, colours."""
import bpy
import numpy

from . import display, vote_map
from .detection import Target, model_of
from .geometry import character_of
from .jobs import JobOperator

ATTRIBUTE = "focal part"


class FOCAL_OT_segment(JobOperator, bpy.types.Operator):
    """Divide the active mesh into parts under the model's names. Esc cancels"""
    bl_idname = "focal.segment"
    bl_label = "Segment"
    bl_options = {"REGISTER", "UNDO"}

    def prepare(self, context):
        self._target = Target(context, character_of(context, context.active_object))
        method = context.scene.focal.segmentation.lower()

        def work(job):
            detection = self._target.detect(job, 0.0, 0.7)
            labels = detection.segment(method, task=job.begin("segmenting", 0.7, 1.0))
            model = model_of(self._target)
            by_joint = method == "skeleton" or (method == "auto" and model.joint_names)
            return labels, model.joint_names if by_joint else model.landmark_names
        return work

    def apply(self, context, result):
        objects, character = self._target.objects(), self._target.character
        self._target.remember()
        labels, names = result
        for number, obj in enumerate(objects):
            own = labels[character.triangles_of(number)]
            _write(context, obj, _of_faces(obj.data, own), names)
        self.report({"INFO"}, f"{len(numpy.unique(labels[labels >= 0]))} parts")


def _write(context, obj, faces, names):
    settings = context.scene.focal
    write_attribute(obj.data, faces)
    if settings.parts_as_groups:
        write_groups(obj, faces, names)
    if settings.parts_as_colours:
        corners = numpy.repeat(faces, _corner_counts(obj.data))
        display.write_colours(obj.data, display.PARTS, "CORNER", display.part_colours(corners))
        vote_map.hide(obj)
        display.show_colours(context)


def _of_faces(mesh, labels):
    """Labels of triangles to their polygons; the last triangle of each decides."""
    polygons = numpy.empty(len(labels), dtype=numpy.int32)
    mesh.loop_triangles.foreach_get("polygon_index", polygons)
    faces = numpy.full(len(mesh.polygons), -1, dtype=numpy.int32)
    faces[polygons] = labels
    return faces


def _corner_counts(mesh):
    counts = numpy.empty(len(mesh.polygons), dtype=numpy.int32)
    mesh.polygons.foreach_get("loop_total", counts)
    return counts


def write_attribute(mesh, faces):
    attribute = mesh.attributes.get(ATTRIBUTE)
    if attribute is not None and (attribute.domain != "FACE" or attribute.data_type != "INT"):
        mesh.attributes.remove(attribute)
        attribute = None
    if attribute is None:
        attribute = mesh.attributes.new(ATTRIBUTE, "INT", "FACE")
    attribute.data.foreach_set("value", faces)
    mesh.update()


def write_groups(obj, faces, names):
    """A group a part, of all vertices of its faces. The prefix keeps them apart from a rig's weights."""
    mesh = obj.data
    corners = numpy.empty(len(mesh.loops), dtype=numpy.int32)
    mesh.loops.foreach_get("vertex_index", corners)
    labels = numpy.repeat(faces, _corner_counts(mesh))
    for group in [g for g in obj.vertex_groups if g.name.startswith("part ")]:
        obj.vertex_groups.remove(group)
    for label in numpy.unique(faces[faces >= 0]):
        group = obj.vertex_groups.new(name=f"part {names[label]}")
        group.add(numpy.unique(corners[labels == label]).tolist(), 1.0, "REPLACE")


def register():
    bpy.utils.register_class(FOCAL_OT_segment)


def unregister():
    bpy.utils.unregister_class(FOCAL_OT_segment)
