"""Closed objects are answered with an exception, whatever is asked of them; objects may be closed in any order."""
import contextlib
import copy
import gc
import pathlib
import pickle
import unittest
import weakref

import focal
from support import NAMES, Case, detection, mesh, model, shape, training_set

Status = focal.Status

# What is asked of a closed object: a name of its class, and arguments that would do. None: a property.
USES = {
    "Context": {"backend": None, "backend_reason": None, "thread_count": None, "memory_held": None, "stock_models": None},
    "Task": {"cancel": (), "reset": (), "progress": None, "stage": None, "cancelled": None},
    "Mesh": {"info": None, "vertex_count": None, "triangle_count": None, "surface_area": None, "vertices": None,
             "faces": None, "warnings": None, "position_of": ((0, (1, 0, 0)),), "point_at_vertex": (0,),
             "describe": ([0],), "distances": (0,), "parts": None, "closest_point": ((0, 0, 0),), "symmetry_plane": (), "write_wrap": ("w.glb",), "left_out": None},
    "TrainingSet": {"mesh_count": None, "check": (), "add": (mesh(), [0, 1, 2]), "add_rig": (mesh(),), "set_skeleton": (None,)},
    "Model": {"save": ("m.focal",), "to_bytes": (), "info": None, "train_params": None, "landmark_names": None,
              "joint_names": None, "skeleton_template": None, "detect": (mesh(),), "analyse": (mesh(),),
              "detect_many": ([mesh()],),
              "regress": (model().analyse(mesh()), "nose", 0)},
    "Analysis": {"save": ("m.analysis",)},
    "Detection": {"landmarks": None, "info": None, "category_fit": None, "seconds": None, "warnings": None,
                  "votes": ("nose",), "distances": (0,), "region": (0, 0.1), "segment": (),
                  "correspond": (detection(),), "rig": (), "write": ("d.glb",), "write_votes": ("d.glb",),
                  "write_segments": ("d.glb",), "__len__": (), "__iter__": (), "__getitem__": (0,)},
    "Correspondence": {"points": None, "carry": ([0.0] * 514,)},
    "Skeleton": {"joints": None, "weights": None, "info": None, "warnings": None, "write": ("s.glb",), "verdict": None, "quality": None,
                 "write_vrm": ("s.vrm", {"name": "Ann", "authors": ["Bob"]})},
}
ALIVE = {"close", "closed", "load", "from_bytes", "from_parts", "load_stock", "bind", "train", "landmark_names",
         "joint_names", "origin"}  # asks nothing of the library's object


def made():
    """One open object of each class that can be had without a rig."""
    return [focal.Context(), focal.Task(), mesh(), training_set(), focal.Model.from_bytes(model().to_bytes()),
            model().analyse(mesh()), model().detect(mesh()), detection().correspond(detection())]


def closed_skeleton():
    """Skeletons come of rigs only; to be closed is to have no handle."""
    return focal.Skeleton._adopt(None)


class Closed(Case):
    def test_everything_asked_of_a_closed_object(self):
        objects = made()
        for one in objects:
            self.assertFalse(one.closed)
            one.close()
            one.close()  # again is fine
        for one in objects + [closed_skeleton()]:
            name = type(one).__name__
            self.assertTrue(one.closed)
            self.assertIn("closed", repr(one))
            for attribute, arguments in USES[name].items():
                with self.subTest(f"{name}.{attribute}"):
                    use = (lambda: getattr(one, attribute)) if arguments is None else getattr(one, attribute)
                    error = self.refused(Status.INVALID_HANDLE, "has been closed", use, *(arguments or ()))
                    self.assertIn(name, error.message)
            with self.assertRaises(focal.Error):
                with one:
                    pass

    def test_no_public_name_is_forgotten(self):
        for name, uses in USES.items():
            kind = getattr(focal, name)
            public = {attribute for attribute in dir(kind) if not attribute.startswith("_")} - ALIVE
            self.assertLessEqual(public, set(uses), name)

    def test_closed_arguments(self):
        closed = {type(one): one for one in made()}
        for one in closed.values():
            one.close()
        vertices, faces, marks = shape()
        uses = [
            lambda: focal.Mesh(vertices, faces, context=closed[focal.Context]),
            lambda: focal.TrainingSet(NAMES, context=closed[focal.Context]),
            lambda: focal.Model.from_bytes(model().to_bytes(), context=closed[focal.Context]),
            lambda: training_set().add(closed[focal.Mesh], marks),
            lambda: focal.TrainingSet().add_rig(closed[focal.Mesh]),
            lambda: focal.Model.train(closed[focal.TrainingSet]),
            lambda: model().detect(closed[focal.Mesh]),
            lambda: model().detect(closed[focal.Analysis]),
            lambda: model().detect(mesh(), task=closed[focal.Task]),
            lambda: detection().correspond(closed[focal.Detection]),
            lambda: detection().rig(animations=closed[focal.Mesh]),
        ]
        for use in uses:
            self.refused(Status.INVALID_HANDLE, "has been closed", use)


