"""What Rigify needs of a metarig: types of its bones, chains without gaps, heels; and meshes moved by what it generates from that."""
import bpy
from mathutils import Vector

from .geometry import Unusable, armature_of
from .gltf import Selection

_LIMBS = {"limbs.arm": ("upper_arm", "forearm", "hand"), "limbs.leg": ("thigh", "shin", "foot", "toe")}
_FINGERS = ("thumb", "f_index", "f_middle", "f_ring", "f_pinky")
_SPINE = ("spine", "spine.001", "spine.002", "spine.003")
_NECK = ("spine.004", "spine.005", "spine.006")
_DEFORMS = "DEF-"


def is_metarig(armature):
    return {"spine", "upper_arm.L", "thigh.L"} <= set(armature.data.bones.keys())


def prepare(context, armature):
    """Gives a metarig that Rigify's Generate takes: also when Rigify is not switched on yet."""
    chains = _chains(armature.data.bones)
    with Selection(context, [armature]):
        bpy.ops.object.mode_set(mode="EDIT")
        bones = armature.data.edit_bones
        for bone in bones:  # Rigify takes all that is connected for one chain
            bone.use_connect = False
        for _kind, names in chains:
            for name, following in zip(names, names[1:]):
                bones[name].tail = bones[following].head
                bones[following].use_connect = True
        for side in "LR":
            _add_heel(bones, side)
        bpy.ops.object.mode_set(mode="OBJECT")
    _give_types(armature, chains)
    if hasattr(armature.data, "collections"):  # Blender 4
        _give_collections(armature.data, chains)


def _chains(bones):
    """(type, names) of what Rigify makes controls for, as far as it is there; each bone's parent is the one before it."""
    wanted = [("spines.basic_spine", _SPINE, 3), ("spines.super_head", _NECK, 1)]
    for side in "LR":
        wanted += [(kind, [f"{name}.{side}" for name in names], len(names)) for kind, names in _LIMBS.items()]
        wanted += [("limbs.super_finger", [f"{finger}.{number:02}.{side}" for number in (1, 2, 3)], 2) for finger in _FINGERS]
    found = []
    for kind, names, least in wanted:
        chain = []
        for name in names:
            bone = bones.get(name)
            if bone is not None and (not chain or (bone.parent is not None and bone.parent.name == chain[-1])):
                chain.append(name)
        if len(chain) >= least:
            found.append((kind, chain))
    return found


def _add_heel(bones, side):
    """Across the sole below the ankle: where Rigify rolls a foot back."""
    foot, toe = bones.get(f"foot.{side}"), bones.get(f"toe.{side}")
    if foot is None or toe is None:
        return
    forward = toe.head - foot.head
    ground = min(toe.head.z, toe.tail.z)
    forward.z = 0
    if forward.length < 1e-6:
        return
    centre = foot.head - 0.3 * forward
    across = 0.25 * forward.cross(Vector((0, 0, 1)))
    heel = bones.new(f"heel.02.{side}")
    heel.head, heel.tail = ((centre + sign * across).to_2d().to_3d() + Vector((0, 0, ground)) for sign in (-1, 1))
    heel.parent, heel.use_deform = foot, False


def _give_types(armature, chains):
    """As custom properties, which Rigify reads as its own. One segment a limb: then each bone has one that moves vertices."""
    bones = armature.pose.bones
    inside = {name for _kind, names in chains for name in names} | {"heel.02.L", "heel.02.R"}
    for kind, names in chains:
        bones[names[0]]["rigify_type"] = kind
        if kind in _LIMBS:
            bones[names[0]]["rigify_parameters"] = {"segments": 1}
    for bone in bones:
        if bone.name not in inside:
            bone["rigify_type"] = "basic.super_copy"


def _give_collections(data, chains):
    """Rows of buttons in the generated rig's panel: without any, Rigify of Blender 4 generates nothing."""
    rows = {"limbs.arm": ("Arm", 2), "limbs.leg": ("Leg", 3), "limbs.super_finger": ("Fingers", 4)}
    chain_of = {name: (kind, name[-2:]) for kind, names in chains for name in names}
    for bone in data.bones:
        kind, side = chain_of.get(bone.name.replace("heel.02", "foot"), ("", ""))
        name, row = rows.get(kind, ("Body", 1))
        name += side if row > 1 else ""
        collection = data.collections.get(name) or data.collections.new(name)
        collection["rigify_ui_row"] = row
        collection.assign(bone)


class FOCAL_OT_rigify_bind(bpy.types.Operator):
    """Move the weights of the metarig's meshes to the deforming bones of the rig that Rigify generated. Repeat it after each
Generate"""
    bl_idname = "focal.rigify_bind"
    bl_label = "Move by Generated Rig"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return generated_rig(metarig_of(context.active_object)) is not None

    def execute(self, context):
        metarig = metarig_of(context.active_object)
        rig = generated_rig(metarig)
        try:
            meshes = [o for o in context.scene.objects if o.type == "MESH" and armature_of(o) == metarig]
            if not meshes:
                raise Unusable(f"'{metarig.name}' moves no mesh: it was bound before")
            for obj in meshes:
                _move_by(obj, metarig, rig)
        except Unusable as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        metarig.hide_set(True)
        self.report({"INFO"}, f"'{rig.name}' moves {len(meshes)} mesh{'' if len(meshes) == 1 else 'es'}")
        return {"FINISHED"}


def metarig_of(obj):
    """The object itself or what moves it, where that is a metarig."""
    if obj is not None and obj.type == "MESH":
        obj = armature_of(obj)
    return obj if obj is not None and obj.type == "ARMATURE" and is_metarig(obj) else None


def generated_rig(metarig):
    """What Rigify made of a metarig, or None."""
    rig = getattr(metarig.data, "rigify_target_rig", None) if metarig is not None else None
    return rig if rig is not None and rig.name in bpy.context.scene.objects else None


def _move_by(obj, metarig, rig):
    bones = rig.data.bones
    missing = [g.name for g in obj.vertex_groups if g.name in metarig.data.bones and _DEFORMS + g.name not in bones
               and metarig.data.bones[g.name].use_deform]
    if missing:
        raise Unusable(f"The generated rig has no bone that deforms for {', '.join(missing)}: generate it from this metarig again")
    for group in obj.vertex_groups:
        if group.name in metarig.data.bones:
            group.name = _DEFORMS + group.name
    for modifier in obj.modifiers:
        if modifier.type == "ARMATURE" and modifier.object == metarig:
            modifier.object = rig
    if obj.parent == metarig:
        world = obj.matrix_world.copy()
        obj.parent = rig
        obj.matrix_world = world


register, unregister = bpy.utils.register_classes_factory((FOCAL_OT_rigify_bind,))
