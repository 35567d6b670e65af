"""What the add-on keeps in the file: landmarks with each object, settings and the training list with the scene."""
import bpy
from bpy.props import (BoolProperty, CollectionProperty, EnumProperty, FloatProperty, FloatVectorProperty, IntProperty,
                       PointerProperty, StringProperty)

from . import display

STATUS = (
    ("UNPLACED", "Not placed", "Not marked on this mesh", "RADIOBUT_OFF", 0),
    ("MARKED", "Marked", "Set or accepted by hand", "PINNED", 1),
    ("FOUND", "Found", "Found by a model", "CHECKMARK", 2),
    ("UNCERTAIN", "Uncertain", "Found by a model, which is not sure of it", "ERROR", 3),
    ("ABSENT", "Absent", "This mesh does not have it", "X", 4),
)
STATUS_ICON = {item[0]: item[3] for item in STATUS}
STATUS_NAME = {item[0]: item[1] for item in STATUS}

BONE_NAMES = (
    ("AS_TRAINED", "Own", "The names of the training characters"),
    ("VRM", "VRM", "hips, leftUpperArm"),
    ("MIXAMO", "Mixamo", "mixamorig:Hips, mixamorig:LeftArm"),
    ("UNREAL", "Unreal", "pelvis, upperarm_l"),
    ("RIGIFY", "Rigify", "DEF-spine, DEF-upper_arm.L: Blender mirrors poses and weights"),
    ("UNITY", "Unity, Godot", "Hips, LeftUpperArm"),
    ("RIGIFY_METARIG", "Rigify metarig", "spine, upper_arm.L, thigh.L: what Rigify generates controls from"),
)


DEFAULT_MODEL = "humanoid"         # a stock model
TRAINED_MODEL = "//landmarks.focal"  # where training writes to when no file is named


def redraw_views(_self, context):
    for area in context.screen.areas if context.screen else ():
        if area.type == "VIEW_3D":
            area.tag_redraw()


def update_empties(settings, context):
    meshes = [obj for obj in settings.id_data.objects if obj.type == "MESH"]  # before others are added or removed
    for obj in meshes:
        if obj.focal.landmarks or display.empties_of(obj):
            display.update_empties(context, obj)


class FocalLandmark(bpy.types.PropertyGroup):
    name: StringProperty(name="Name", description="Of the landmark; .L and .R, or Left and Right, tell sides apart")
    status: EnumProperty(name="Status", items=STATUS)
    triangle: IntProperty(name="Triangle", default=-1, description="Number among the mesh's triangles")
    barycentric: FloatVectorProperty(name="Barycentric", size=3, description="Weights of the triangle's corners")
    position: FloatVectorProperty(name="Position", size=3, subtype="XYZ", description="In the object's own coordinates and its unit of length",
                                  precision=4)
    confidence: FloatProperty(name="Confidence", min=0, max=1, subtype="FACTOR",
                              description="Chance that the place is right, from 0 to 1")
    expected_error: FloatProperty(name="Expected error", subtype="DISTANCE",
                                  description="How far off the place may be, in the scene's unit of length")
    runner_up_confidence: FloatProperty(name="Second-best confidence", min=0, max=1)
    runner_up_triangle: IntProperty(default=-1)
    runner_up_barycentric: FloatVectorProperty(size=3)
    chosen: BoolProperty(name="Choose", description="For a joint: Joint from Landmarks takes those that are ticked")
    told_absent: BoolProperty(description="Absent by hand: no model looks for it")

    @property
    def placed(self):
        return self.triangle >= 0 and self.status in {"MARKED", "FOUND", "UNCERTAIN"}

    @property
    def by_hand(self):
        """Whether what it says was set or accepted by hand, so that no model changes it."""
        return self.placed if self.status == "MARKED" else self.status == "ABSENT" and self.told_absent


class FocalTrainingMesh(bpy.types.PropertyGroup):
    object: PointerProperty(type=bpy.types.Object, name="Mesh")


class FocalObject(bpy.types.PropertyGroup):
    character: CollectionProperty(type=FocalTrainingMesh, description="The objects that make one character with this one")
    landmarks: CollectionProperty(type=FocalLandmark)
    active: IntProperty(name="Active landmark", update=redraw_views)
    model: StringProperty(name="Model", description="File of the model that found the landmarks")
    category_fit: FloatProperty(name="Fits the category", min=0, max=1, subtype="FACTOR",
                                description="How well the mesh fits what the model knows, from 0 to 1; below 0.2 it is hardly of the kind")
    triangle_count: IntProperty(description="Of the mesh when the landmarks were placed: other meshes need a snap")


class FocalLandmarkError(bpy.types.PropertyGroup):
    name: StringProperty()
    mean: FloatProperty(name="Mean error", subtype="DISTANCE", description="In the scene's unit of length")
    share: FloatProperty(name="Error", description="In per cent of the square root of the surface's area",
                         subtype="PERCENTAGE", precision=2)
    count: IntProperty(name="Meshes it was measured on")


class FocalName(bpy.types.PropertyGroup):
    name: StringProperty()


