"""The training list, learning a model from it, and what leaving meshes out says about its errors."""
import os
import tempfile

import bpy
import numpy
from bpy.props import BoolProperty

from . import engine, gltf, landmark_data, template_edit, templates
from .geometry import Character, Unusable, armature_of, problem_of, remember_character, remembered_character, selected_meshes
from .jobs import JobOperator
from .model_files import model_path, path_to_train
from .rigging import template_of

_DRAFT = {"proxy_vertices": 1500, "tree_count": 10, "learn_confidence": False}
_MOST_FOLDS = 10


class FOCAL_OT_training_add(bpy.types.Operator):
    """Add the selected meshes to the training list. Meshes that form one character, such as body, clothes and eyes with different
marks, get one row"""
    bl_idname = "focal.training_add"
    bl_label = "Add Selected"
    bl_options = {"REGISTER", "UNDO"}

    together: BoolProperty(name="As one character", options={"SKIP_SAVE"},
                           description="The selected meshes are the parts of one character: one row, one set of marks")

    @classmethod
    def description(cls, _context, properties):
        return cls.__doc__ if not properties.together else "Add the selected meshes as the parts of one character: one row, one set of marks"

    def execute(self, context):
        items = context.scene.focal.training
        chosen = selected_meshes(context)
        if self.together or _make_one(chosen):
            remember_character(chosen)
            for at in reversed([i for i, item in enumerate(items) if item.object in chosen]):
                items.remove(at)
        known = {part for item in items if item.object is not None for part in remembered_character(item.object)}
        new = [group[0] for group in characters(chosen) if not known.intersection(group)]
        if not new:
            self.report({"WARNING"}, "Select meshes that are not in the list yet")
            return {"CANCELLED"}
        for obj in new:
            items.add().object = obj
        return {"FINISHED"}


def _make_one(objects):
    """Whether meshes have their marks in common: some are marked, and no landmark is on two of them. Characters of a training list
    have the same landmarks."""
    names = [mark.name for obj in objects for mark in obj.focal.landmarks if mark.placed]
    return len(objects) > 1 and len(names) > 0 and len(names) == len(set(names))


def characters(objects):
    """Each as a list of its objects, in the order of the first of each."""
    groups, seen = [], set()
    for obj in objects:
        if obj not in seen:
            groups.append([part for part in remembered_character(obj) if part not in seen])
            seen.update(groups[-1])
    return groups


class FOCAL_OT_training_remove(bpy.types.Operator):
    """Remove a mesh from the training list; the mesh itself stays"""
    bl_idname = "focal.training_remove"
    bl_label = "Remove"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context):
        settings = context.scene.focal
        settings.training.remove(settings.training_active)
        settings.training_active = max(0, min(settings.training_active, len(settings.training) - 1))
        return {"FINISHED"}


class TrainingMesh:
    """One marked character, as arrays: the scene may change while these are learned."""

    def __init__(self, objects):
        found = [landmark_data.surface_with_marks(obj) for obj in objects]
        character = Character([surface for surface, _marks in found])
        self.name, self.marks = objects[0].name, {}
        for first, (surface, marks) in zip(character.first_triangle, found):
            for name, (triangle, barycentric) in marks.items():
                if name in self.marks:
                    raise Unusable(f"'{name}' is marked on '{surface.name}' and on another object of the same character")
                self.marks[name] = first + triangle, barycentric
        self.parts = character.parts()
        self.positions = numpy.concatenate([positions for positions, _faces in self.parts])
        self.faces = numpy.concatenate([faces + first for (_positions, faces), first in zip(self.parts, character.first_vertex)])

    def place(self, name):
        triangle, barycentric = self.marks[name]
        return numpy.asarray(barycentric) @ self.positions[self.faces[triangle]]


def training_objects(context):
    """What of the list is still in the file; Unusable when that is nothing."""
    listed = [item.object for item in context.scene.focal.training if item.object is not None]
    objects = [part for group in characters(listed) for part in group]
    for obj in objects:
        if problem_of(obj):
            raise Unusable(problem_of(obj))
    if not objects:
        raise Unusable("The training list is empty: select meshes and press Add Selected")
    return objects


def marked_meshes(context):
    """(meshes, landmark names in the order of first appearance)"""
    meshes = [TrainingMesh(group) for group in characters(training_objects(context))]
    unmarked = [m.name for m in meshes if not m.marks]
    if unmarked:
        raise Unusable(f"Without landmarks: {', '.join(unmarked)}. Mark them or take them off the list")
    names = list(dict.fromkeys(name for m in meshes for name in m.marks))
    rare = [name for name in names if sum(name in m.marks for m in meshes) < 2]
    if rare:
        raise Unusable(f"On one mesh only: {', '.join(rare)}. Every landmark must be marked on at least two")
    return meshes, names


def parameters(context):
    return dict(_DRAFT) if context.scene.focal.quality == "DRAFT" else {}


def _skeleton_over(names, settings):
    """The template that the model carries: the file or the joints that the user names, else a shipped one whose landmarks are all there."""
    text = template_of(settings)
    own = template_edit.as_template(settings)
    if text is None and own is None and not templates.fits(names):
        return None
    return text or templates.text_for(names, own)


