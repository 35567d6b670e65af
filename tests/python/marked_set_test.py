"""Landmark files and sets: written and read, and how well models find their marks."""
import json
import math
import os
import pathlib
import subprocess
import unittest

import focal
from support import NAMES, Case, detection, glb, mesh, model, shape

QUICK = {"tree_count": 3, "learn_confidence": False}


def marked_set(folder, count=6):
    """Shapes with their marks in a folder, one mark missing."""
    marked = focal.MarkedSet(folder, NAMES, mirror={"hand.R": "hand.L"}, others={"licence": "CC0", "year": 2016})
    names = [f"shape{number}" for number in range(count)]
    marked.splits = {"train": names[:-1], "test": names[-1:]}
    marked.save()
    for number, name in enumerate(names):
        vertices, faces, marks = shape(16, 0.04 * number)
        (pathlib.Path(folder) / f"{name}.glb").write_bytes(glb(vertices, faces))
        marked.put_marks(name, dict(zip(NAMES, marks[:2] if number == 1 else marks)))
    return marked


class Files(Case):
    def path(self, name, text=None):
        path = pathlib.Path(self.folder()) / name
        if text is not None:
            path.write_text(text, encoding="utf-8")
        return path

    def test_there_and_back(self):
        marks = {"nose": 3, "鼻": focal.SurfacePoint(7, (0.25, 0.5, 0.25)), "place": (1.5, -2.0, 1e-3), "gone": None}
        path = self.path("cat.landmarks.json")
        focal.write_landmarks(path, marks, mesh="cat.glb")
        self.assertEqual(focal.read_landmarks(path), marks)
        self.assertEqual(json.loads(path.read_text(encoding="utf-8"))["mesh"], "cat.glb")
        places = {"nose": (1.0, 2.0, 3.5), 'a "b", c': (0.0, 0.0, -1.0), "gone": None}
        table = self.path("cat.csv")
        focal.write_landmarks(table, places)
        self.assertEqual(focal.read_landmarks(table), {name: place for name, place in places.items() if place})

    def test_of_a_detection(self):
        path, table = self.path("found.landmarks.json"), self.path("found.csv")
        detection().write(path)
        detection().write(table)
        for landmark in detection():
            point = focal.read_landmarks(path)[landmark.name]
            self.assertEqual(point, landmark.point)
            self.assertLess(math.dist(focal.read_landmarks(table)[landmark.name], landmark.position), 1e-6)
        self.assertLess(math.dist(mesh().position_of(focal.read_landmarks(path)["nose"]), detection()["nose"].position), 1e-6)

    def test_tables_of_others(self):
        table = self.path("t.csv", "\ufeffname,status,x,y,z\nnose,found,1,2,3\near,absent,,,\n")
        self.assertEqual(focal.read_landmarks(table), {"nose": (1, 2, 3), "ear": None})

    def test_what_is_no_landmark_file(self):
        head = '{"format": "focal-landmarks", "landmarks": ['
        for text, said in (("[]", "format"), ("{", ""), ('{"format": "x"}', "format"), (head + '{"vertex": 1}]}', "name"),
                           (head + '{"name": "a"}]}', "no vertex"), (head + '{"name": "a", "vertex": -1}]}', "whole number"),
                           (head + '{"name": "a", "vertex": true}]}', "whole number"), (head + '{"name": "", "vertex": 1}]}', "no name"),
                           (head + '{"name": "a", "vertex": 1}, {"name": "a", "vertex": 2}]}', "twice"),
                           (head + '{"name": "a", "position": [1, 2]}]}', ""), (head + '{"name": "a", "position": [1, 2, NaN]}]}', "finite"),
                           (head[:-1] + '3}', ""), (head.replace(",", ', "version": 2,', 1) + "]}", "newer")):
            with self.subTest(text), self.assertRaisesRegex(ValueError, f"bad.landmarks.json is not a landmark file: .*{said}"):
                focal.read_landmarks(self.path("bad.landmarks.json", text))
        with self.assertRaisesRegex(ValueError, "columns name, x, y and z"):
            focal.read_landmarks(self.path("bad.csv", "nose,1,2,3\n"))
        self.assertRaises(OSError, focal.read_landmarks, self.path("none.landmarks.json"))

    def test_what_cannot_be_written(self):
        with self.assertRaisesRegex(ValueError, "the mark of 'nose' is no position"):
            focal.write_landmarks(self.path("a.csv"), {"nose": 3})
        for name in ("a.mrk.json", "a.txt", "a"):
            with self.assertRaisesRegex(ValueError, "ends in none of"):
                focal.write_landmarks(self.path(name), {"nose": (1, 2, 3)})