class FocalJoint(bpy.types.PropertyGroup):
    """A joint of a skeleton template, see docs/rigs.md."""
    name: StringProperty(name="Name", description="Of the bone; .L and .R, or left and right, distinguish the sides")
    parent: StringProperty(name="Parent", description="The joint's parent; empty: a root")
    kind: EnumProperty(name="Lies", items=(
        ("CENTRE", "Inside", "In the middle of the limb below its landmarks, at the mean of these places"),
        ("SURFACE", "Middle", "In the middle of its landmarks"),
        ("BETWEEN", "Between", "On the line between two landmarks or joints")))
    places: CollectionProperty(type=FocalName, description="Landmarks, or for a joint between two places also joints")
    share: FloatProperty(name="Share", min=0, max=1, default=0.5, subtype="FACTOR",
                         description="Position between the first place (0) and the second (1)")
    tip: StringProperty(name="Tip", description="The landmark where its bone ends; empty: the bone extends to the skin")


class FocalScene(bpy.types.PropertyGroup):
    training: CollectionProperty(type=FocalTrainingMesh)
    training_active: IntProperty()
    source: EnumProperty(name="Learn from", items=(
        ("MARKS", "Marks", "Landmarks that you marked"),
        ("RIGS", "Rigs", "Skeletons and weights of rigged characters; no marks are needed")))
    quality: EnumProperty(name="Training", default="FULL", items=(
        ("FULL", "Full", "Most accurate, with calibrated confidences"),
        ("DRAFT", "Draft", "A few times faster, to try something; every confidence is about one half")))
    model_path: StringProperty(name="Model", subtype="FILE_PATH", default=DEFAULT_MODEL,
                               description="The name of a stock model, or a file (.focal) that training writes and detection "
                                           "reads")
    search: EnumProperty(name="Search", items=(
        ("BEST", "Best", "With the slower refinements: a second or two per mesh"), ("INTERACTIVE", "Quick", "About half the time")))
    resolve: BoolProperty(
        name="Re-solve after each correction", default=True,
        description="When a landmark of a detected mesh is set or accepted by hand, look for the others again")
    errors: CollectionProperty(type=FocalLandmarkError)
    errors_active: IntProperty()
    overlay: BoolProperty(name="Show in viewport", default=True, update=redraw_views,
                          description="Draw the landmarks of the active mesh in colours of their confidence")
    overlay_names: BoolProperty(name="Names", default=True, update=redraw_views,
                                description="Write each landmark's name beside it")
    empties: BoolProperty(name="Empties", update=update_empties,
                          description="Also make an empty at each landmark, a child of the mesh: for constraints and for export. "
                                      "Without it, empties are removed")
    keep_votes: BoolProperty(name="Keep vote map",
                             description="Store vote maps as a colour attribute, for materials and export; otherwise they are only drawn")
    bone_names: EnumProperty(name="Names", items=BONE_NAMES, description="Names of the bones")
    ground_root: BoolProperty(name="Root on the ground",
                              description="Add a root bone on the ground above all others, as engines expect it")
    rig_landmarks: BoolProperty(name="Show landmarks", description="Also list the landmarks that a model of rigs looks for: "
                                                                   "to correct them by hand")
    symmetric: BoolProperty(name="Symmetric", description="Bones of the left and right side get the same length")
    template_path: StringProperty(name="Skeleton", subtype="FILE_PATH",
                                  description="Your own skeleton over the model's landmarks, as a JSON file; empty: "
                                              "that of the training characters")
    joints: CollectionProperty(type=FocalJoint, description="A skeleton for models of marks; empty: the template that suits their "
                                                            "landmarks")
    joint_active: IntProperty(name="Active joint")
    choose: BoolProperty(name="Choose Landmarks", description="Tick landmarks in the list, to make joints of them")
    replace_rig: BoolProperty(name="Replace", description="Remove the old armature's modifier and weights first")
    segmentation: EnumProperty(name="Parts", items=(
        ("AUTO", "Automatic", "By the skeleton if the model has one, otherwise by the nearest landmark"),
        ("GEODESIC", "Nearest landmark", "The landmark nearest along the surface"),
        ("SKELETON", "Skeleton", "The joint that moves it most"),
        ("K_MEANS", "Clusters", "Clusters of place and heat kernel signature that start at the landmarks")))
    parts_as_groups: BoolProperty(name="Vertex groups", default=True, description="One vertex group for each part")
    parts_as_colours: BoolProperty(name="Colours", default=True, description="Parts as a colour attribute")
    batch: PointerProperty(type=bpy.types.Collection, name="Collection", description="Process every mesh of this collection")
    batch_together: BoolProperty(name="One character", description="The meshes of the collection are the parts of one character: "
                                                                   "one armature; otherwise each is processed on its own")
    batch_rig: BoolProperty(name="Rig too", description="Also give each mesh its armature and weights")
    report: StringProperty(description="What the last run over a collection skipped, and why")


CLASSES = (FocalLandmark, FocalTrainingMesh, FocalObject, FocalLandmarkError, FocalName, FocalJoint, FocalScene)


def register():
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    bpy.types.Object.focal = PointerProperty(type=FocalObject)
    bpy.types.Scene.focal = PointerProperty(type=FocalScene)


def unregister():
    del bpy.types.Scene.focal
    del bpy.types.Object.focal
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
