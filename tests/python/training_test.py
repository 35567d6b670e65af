"""Training sets and models: marks of every kind, parameters, files."""
import inspect
import pathlib
import pickle
import unittest

import focal
from focal import _abi
from support import NAMES, Case, mesh, model, numpy, shape, training_set

Status = focal.Status
QUICK = {"tree_count": 3, "learn_confidence": False}


class Marks(Case):
    def setUp(self):
        self.set, self.mesh, self.marks = focal.TrainingSet(NAMES), mesh(), shape(16, 0.12)[2]

    def test_every_way_to_mark(self):
        points = [self.mesh.point_at_vertex(mark) for mark in self.marks]
        ways = [self.marks, tuple(self.marks), points, [self.marks[0], points[1], None],
                dict(zip(NAMES, self.marks)), dict(zip(NAMES, points)), {"tail": self.marks[2]}, {},
                [(points[0].triangle, list(points[0].barycentric)), None, None]]
        if numpy is not None:
            ways += [numpy.array(self.marks), numpy.array(self.marks, numpy.uint16), [numpy.int64(3), None, points[0]]]
        for count, marks in enumerate(ways):
            self.assertEqual(self.set.mesh_count, count)
            self.set.add(self.mesh, marks)
        self.assertEqual(self.set.landmark_names, NAMES)

    def test_vertices_and_their_points_teach_the_same(self):
        made = []
        for as_points in (False, True):
            marked = focal.TrainingSet(NAMES)
            for variation in (0, 0.05, 0.1):
                one, marks = mesh(16, variation), shape(16, variation)[2]
                marked.add(one, [one.point_at_vertex(mark) for mark in marks] if as_points else marks)
            made.append(focal.Model.train(marked, **QUICK).to_bytes())
        self.assertEqual(made[0], made[1])

    def test_wrong_marks_leave_the_set_as_it_was(self):
        point = self.mesh.point_at_vertex(0)
        for kind, marks in ((ValueError, self.marks[:2]), (ValueError, [*self.marks, 0]), (ValueError, {"nse": 3}),
                            (ValueError, [-1, 0, 0]), (ValueError, [2**32, 0, 0]), (TypeError, "abc"),
                            (TypeError, None), (TypeError, 3), (TypeError, ["a", 0, 0]), (TypeError, [0.5, 0, 0]),
                            (TypeError, [(1, "a", 3), 0, 0]), (ValueError, [(0, (1, 0)), 0, 0]),
                            (TypeError, [(1, 2), 0, 0]), (ValueError, [(0, (1, 0)), 0, 0]),
                            (TypeError, [("a", (1, 0, 0)), 0, 0]), (TypeError, [(0, (None, 0, 0)), 0, 0])):
            with self.assertRaises(kind, msg=str(marks)):
                self.set.add(self.mesh, marks)
        self.refused(Status.INVALID_LANDMARK, "nose", self.set.add, self.mesh, [514, 0, 0])
        self.refused(Status.INVALID_LANDMARK, "", self.set.add, self.mesh, [(9999, (1, 0, 0)), None, None])
        self.refused(Status.INVALID_LANDMARK, "", self.set.add, self.mesh, [(0, (-1, 0, 0)), None, point])
        for wrong in ("mesh", None, self.set):
            with self.assertRaisesRegex(TypeError, "mesh must be a focal.Mesh"):
                self.set.add(wrong, self.marks)
            with self.assertRaisesRegex(TypeError, "mesh must be a focal.Mesh"):
                focal.TrainingSet().add_rig(wrong)
        self.assertEqual(self.set.mesh_count, 0)

    def test_names(self):
        for kind, names in ((TypeError, "nose"), (TypeError, [1]), (TypeError, [None]), (ValueError, []),
                            (ValueError, ["a\0b"])):
            with self.assertRaises(kind):
                focal.TrainingSet(names)
        self.refused(Status.INVALID_ARGUMENT, "", focal.TrainingSet, ["nose", "nose"])
        self.refused(Status.INVALID_ARGUMENT, "", focal.TrainingSet, [""])
        self.assertEqual(focal.TrainingSet(["Nase links", "鼻"]).landmark_names, ["Nase links", "鼻"])

    def test_rigs_need_a_skin_and_a_set_without_names(self):
        self.refused(Status.INVALID_ARGUMENT, "landmark names", self.set.add_rig, self.mesh)
        self.refused(Status.INVALID_ARGUMENT, "glTF file", focal.TrainingSet().add_rig, self.mesh)


