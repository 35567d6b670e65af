"""Joints over the landmarks that a user chose: a skeleton for models of marks, edited in a list or by dragging bones."""
import itertools
import json

import bpy
import numpy
from bpy.props import BoolProperty, EnumProperty, StringProperty
from bpy_extras.io_utils import ExportHelper
from mathutils import Vector

from . import names, templates
from .geometry import Surface, Unusable
from .gltf import Selection
from .landmark_edit import LandmarkOperator
from .templates import TemplateError

PREVIEW = "focal_template"  # a property of the armature that shows the joints


def as_template(settings):
    """The list as a template; None while it is empty."""
    if not settings.joints:
        return None
    return {"format": "focal-skeleton-template", "version": 1, "symmetric": settings.symmetric,
            "joints": [_as_row(joint) for joint in _parents_first(settings.joints)]}


def _as_row(joint):
    row = {"name": joint.name, joint.kind.lower(): [place.name for place in joint.places]}
    if joint.kind == "BETWEEN":
        row["share"] = round(joint.share, 4)
    for key in ("parent", "tip"):
        if getattr(joint, key):
            row[key] = getattr(joint, key)
    return row


def _parents_first(joints):
    left, done, known = list(joints), [], set()
    while left:
        ready = [joint for joint in left if not joint.parent or joint.parent in known]
        if not ready:
            raise Unusable(f"The parent of '{left[0].name}', '{left[0].parent}', is not a joint above it")
        done += ready
        known.update(joint.name for joint in ready)
        left = [joint for joint in left if joint.name not in known]
    return done


def put(joints, row):
    """A row of a template into the list."""
    kind, places = templates.place_of(row)
    joint = joints.get(row["name"]) or joints.add()
    joint.name, joint.parent, joint.tip = row["name"], row.get("parent", ""), row.get("tip", "")
    joint.kind, joint.share = kind.upper(), row.get("share", 0.5)
    joint.places.clear()
    for name in places:
        joint.places.add().name = name
    return joint


class JointOperator(LandmarkOperator):
    """change() as for landmarks; templates have messages of their own."""

    def execute(self, context):
        try:
            return super().execute(context)
        except (TemplateError, OSError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}


class FOCAL_OT_joint_add(JointOperator, bpy.types.Operator):
    """Make a joint from the chosen landmarks, as a child of the active joint. One landmark: in the middle of the limb below it; two:
between them; more: at their centre"""
    bl_idname = "focal.joint_add"
    bl_label = "Joint from Landmarks"

    def change(self, context, obj):
        joints = context.scene.focal.joints
        chosen = [mark for mark in obj.focal.landmarks if mark.chosen]
        if not chosen:
            raise Unusable("Choose one landmark or several first: tick them in the list above")
        parent = _active(context.scene.focal)
        kind = "centre" if len(chosen) == 1 else "between" if len(chosen) == 2 else "surface"
        taken = {joint.name for joint in joints} | {mark.name for mark in obj.focal.landmarks}
        put(joints, {"name": names.free_name("joint", taken), "parent": parent.name if parent else "",
                     kind: [mark.name for mark in chosen]})
        context.scene.focal.joint_active = len(joints) - 1
        for mark in chosen:
            mark.chosen = False


class FOCAL_OT_joint_remove(JointOperator, bpy.types.Operator):
    """Remove the active joint; its children go to its parent"""
    bl_idname = "focal.joint_remove"
    bl_label = "Remove Joint"

    all: BoolProperty(name="All", options={"SKIP_SAVE"})

    def change(self, context, _obj):
        settings = context.scene.focal
        joint = _active(settings)
        if self.all or joint is None:
            settings.joints.clear()
        else:
            for other in settings.joints:
                if other.parent == joint.name:
                    other.parent = joint.parent
            settings.joints.remove(settings.joint_active)
        settings.joint_active = max(0, min(settings.joint_active, len(settings.joints) - 1))


