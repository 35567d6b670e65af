"""An armature with weights for a mesh, from its landmarks' detection."""
import os

import bpy
import numpy
from mathutils import Quaternion, Vector

from . import rigify, template_edit, templates
from .detection import Target, write_landmarks
from .geometry import FROM_GLTF, Unusable, armature_of, character_of, hints_of, remember_character
from .gltf import Selection
from .jobs import JobOperator

# A bone shorter than this share of the skeleton would vanish: Blender removes bones without length.
_SHORTEST = 0.005
# Beyond this angle the joints of the training characters do not point along their limbs, as in VRM; then the bone
# follows the limb and only its roll follows the joint.
_ALONG = numpy.cos(numpy.radians(40))


class RigTarget(Target):
    """A character that is to get a rig, with the settings for it."""

    def __init__(self, context, objects):
        super().__init__(context, objects)
        settings = context.scene.focal
        for obj in objects if isinstance(objects, (list, tuple)) else [objects]:
            _check_riggable(obj, settings)
        self.options = {"names": settings.bone_names.lower(), "symmetric": settings.symmetric,
                        "ground_root": settings.ground_root, "skeleton_template": template_of(settings)}
        self._own = template_edit.as_template(settings)
        self.verdict = ""  # of the rig, when there is one

    def rig(self, job, start=0.0, end=1.0):
        """(detection, joints, joint numbers, weights, warnings); runs in the thread."""
        middle = start if self.ready else start + 0.5 * (end - start)
        detection = self.detect(job, start, middle)
        task = job.begin(f"rigging {self.surface.name}", middle, end)
        skeleton = detection.rig(task=task, **{**self.options, "skeleton_template": self._skeleton(detection)})
        numbers, weights = skeleton.weights
        self.verdict = f"verdict: {skeleton.verdict.name.lower()}, quality {100 * skeleton.quality:.0f} %"
        return detection, skeleton.joints, numbers, weights, skeleton.warnings

    def _skeleton(self, detection):
        """For a model of marks: the user's joints, else the skeleton that it carries, else the template whose landmarks it finds."""
        if self.options["skeleton_template"] is not None or self.is_of_rigs():
            return self.options["skeleton_template"]
        if self._own is None and detection.joint_names:
            return None
        return templates.text_for([found.name for found in detection], self._own)


    def is_of_rigs(self):
        """Whether the model was trained on rigged characters: its landmarks are derived, so the list need not show them."""
        model = self.model()
        return bool(model.joint_names) and model.skeleton_template is None


def _check_riggable(obj, settings):
    armature = armature_of(obj)
    if armature is not None and not settings.replace_rig:
        raise Unusable(f"'{obj.name}' is moved by the armature '{armature.name}' already: "
                       "remove its modifier, or tick Replace")
    if obj.data.users > 1:  # weights lie with the mesh
        raise Unusable(f"'{obj.name}' shares its mesh with other objects: "
                       "make it single (Object > Relations > Make Single User)")


def template_of(settings):
    """The text of the file that the settings name, or None."""
    if not settings.template_path:
        return None
    path = bpy.path.abspath(settings.template_path)
    if not os.path.isfile(path):
        raise Unusable(f"There is no skeleton template '{path}'")
    with open(path, encoding="utf-8") as file:
        return file.read()


class FOCAL_OT_rig(JobOperator, bpy.types.Operator):
    """Make an armature with weights for the selected meshes, as one character. Landmarks are detected first if necessary.
Esc cancels"""
    bl_idname = "focal.rig"
    bl_label = "Rig"
    bl_options = {"REGISTER", "UNDO"}

    def prepare(self, context):
        self._target = RigTarget(context, character_of(context, context.active_object))
        return lambda job: self._target.rig(job)

    def apply(self, context, result):
        objects = self._target.objects()
        self._target.remember()
        armature = write_rig(context, objects, self._target, result)
        armature["focal_verdict"] = self._target.verdict
        notes = result[-1] + list(dict.fromkeys(hint for obj in objects for hint in hints_of(obj)))
        self.report({"WARNING"} if result[-1] else {"INFO"},
                    "; ".join([f"{len(armature.data.bones)} bones", self._target.verdict] + notes))


def write_rig(context, objects, target, result):
    """Landmarks, one armature, and vertex groups and modifier of each object into the scene; the armature."""
    detection, joints, numbers, weights, _warnings = result
    if context.scene.focal.rig_landmarks or not target.is_of_rigs():
        write_landmarks(context, objects, target, detection)
    else:
        remember_character(objects)
    old = {armature_of(obj) for obj in objects} - {None}
    for obj in objects:
        _remove_old_rig(obj)
    armature, names = _new_armature(context, objects[0], joints)
    for number, obj in enumerate(objects):
        own = target.character.vertices_of(number)
        write_weights(obj, names, numbers[own], weights[own])
        _attach(context, obj, armature)
    for one in old:
        _remove_unused(one)
    if context.scene.focal.bone_names == "RIGIFY_METARIG" and rigify.is_metarig(armature):
        rigify.prepare(context, armature)
    return armature


def _remove_unused(armature):
    """An armature that moved nothing but what has another one now; one that holds a prop stays."""
    if not armature.children and not any(armature_of(obj) is armature for obj in bpy.data.objects if obj.type == "MESH"):
        bpy.data.objects.remove(armature)


