"""Weights only: for bones that are there, also after they were moved by hand."""
import bpy

from . import engine
from .geometry import TO_GLTF, Character, Surface, Unusable, armature_of, character_of, selected_meshes
from .jobs import JobOperator
from .rigging import write_weights


class FOCAL_OT_bind(JobOperator, bpy.types.Operator):
    """Compute weights of the selected meshes, as one character, for the bones of their armature, which stay in place. Needs no model.
Esc cancels"""
    bl_idname = "focal.bind"
    bl_label = "Weights Only"
    bl_options = {"REGISTER", "UNDO"}

    def prepare(self, context):
        engine.focal()
        objects, armature = _chosen(context)
        character = Character([Surface(obj) for obj in objects])
        parts, joints = character.parts(), _joints(armature, character.surfaces[0].location)
        self._names = [obj.name for obj in objects], armature.name
        run_context = engine.context()

        def work(job):
            package = engine.package()
            mesh = package.Mesh.from_parts(parts, context=run_context)
            skeleton = package.Skeleton.bind(mesh, joints, context=run_context, task=job.begin("weights"))
            return character, [joint["name"] for joint in joints], *skeleton.weights, skeleton.warnings
        return work

    def apply(self, context, result):
        character, bones, numbers, weights, warnings = result
        objects, armature = [bpy.data.objects[name] for name in self._names[0]], bpy.data.objects[self._names[1]]
        moving = [bone for bone in bones if armature.data.bones[bone].use_deform]
        for number, obj in enumerate(objects):
            own = character.vertices_of(number)
            write_weights(obj, bones, numbers[own], weights[own], only=moving)
            _let_move(obj, armature)
        text = f"Weights of {len(moving)} bones for {len(objects)} mesh{'' if len(objects) == 1 else 'es'}"
        self.report({"WARNING"} if warnings else {"INFO"}, "; ".join([text, *warnings]))


def _chosen(context):
    """(meshes, armature): of the selection; the armature is that which moves the first mesh, or one that is selected too."""
    active = context.active_object
    meshes = character_of(context, active) if active is not None and active.type == "MESH" else selected_meshes(context)
    if not meshes:
        raise Unusable("Select the meshes of a character that has an armature")
    armature = armature_of(meshes[0]) or next((o for o in context.selected_objects if o.type == "ARMATURE"), None)
    if armature is None:
        raise Unusable(f"'{meshes[0].name}' has no armature: select one too, or press Rig")
    return meshes, armature


def _joints(armature, origin):
    """In focal's coordinates, parents first; bones that do not deform move nothing."""
    to_focal = TO_GLTF.to_3x3()
    bones = list(armature.data.bones)  # parents come first
    number = {bone.name: i for i, bone in enumerate(bones)}

    def place(local):
        return tuple(to_focal @ (armature.matrix_world @ local - origin))

    return [{"name": bone.name, "parent": number[bone.parent.name] if bone.parent else -1, "position": place(bone.head_local),
             "tip": place(bone.tail_local), "moves": bone.use_deform} for bone in bones]


def _let_move(obj, armature):
    if armature_of(obj) is None:
        obj.modifiers.new("Armature", "ARMATURE").object = armature


def register():
    bpy.utils.register_class(FOCAL_OT_bind)


def unregister():
    bpy.utils.unregister_class(FOCAL_OT_bind)