def learn(meshes, names, options, run_context, task, skeleton=None):
    """A model from marked meshes; runs in the thread."""
    focal = engine.package()
    training = focal.TrainingSet(names, context=run_context)
    training.set_skeleton(skeleton)
    for mesh in meshes:
        known = {name: place for name, place in mesh.marks.items() if name in names}
        training.add(focal.Mesh.from_parts(mesh.parts, context=run_context), known)
    return focal.Model.train(training, task=task, **options)


class FOCAL_OT_train(JobOperator, bpy.types.Operator):
    """Learn the landmarks, or the skeleton, of the meshes in the list and save the model. Esc cancels"""
    bl_idname = "focal.train"
    bl_label = "Train"
    bl_options = {"REGISTER", "UNDO"}

    def prepare(self, context):
        engine.focal()
        path, options, run_context = path_to_train(context), parameters(context), engine.context()
        os.makedirs(os.path.dirname(path) or ".", exist_ok=True)
        if context.scene.focal.source == "RIGS":
            return _work_on_rigs(context, path, options, run_context)
        meshes, names = marked_meshes(context)
        skeleton = _skeleton_over(names, context.scene.focal)

        def work(job):
            model = learn(meshes, names, options, run_context, job.begin("training"), skeleton)
            model.save(path)
            carried = f" and a skeleton of {len(model.joint_names)} joints over them" if skeleton else ""
            return f"Learned {len(names)} landmarks from {len(meshes)} meshes{carried}"
        return work

    def apply(self, context, result):
        self.report({"INFO"}, f"{result}: {model_path(context)}")


def _characters(objects):
    """Objects that one armature moves are one character."""
    groups = {}
    for obj in objects:
        groups.setdefault(armature_of(obj), []).append(obj)
    return list(groups.values())


def _work_on_rigs(context, path, options, run_context):
    objects = training_objects(context)
    bare = [o.name for o in objects if armature_of(o) is None]
    if bare:
        raise Unusable(f"Without an armature: {', '.join(bare)}. Take them off the list")
    folder = tempfile.TemporaryDirectory(prefix="focal")
    files = [gltf.export_character(context, group, os.path.join(folder.name, f"{i}.glb"))
             for i, group in enumerate(_characters(objects))]
    if context.scene.focal.quality == "DRAFT":
        options["rigged_shapes"] = 8

    def work(job):
        focal = engine.package()
        with folder:
            training = focal.TrainingSet(context=run_context)
            for file in files:
                training.add_rig(focal.Mesh.load(file, context=run_context))
            model = focal.Model.train(training, task=job.begin("training"), **options)
        model.save(path)
        return f"Learned {len(model.joint_names)} joints from {len(files)} rigged meshes"
    return work


class FOCAL_OT_cross_validate(JobOperator, bpy.types.Operator):
    """Train on most meshes of the list, find the landmarks on the others, and measure the errors, in turn. Takes several times
as long as training. Esc cancels"""
    bl_idname = "focal.cross_validate"
    bl_label = "Measure Errors"
    bl_options = {"REGISTER", "UNDO"}

    def prepare(self, context):
        engine.focal()
        meshes, names = marked_meshes(context)
        if len(meshes) < 3:
            raise Unusable("Three marked meshes are needed: one is left out, two are for training")
        options, run_context = parameters(context), engine.context()
        options["learn_confidence"] = False  # the places are measured, not what the model says of them
        return lambda job: cross_validate(meshes, names, options, run_context, job)

    def apply(self, context, result):
        errors = context.scene.focal.errors
        errors.clear()
        for name, distances in sorted(result.items(), key=lambda pair: -numpy.mean([s for _, s in pair[1]])):
            item = errors.add()
            item.name, item.count = name, len(distances)
            item.mean = float(numpy.mean([d for d, _ in distances]))
            item.share = 100 * float(numpy.mean([s for _, s in distances]))
        mean = numpy.mean([share for found in result.values() for _, share in found])
        self.report({"INFO"}, f"Mean error {100 * mean:.2f} % of the size, over {len(result)} landmarks")


def cross_validate(meshes, names, options, run_context, job):
    """{landmark: [(distance, share of sqrt(area))]} on meshes that were left out; runs in the thread."""
    count = len(meshes)
    folds = min(count, _MOST_FOLDS)
    errors = {}
    for fold in range(folds):
        left_out = [m for i, m in enumerate(meshes) if i * folds // count == fold]
        others = [m for m in meshes if m not in left_out]
        known = [n for n in names if sum(n in m.marks for m in others) >= 2]
        start = fold / folds
        task = job.begin(f"training without {left_out[0].name}", start, start + 0.9 / folds)
        model = learn(others, known, options, run_context, task)
        for mesh in left_out:
            task = job.begin(f"measuring {mesh.name}", start + 0.9 / folds, start + 1 / folds)
            _measure(model, mesh, run_context, task, errors)
    return errors


def _measure(model, mesh, run_context, task, errors):
    shape = engine.package().Mesh.from_parts(mesh.parts, context=run_context)
    detection = model.detect(shape, keep_votes=False, task=task)
    for mark in detection:
        if mark.name in mesh.marks and mark.point is not None:
            distance = float(numpy.linalg.norm(numpy.asarray(mark.position) - mesh.place(mark.name)))
            errors.setdefault(mark.name, []).append((distance, distance / shape.surface_area ** 0.5))


CLASSES = (FOCAL_OT_training_add, FOCAL_OT_training_remove, FOCAL_OT_train, FOCAL_OT_cross_validate)


register, unregister = bpy.utils.register_classes_factory(CLASSES)