class Training(Case):
    def test_model(self):
        made = model()
        self.assertEqual(made.landmark_names, NAMES)
        self.assertEqual(made.joint_names, [])
        self.assertEqual((made.info["landmark_count"], made.info["shape_count"]), (3, 4))
        self.assertIs(made.info["preset"], focal.Preset.DEFAULT)
        self.assertEqual(made.info["file_bytes"], len(made.to_bytes()))

    def test_parameters_arrive(self):
        given = {"eigenpair_count": 60, "tree_count": 2, "min_leaf_samples": 6, "components_per_split": 4,
                 "sampling_rate": 0.9, "max_samples_per_shape": 300, "proxy_vertices": 400, "seed": 2**63,
                 "learn_confidence": 0}
        kept = focal.Model.train(training_set(count=2), **given).train_params
        self.assertEqual({name: kept[name] for name in given}, given)
        self.assertIs(kept["preset"], focal.Preset.DEFAULT)

    def test_presets(self):
        for preset in ("paper", "PAPER", focal.Preset.PAPER, 1):
            made = focal.Model.train(training_set(count=2), preset=preset, tree_count=1)
            self.assertEqual((made.train_params["preset"], made.train_params["eigenpair_count"]),
                             (focal.Preset.PAPER, 200))
        with self.assertRaisesRegex(ValueError, "one of: default, paper"):
            focal.Model.train(training_set(count=2), preset="papers")
        with self.assertRaisesRegex(TypeError, "focal.Preset"):
            focal.Model.train(training_set(count=2), preset=1.0)

    def test_descriptors_and_distances(self):
        self.assertEqual(focal.descriptors()[focal.Descriptor.SPIN_IMAGE], "spin-image")
        self.assertEqual(focal.distances()[focal.Distance.COMMUTE_TIME], "commute-time")
        for descriptor in ("WKS", "wks", focal.Descriptor.WKS, 2):
            made = focal.Model.train(training_set(count=2), preset="paper", tree_count=1, descriptor=descriptor,
                                     distance="commute_time")
            self.assertEqual((made.train_params["descriptor"], made.train_params["distance"]), ("wks", "commute-time"))
        with self.assertRaisesRegex(ValueError, "one of: si-hks, hks"):
            focal.Model.train(training_set(count=2), descriptor="curvature")
        with self.assertRaisesRegex(focal.Error, "geodesic"):
            focal.Model.train(training_set(count=2), distance="biharmonic")

    def test_every_parameter_of_the_header_has_a_keyword(self):
        keywords = {
            _abi.focal_train_params: [focal.Model.train], _abi.focal_detect_params: [focal.Model.detect],
            _abi.focal_mesh_params: [focal.Mesh.load], _abi.focal_skeleton_params: [focal.Detection.rig],
            _abi.focal_context_params: [focal.Context.__init__]}
        ours = {"struct_size", "reserved", "reserved_2", "joint_name_count", "fixed_joint_count", "log_user_data",
                "fixed_points", "fixed_point_count",  # fixed says both
                "parallel_for", "parallel_for_user_data"}  # Python has no parallel loop to offer
        for struct, functions in keywords.items():
            for function in functions:
                missing = {name for name, _ in struct._fields_} - ours - set(inspect.signature(function).parameters)
                self.assertEqual(missing, set(), f"{function.__qualname__} lacks fields of {struct.__name__}")

    def test_wrong_parameters(self):
        marked = training_set(count=2)
        for name, value, kind in (("tree_count", "3", TypeError), ("tree_count", 3.0, TypeError),
                                  ("tree_count", 2**31, ValueError), ("seed", -1, ValueError),
                                  ("sampling_rate", "1", TypeError), ("task", "task", TypeError),
                                  ("on_progress", 3, TypeError)):
            with self.assertRaisesRegex(kind, name):
                focal.Model.train(marked, **{name: value})
        self.refused(Status.INVALID_ARGUMENT, "tree_count is 0", focal.Model.train, marked, tree_count=0)
        self.refused(Status.INVALID_ARGUMENT, "sampling_rate", focal.Model.train, marked, sampling_rate=float("nan"))
        self.refused(Status.TOO_FEW_SHAPES, "", focal.Model.train, training_set(count=1))
        with self.assertRaisesRegex(TypeError, "training_set must be a focal.TrainingSet"):
            focal.Model.train([mesh()])

    def test_same_seed_same_model(self):
        one, same, other = (focal.Model.train(training_set(count=2), seed=seed, **QUICK).to_bytes()
                            for seed in (1, 1, 2))
        self.assertEqual(one, same)
        self.assertNotEqual(one, other)


class Files(Case):
    def test_there_and_back(self):
        path = pathlib.Path(self.folder()) / "Tier 動物.focal"
        model().save(path)
        data = path.read_bytes()
        self.assertEqual(data, model().to_bytes())
        for made in (focal.Model.load(path), focal.Model.load(str(path)), focal.Model.from_bytes(data),
                     focal.Model.from_bytes(memoryview(data)), pickle.loads(pickle.dumps(model()))):
            self.assertEqual(made.to_bytes(), data)
            self.assertEqual(made.landmark_names, NAMES)

    def test_damage(self):
        folder, data = pathlib.Path(self.folder()), model().to_bytes()
        self.refused(Status.INVALID_FILE, "", focal.Model.from_bytes, data[:-10])
        self.refused(Status.INVALID_FILE, "", focal.Model.from_bytes, data[:5000] + b"?" + data[5001:])
        self.refused(Status.INVALID_FILE, "", focal.Model.from_bytes, b"")
        self.refused(Status.FILE_NOT_FOUND, "none.focal", focal.Model.load, folder / "none.focal")
        self.refused(Status.FILE_NOT_FOUND, "", model().save, folder / "none" / "a.focal")
        for wrong in (None, 3):
            with self.assertRaises(TypeError):
                focal.Model.load(wrong)
            with self.assertRaises(TypeError):
                focal.Model.from_bytes(wrong)
            with self.assertRaises(TypeError):
                model().save(wrong)
        with self.assertRaisesRegex(TypeError, "Model.train, Model.load"):
            focal.Model()


if __name__ == "__main__":
    unittest.main()