class FOCAL_OT_joint_mirror(JointOperator, bpy.types.Operator):
    """Add the joints of the other side, over the landmarks of the other side"""
    bl_idname = "focal.joint_mirror"
    bl_label = "Add Other Side"

    def change(self, context, _obj):
        joints = context.scene.focal.joints
        rows = [_as_row(joint) for joint in joints]
        for row in rows:
            other = names.mirrored(row["name"])
            if other and other not in joints:
                put(joints, {key: _other_side(value) for key, value in row.items()})


def _other_side(value):
    if isinstance(value, list):
        return [_other_side(one) for one in value]
    return (names.mirrored(value) or value) if isinstance(value, str) else value


def _shipped(_self, _context):
    """Kept: Blender needs these words to stay in memory."""
    _shipped.items = [(name, name.capitalize(), path) for name, path in templates.shipped().items()]
    return _shipped.items


class FOCAL_OT_joint_template(JointOperator, bpy.types.Operator):
    """Fill the list from a template that came with the add-on"""
    bl_idname = "focal.joint_template"
    bl_label = "From Template"

    kind: EnumProperty(name="Template", items=_shipped)

    def change(self, context, obj):
        settings, template = context.scene.focal, templates.read(templates.shipped()[self.kind])
        settings.joints.clear()
        for row in template["joints"]:
            put(settings.joints, row)
        settings.symmetric = bool(template.get("symmetric"))
        missing = templates.missing_of(template, {mark.name for mark in obj.focal.landmarks})
        self.report({"WARNING"} if missing else {"INFO"},
                    f"{len(settings.joints)} joints" + (f"; this mesh lacks {', '.join(missing)}" if missing else ""))


class FOCAL_OT_joint_export(JointOperator, bpy.types.Operator, ExportHelper):
    """Write the list as a skeleton template, which the focal command reads too"""
    bl_idname = "focal.joint_export"
    bl_label = "Save Template"

    filename_ext = ".json"
    filter_glob: StringProperty(default="*.json", options={"HIDDEN"})

    def change(self, context, _obj):
        template = as_template(context.scene.focal)
        if template is None:
            raise Unusable("There are no joints yet")
        with open(self.filepath, "w", encoding="utf-8") as file:
            json.dump(template, file, indent=1, ensure_ascii=False)


class FOCAL_OT_joint_show(JointOperator, bpy.types.Operator):
    """Show the joints as bones on this mesh: drag them in edit mode, then take them over"""
    bl_idname = "focal.joint_show"
    bl_label = "Show Bones"

    def change(self, context, obj):
        settings = context.scene.focal
        places = places_of(settings, obj)
        rows = [joint for joint in _parents_first(settings.joints) if joint.name in places]
        if not rows:
            raise Unusable("No joint has all of its landmarks on this mesh")
        armature = preview_of(obj) or _new_preview(context, obj)
        with Selection(context, [armature]):
            bpy.ops.object.mode_set(mode="EDIT")
            bones = armature.data.edit_bones
            for bone in list(bones):
                bones.remove(bone)
            for joint in rows:
                _add_bone(bones, joint, places, rows)
            bpy.ops.object.mode_set(mode="OBJECT")
        lost = [joint.name for joint in settings.joints if joint.name not in places]
        if lost:
            self.report({"WARNING"}, f"Not shown, for their landmarks have no place on this mesh: {', '.join(lost)}")


class FOCAL_OT_joint_take(JointOperator, bpy.types.Operator):
    """Apply the dragged bones: each moved joint is placed between the two landmarks whose line comes nearest to it"""
    bl_idname = "focal.joint_take"
    bl_label = "Take Over Bones"

    @classmethod
    def poll(cls, context):
        return super().poll(context) and preview_of(context.active_object) is not None

    def change(self, context, obj):
        settings, armature = context.scene.focal, preview_of(context.active_object)
        places, marks = places_of(settings, obj), _marks(obj)
        size, moved = Surface(obj).size(), 0
        for bone in armature.data.bones:
            joint = settings.joints.get(bone.name)
            if joint is not None and bone.name in places and (bone.head_local - places[bone.name]).length > 1e-3 * size:
                ends, joint.share = _nearest_line(bone.head_local, marks)
                joint.kind = "BETWEEN"
                joint.places.clear()
                for name in ends:
                    joint.places.add().name = name
                moved += 1
            if joint is not None:
                joint.parent = bone.parent.name if bone.parent else ""
        self.report({"INFO"}, f"{moved} joint{'' if moved == 1 else 's'} moved")