class Lives(Case):
    def test_with_blocks_close(self):
        for one in made():
            with one as same:
                self.assertIs(one, same)
                self.assertFalse(one.closed)
            self.assertTrue(one.closed)

    def test_any_order(self):
        context = focal.Context(thread_count=1)
        vertices, faces, marks = shape()
        marked = focal.TrainingSet(NAMES, context=context)
        surface = focal.Mesh(vertices, faces, context=context)
        marked.add(surface, marks)
        marked.add(mesh(), marks)
        trained = focal.Model.train(marked, tree_count=2, learn_confidence=False)
        found = trained.detect(surface)
        for one in (context, marked, surface, trained):
            one.close()
        self.assertEqual([landmark.name for landmark in found], NAMES)
        self.assertEqual(len(found.votes(0)), len(vertices))
        self.assertEqual(len(found.segment()), len(faces))
        found.write(pathlib.Path(self.folder()) / "found.glb")

    def test_the_last_reference_closes(self):
        objects = made()
        while objects:
            one = objects.pop()
            gone = weakref.ref(one)
            handle, kind = one._pointer, type(one)
            del one
            gc.collect()
            self.assertIsNone(gone())
            stale = kind._adopt(handle)
            with self.assertRaises(focal.Error) as caught:
                stale.close()  # the library has it no more
            self.assertIs(caught.exception.code, Status.INVALID_HANDLE)

    def test_no_copies(self):
        for one in made():
            if isinstance(one, (focal.Model, focal.Mesh, focal.Analysis, focal.Detection)):
                continue  # made again, see training_test and pickle_test
            for use in (copy.copy, copy.deepcopy, pickle.dumps):
                with self.assertRaisesRegex(TypeError, "cannot be copied or pickled"):
                    use(one)

    def test_errors_are_pickled(self):
        error = pickle.loads(pickle.dumps(focal.Error(2, "no triangles", "give a mesh")))
        self.assertEqual((error.code, error.message, error.hint), (Status.INVALID_MESH, "no triangles", "give a mesh"))
        self.assertEqual(str(error), "no triangles\nhint: give a mesh")
        self.assertEqual(focal.Error(999, "of a newer library").code, 999)


class Contexts(Case):
    def test_what_it_tells(self):
        with focal.Context(thread_count=3, backend="cpu") as context:
            self.assertEqual((context.thread_count, context.backend), (3, focal.Backend.CPU))
            self.assertTrue(context.backend_reason)
        self.refused(Status.INVALID_ARGUMENT, "thread_count", focal.Context, thread_count=1025)
        for name, value in (("thread_count", "4"), ("backend", 1.0), ("log", 3)):
            with self.assertRaisesRegex(TypeError, name):
                focal.Context(**{name: value})

    def test_memory_budget(self):
        vertices, faces, _ = shape()
        with focal.Context(memory_budget_bytes=1) as context:
            with self.assertRaisesRegex(focal.Error, "memory budget of 1 bytes") as caught:
                focal.Mesh(vertices, faces, context=context)
            self.assertEqual(caught.exception.code, Status.OUT_OF_MEMORY)
            before = context.memory_held
            with focal.Mesh(vertices, faces):  # the default context has no budget
                self.assertGreater(context.memory_held, before + 12 * len(vertices))

    def test_log(self):
        said = []
        context = focal.Context(log=lambda level, message: said.append((level, message)))
        self.assertEqual([level for level, _ in said], [focal.LogLevel.INFO])
        vertices, faces, _ = shape()
        surface = focal.Mesh(vertices, faces + [faces[0]], context=context)
        self.assertIn((focal.LogLevel.WARNING, surface.warnings[0]), said)
        context.close()
        count = len(said)
        with contextlib.suppress(focal.Error):
            focal.Mesh(vertices, faces + [faces[0]], context=context)
        self.assertEqual(len(said), count)

    def test_a_log_lives_as_long_as_what_runs_in_its_context(self):
        said = []
        trained = focal.Model.from_bytes(
            model().to_bytes(), context=focal.Context(log=lambda level, message: said.append(message)))
        gc.collect()
        vertices, faces, _ = shape()
        hole = focal.Mesh(vertices, faces[40:], context=trained._context)
        said.clear()
        found = trained.detect(hole)
        self.assertEqual(said, found.warnings[len(hole.warnings):])
        self.assertTrue(said)


if __name__ == "__main__":
    unittest.main()