def _remove_old_rig(obj):
    """Its modifiers, its parent and the groups that carry its weights."""
    bones = set()
    for modifier in [m for m in obj.modifiers if m.type == "ARMATURE"]:
        if modifier.object is not None:
            bones.update(bone.name for bone in modifier.object.data.bones)
        obj.modifiers.remove(modifier)
    if obj.parent is not None and obj.parent.type == "ARMATURE":
        world = obj.matrix_world.copy()
        obj.parent = None
        obj.matrix_world = world
    for group in [g for g in obj.vertex_groups if g.name in bones]:
        obj.vertex_groups.remove(group)


def _new_armature(context, obj, joints):
    """(armature, the names that its bones got)"""
    armature = bpy.data.objects.new(f"{obj.name} rig", bpy.data.armatures.new(f"{obj.name} rig"))
    armature.location = obj.matrix_world.translation
    armature.show_in_front = True
    obj.users_collection[0].objects.link(armature)
    context.view_layer.update()
    if armature.name not in context.view_layer.objects:  # that collection is switched off
        context.scene.collection.objects.link(armature)
        context.view_layer.update()
    with Selection(context, [armature]):
        bpy.ops.object.mode_set(mode="EDIT")
        bones = _make_bones(armature.data.edit_bones, joints)
        names = [bone.name for bone in bones]
        bpy.ops.object.mode_set(mode="OBJECT")
    for joint, name in zip(joints, names):
        armature.data.bones[name]["focal_confidence"] = joint.confidence
    return armature, names


def _make_bones(edit_bones, joints):
    heads = [_turned(joint.position) for joint in joints]
    tails = _tails(joints, heads)
    bones = []
    for joint, head, tail in zip(joints, heads, tails):
        bone = edit_bones.new(joint.name)
        bone.head, bone.tail = head, tail
        if joint.parent >= 0:
            bone.parent = bones[joint.parent]
            bone.use_connect = (bones[joint.parent].tail - head).length < 1e-6
        _orient(bone, joint)
        bones.append(bone)
    return bones


def _tails(joints, heads):
    """The next joint of the limb where there is one, else the tip; never at the head."""
    span = max((a - heads[0]).length for a in heads) or 1.0
    tails = []
    for j, joint in enumerate(joints):
        following = _following(joints, heads, j)
        tail = heads[following] if following is not None else _turned(joint.tip)
        if (tail - heads[j]).length < _SHORTEST * span:
            tail = heads[j] + _direction(joints, heads, j) * 4 * _SHORTEST * span
        tails.append(tail)
    return tails


def _following(joints, heads, j):
    """The child that continues a joint: its only one; at the root that which most hangs on; else the one ahead."""
    children = [c for c, other in enumerate(joints) if other.parent == j]
    if len(children) < 2:
        return children[0] if children else None
    if joints[j].parent < 0:
        return max(children, key=lambda c: _descendants(joints, c))
    onward = _direction(joints, heads, j)
    ahead, best = max(((heads[c] - heads[j]).normalized().dot(onward), c) for c in children)
    return best if ahead > 0.7 else None


def _descendants(joints, j):
    return 1 + sum(_descendants(joints, c) for c, other in enumerate(joints) if other.parent == j)


def _direction(joints, heads, j):
    """Where a bone of no length points: on from its parent, or up."""
    parent = joints[j].parent
    away = heads[j] - heads[parent] if parent >= 0 else Vector((0, 0, 1))
    return away.normalized() if away.length > 0 else Vector((0, 0, 1))


def _orient(bone, joint):
    """Rest rotation of the training characters as far as the bone's direction leaves it."""
    x, y, z, w = joint.rotation
    axes = FROM_GLTF.to_3x3() @ Quaternion((w, x, y, z)).to_matrix()
    along = (bone.tail - bone.head).normalized()
    own = axes.transposed() @ along  # the bone's direction in the joint's axes
    if own.y > _ALONG:
        bone.align_roll(axes.col[2])
    else:
        bone.align_roll(axes.col[2] if abs(own.z) < 0.7 else axes.col[0] if abs(own.x) < 0.7 else axes.col[1])


def _turned(position):
    return FROM_GLTF.to_3x3() @ Vector(position)


def write_weights(obj, names, numbers, weights, only=None):
    """Vertices of equal weight go in together: most have 1, and each call costs. only: the bones that get a group; None: all."""
    for j, name in enumerate(names):
        if only is not None and name not in only:
            continue
        old = obj.vertex_groups.get(name)
        if old is not None:
            obj.vertex_groups.remove(old)
        group = obj.vertex_groups.new(name=name)
        vertices, slots = numpy.nonzero((numbers == j) & (weights > 0))
        own = weights[vertices, slots]
        values, where = numpy.unique(own, return_inverse=True)
        order = numpy.argsort(where, kind="stable")
        for value, part in zip(values, numpy.split(vertices[order], numpy.cumsum(numpy.bincount(where))[:-1])):
            group.add(part.tolist(), float(value), "REPLACE")


def _attach(context, obj, armature):
    """Armature modifier first: it moves what the artist modelled, others refine that. The mesh stays where it is."""
    world = obj.matrix_world.copy()
    if obj.parent is not None and obj.parent.type != "ARMATURE":
        armature.parent = obj.parent
        armature.matrix_parent_inverse = obj.parent.matrix_world.inverted()
    obj.parent = armature
    obj.matrix_parent_inverse = armature.matrix_world.inverted()
    obj.matrix_world = world
    modifier = obj.modifiers.new("Armature", "ARMATURE")
    modifier.object = armature
    if len(obj.modifiers) > 1:
        with context.temp_override(object=obj, active_object=obj):
            bpy.ops.object.modifier_move_to_index(modifier=modifier.name, index=0)


def register():
    bpy.utils.register_class(FOCAL_OT_rig)


def unregister():
    bpy.utils.unregister_class(FOCAL_OT_rig)