def _nearest_line(point, marks):
    """((from, to), share): of all pairs of landmarks, that whose line comes nearest to a point."""
    pairs = list(itertools.combinations(marks, 2))
    starts, ends = (numpy.array([tuple(marks[pair[k]]) for pair in pairs]) for k in (0, 1))
    ways, away = ends - starts, numpy.array(tuple(point)) - starts
    shares = numpy.clip((away * ways).sum(axis=1) / numpy.maximum((ways * ways).sum(axis=1), 1e-12), 0, 1)
    best = int(numpy.argmin(numpy.linalg.norm(away - shares[:, None] * ways, axis=1)))
    return pairs[best], float(shares[best])


def _marks(obj):
    return {mark.name: Vector(mark.position) for mark in obj.focal.landmarks if mark.placed}


def places_of(settings, obj):
    """{joint: its place on this mesh}, local; without those whose landmarks have no place here."""
    marks, surface, found = _marks(obj), Surface(obj), {}
    for _round in range(len(settings.joints)):  # a joint may lie between joints
        for joint in settings.joints:
            names_of = [place.name for place in joint.places]
            known = {**marks, **found} if joint.kind == "BETWEEN" else marks
            if joint.name in found or not names_of or any(name not in known for name in names_of):
                continue
            points = [known[name] for name in names_of]
            if joint.kind == "BETWEEN":
                found[joint.name] = points[0].lerp(points[-1], joint.share)
            elif joint.kind == "SURFACE":
                found[joint.name] = sum(points, Vector()) / len(points)
            else:
                inside = [_middle_below(obj, surface, name) for name in names_of]
                found[joint.name] = sum(inside, Vector()) / len(inside)
    return found


def _middle_below(obj, surface, name):
    """Halfway to the other side of the limb below a landmark."""
    mark = obj.focal.landmarks[name]
    a, b, c = (Vector(corner) for corner in surface.local[surface.triangles[mark.triangle]])
    inward = -(b - a).cross(c - a).normalized()
    start = Vector(mark.position) + 1e-4 * surface.size() * inward
    hit = surface.cast(start, inward)
    return start if hit is None else start.lerp(hit[0], 0.5)


def preview_of(obj):
    return next((o for o in obj.children if o.type == "ARMATURE" and o.get(PREVIEW)), None)


def _new_preview(context, obj):
    armature = bpy.data.objects.new(f"{obj.name} skeleton", bpy.data.armatures.new(f"{obj.name} skeleton"))
    armature[PREVIEW] = True
    armature.parent = obj
    armature.show_in_front = True
    context.scene.collection.objects.link(armature)
    context.view_layer.update()
    return armature


def _add_bone(bones, joint, places, rows):
    """To its first child, else on from its parent."""
    bone = bones.new(joint.name)
    bone.head = places[joint.name]
    child = next((other for other in rows if other.parent == joint.name), None)
    parent = bones.get(joint.parent) if joint.parent else None
    along = places[child.name] - bone.head if child else (bone.head - parent.head) * 0.5 if parent else Vector((0, 0, 0.1))
    bone.tail = bone.head + (along if along.length > 1e-5 else Vector((0, 0, 0.01)))
    bone.parent = parent


def _active(settings):
    return settings.joints[settings.joint_active] if 0 <= settings.joint_active < len(settings.joints) else None


CLASSES = (FOCAL_OT_joint_add, FOCAL_OT_joint_remove, FOCAL_OT_joint_mirror, FOCAL_OT_joint_template, FOCAL_OT_joint_export,
           FOCAL_OT_joint_show, FOCAL_OT_joint_take)


register, unregister = bpy.utils.register_classes_factory(CLASSES)