class Sets(Case):
    def test_there_and_back(self):
        folder = self.folder()
        made, read = marked_set(folder), focal.MarkedSet.load(folder)
        self.assertEqual((read.landmark_names, read.splits, read.mirror, read.others),
                         (made.landmark_names, made.splits, made.mirror, made.others))
        self.assertEqual(read.name, pathlib.Path(folder).name)
        self.assertEqual(read.marks("shape1")["tail"], None)
        self.assertEqual(read.marks("shape0"), dict(zip(NAMES, shape()[2])))
        self.assertEqual((read.meshes("all"), read.meshes("extra")), ([f"shape{i}" for i in range(6)], []))
        self.assertEqual(read.training_set().mesh_count, 5)
        before = (pathlib.Path(folder) / "set.json").read_bytes()
        read.save()
        self.assertEqual(json.loads(before), {**json.loads((pathlib.Path(folder) / "set.json").read_bytes())})

    def test_what_is_no_set(self):
        folder = pathlib.Path(self.folder())
        self.assertRaises(OSError, focal.MarkedSet.load, folder)
        for text in ("{}", "[]", "{", '{"landmark_names": "nose"}', '{"landmark_names": []}', '{"landmark_names": ["a"], "train": "b"}'):
            (folder / "set.json").write_text(text)
            with self.assertRaisesRegex(ValueError, "describes no set"):
                focal.MarkedSet.load(folder)
        marked = marked_set(folder)
        for use in (lambda: marked.put_marks("shape0", {"nse": 3}), lambda: marked.meshes("tset"),
                    lambda: marked.cross_validate("test"), lambda: marked.cross_validate(folds=9), lambda: marked.cross_validate(folds=1)):
            self.assertRaises(ValueError, use)

    def test_evaluation(self):
        marked, reports = marked_set(self.folder()), []
        result = marked.evaluate(model(), on_progress=lambda *state: reports.append(state))
        self.assertEqual([(one.mesh, one.landmark) for one in result.errors], [("shape5", name) for name in NAMES])
        surface, found = marked.mesh("shape5"), model().detect(marked.mesh("shape5"))
        for one in result.errors:
            place = [float(x) for x in surface.vertices[marked.marks("shape5")[one.landmark]]]
            self.assertAlmostEqual(one.error, math.dist(place, found[one.landmark].position), 5)
            self.assertAlmostEqual(one.edges, one.error / surface.info["mean_edge_length"], 5)
        self.assertAlmostEqual(result.mean_edges, sum(one.edges for one in result.errors) / 3)
        self.assertEqual(list(result.by_landmark()), NAMES)
        self.assertEqual(result.by_mesh()["shape5"].errors, result.errors)
        self.assertRegex(repr(result), r"^<focal\.Evaluation 3 marks, mean \d\.\d\d edges, median \d\.\d\d>$")
        self.assertEqual(reports[-1][0], 1)
        self.assertEqual(len(marked.evaluate(model(), ["shape1"]).errors), 2)  # a mark that is missing has no error
        self.assertTrue(math.isnan(focal.Evaluation([]).mean_edges))

    def test_cross_validation(self):
        marked, reports = marked_set(self.folder()), []
        result = marked.cross_validate(folds=2, train=QUICK, on_progress=lambda *state: reports.append(state))
        self.assertEqual([one.mesh for one in result.errors], [name for name in marked.meshes() for _ in range(2 if name == "shape1" else 3)])
        self.assertEqual([state[0] for state in reports], sorted(state[0] for state in reports))
        self.assertEqual(reports[-1][0], 1)
        without = focal.Model.train(marked.training_set(["shape3", "shape4"]), **QUICK)
        self.assertEqual(marked.evaluate(without, ["shape0", "shape1", "shape2"]).errors, result.errors[:8])

        def stop(progress, stage):
            raise KeyError(stage)

        self.assertRaises(KeyError, marked.cross_validate, on_progress=stop)

    @unittest.skipUnless(os.environ.get("FOCAL_COMMAND"), "FOCAL_COMMAND names no focal command")
    def test_the_command_says_the_same(self):
        marked = marked_set(self.folder())
        said = subprocess.run([os.environ["FOCAL_COMMAND"], "cross-validate", marked.folder, "--folds", "4", "--trees", "3", "--json", "--quiet"],
                              check=True, capture_output=True, text=True)
        report = json.loads(said.stdout)
        result = marked.cross_validate(folds=4, train={"tree_count": 3})
        self.assertEqual(report["folds"], 4)
        self.assertAlmostEqual(report["mean_edges"], result.mean_edges, 5)
        self.assertAlmostEqual(report["median_edges"], result.median_edges, 5)


if __name__ == "__main__":
    unittest.main()
