"""Landmarks found, and all that follows from them: maps, regions, parts, correspondence, files."""
import json
import math
import pathlib
import struct
import unittest

import focal
from support import NAMES, Case, detection, glb, mesh, model, numpy, rows, shape, training_set

Status = focal.Status


def gltf_json(data):
    return json.loads(data[20:20 + struct.unpack_from("<I", data, 12)[0]])


class Landmarks(Case):
    def test_repr(self):
        found = detection()
        self.assertRegex(repr(found), r"^<focal\.Detection \d+ of 3 landmarks, category fit [01]\.\d\d>$")
        self.assertRegex(repr(mesh()), r"^<focal\.Mesh \d+ vertices, \d+ triangles>$")
        self.assertEqual(repr(model()), "<focal.Model 3 landmarks>")
        self.assertEqual(repr(training_set()), "<focal.TrainingSet 3 landmarks, 4 meshes>")
        self.assertEqual(repr(focal.TrainingSet()), "<focal.TrainingSet rigged characters, 0 meshes>")
        self.assertRegex(repr(focal.Context(thread_count=2)), r"^<focal\.Context c\w+, 2 threads>$")
        self.assertRegex(repr(model().analyse(mesh())), r"^<focal\.Analysis 514 vertices, \d+ samples>$")
        self.assertEqual(repr(found.correspond(found)), "<focal.Correspondence from 514 to 514 vertices>")
        task = focal.Task()
        self.assertEqual(repr(task), "<focal.Task 0%>")
        task.cancel()
        self.assertEqual(repr(task), "<focal.Task cancelled>")

    def test_found_where_they_are(self):
        truth = dict(zip(NAMES, shape(16, 0.12)[2]))
        found, surface = detection(), mesh()
        self.assertEqual([landmark.name for landmark in found], NAMES)
        self.assertEqual(len(found), 3)
        for landmark in found.landmarks:
            at = [float(x) for x in surface.vertices[truth[landmark.name]]]
            self.assertLess(math.dist(landmark.position, at), 3 * surface.info["mean_edge_length"], landmark)
            self.assertEqual(landmark.status, focal.LandmarkStatus.FOUND)
            self.assertTrue(landmark.found and not landmark.absent)
            self.assertTrue(0 <= landmark.confidence <= 1 and landmark.expected_error > 0)
            self.assertAlmostEqual(sum(landmark.barycentric), 1, 5)
            for place, near in zip(landmark.position, surface.position_of(landmark.point)):
                self.assertAlmostEqual(place, near, 5)
            self.assertEqual(landmark.triangle, landmark.point.triangle)
            self.assertIn(landmark.vertex, range(surface.vertex_count))

    def test_by_name_and_number(self):
        found = detection()
        self.assertEqual(found["tail"], found[2])
        self.assertEqual(found[-1], found[2])
        self.assertRaises(KeyError, found.__getitem__, "tial")
        self.assertRaises(IndexError, found.__getitem__, 3)
        self.assertRaises(IndexError, found.__getitem__, -4)
        for wrong in (1.0, None, b"tail"):
            with self.assertRaisesRegex(TypeError, "name or number"):
                found.votes(wrong)

    def test_absent_landmarks_have_no_place_or_say_so(self):
        found = model().detect(mesh(), found_confidence=1, absent_confidence=1)
        self.assertTrue(all(landmark.absent and not landmark.found for landmark in found))
        self.assertTrue(any(landmark.runner_up for landmark in found))
        second = next(landmark.runner_up for landmark in found if landmark.runner_up)
        self.assertEqual((len(second.position), len(second.point.barycentric)), (3, 3))

    def test_it_tells(self):
        found = detection()
        self.assertEqual((found.info["vertex_count"], found.info["triangle_count"]), (514, 1024))
        self.assertEqual(found.info["has_votes"], 1)
        self.assertIn(found.info["backend"], (focal.Backend.CPU, focal.Backend.CUDA))  # where a GPU is
        self.assertTrue(0 <= found.category_fit <= 1)
        self.assertGreater(found.seconds["total"], 0)
        self.assertEqual(len(found.warnings), found.info["warning_count"])

    def test_parameters(self):
        for quality in ("interactive", focal.Quality.BEST, "Best"):
            self.assertEqual(len(model().detect(mesh(), quality=quality)), 3)
        with self.assertRaisesRegex(ValueError, "quality is 'good', not one of: best, interactive"):
            model().detect(mesh(), quality="good")
        self.refused(Status.INVALID_ARGUMENT, "found_confidence", model().detect, mesh(), found_confidence=2)
        self.refused(Status.INVALID_ARGUMENT, "peaks_per_landmark", model().detect, mesh(), peaks_per_landmark=65)
        for wrong in (None, "cat.glb", model()):
            with self.assertRaisesRegex(TypeError, "mesh must be a focal.Mesh"):
                model().detect(wrong)
            with self.assertRaisesRegex(TypeError, "mesh must be a focal.Mesh"):
                model().analyse(wrong)

    def test_many_at_once_are_the_same(self):
        meshes = [mesh(), mesh(16, 0.05)]
        reports = []
        many = model().detect_many(meshes, keep_votes=False, on_progress=lambda *state: reports.append(state))
        self.assertEqual(reports[-1], (1, "2 of 2 meshes"))
        for progress, stage in reports:
            self.assertEqual(stage, f"{round(2 * progress)} of 2 meshes")
        for found, one in zip(many, meshes):
            self.assertEqual([mark.position for mark in found], [mark.position for mark in model().detect(one)])
        self.assertEqual(model().detect_many([]), [])
        with self.assertRaisesRegex(TypeError, "meshes must be a focal.Mesh"):
            model().detect_many([mesh(), None])

    def test_places_that_are_known_stay(self):
        surface, truth = mesh(), shape(16, 0.12)[2]
        at = surface.point_at_vertex(truth[1])
        analysis = model().analyse(surface)
        for target in (surface, analysis):
            for known in (truth[1], at):
                found = model().detect(target, fixed={NAMES[1]: known})
                self.assertEqual((found[1].confidence, found[1].status), (1, focal.LandmarkStatus.FOUND))
                self.assertLess(math.dist(found[1].position, surface.position_of(at)), 1e-6)
                for number in (0, 2):
                    place = [float(x) for x in surface.vertices[truth[number]]]
                    self.assertLess(math.dist(found[number].position, place), 3 * surface.info["mean_edge_length"])
        self.assertEqual(model().detect(surface, fixed={}).landmarks, model().detect(surface).landmarks)
        with self.assertRaisesRegex(ValueError, "'beak' is no landmark of this model"):
            model().detect(surface, fixed={"beak": 0})
        with self.assertRaisesRegex(TypeError, "fixed place"):
            model().detect(surface, fixed={NAMES[0]: "nose"})
        self.refused(Status.INVALID_LANDMARK, "", model().detect, surface,
                     fixed={NAMES[0]: focal.SurfacePoint(10**6, (1, 0, 0))})

    def test_analysis_serves_many_models_and_keeps(self):
        surface = mesh()
        path = pathlib.Path(self.folder()) / "mesh.analysis"
        model().analyse(surface).save(path)
        back = focal.Analysis.load(surface, path)
        self.assertEqual(model().detect(back).landmarks, model().detect(surface).landmarks)
        other = focal.Model.train(training_set(), tree_count=2, learn_confidence=False)
        self.assertEqual(len(other.detect(back)), 3)
        self.refused(Status.INVALID_FILE, "", focal.Analysis.load, mesh(14), path)
        unlike = focal.Model.train(training_set(count=2), tree_count=1, learn_confidence=False, eigenpair_count=40)
        self.refused(Status.INVALID_ARGUMENT, "", unlike.detect, back)


class Fields(Case):
    def test_votes_distances_and_regions(self):
        found, area = detection(), mesh().surface_area
        votes, distances = list(found.votes("nose")), list(found.distances("nose"))
        self.assertEqual((len(votes), len(distances)), (514, 514))
        self.assertEqual((max(votes), min(votes) >= 0), (1, True))
        self.assertLess(min(distances), mesh().info["mean_edge_length"])
        inside = list(found.region("nose", 0.2))
        for distance, value in zip(distances, inside):
            if abs(distance - 0.2 * math.sqrt(area)) > mesh().info["mean_edge_length"]:
                self.assertEqual(value, distance < 0.2 * math.sqrt(area))
        if numpy is not None:
            self.assertEqual((found.votes(0).dtype, found.distances(0).shape), (numpy.float32, (514,)))
        self.refused(Status.INVALID_ARGUMENT, "radius", found.region, "nose", -1)
        self.assertRaises(TypeError, found.region, "nose", "0.2")

    def test_votes_that_were_not_kept(self):
        found = model().detect(mesh(), keep_votes=False)
        self.refused(Status.UNSUPPORTED, "", found.votes, 0)
        self.refused(Status.UNSUPPORTED, "", found.write_votes, pathlib.Path(self.folder()) / "votes.glb")

    def test_parts(self):
        for method in ("auto", "geodesic", "k-means", focal.Segmentation.K_MEANS):
            labels = [int(label) for label in detection().segment(method)]
            self.assertEqual((len(labels), set(labels)), (1024, {0, 1, 2}))
        self.refused(Status.INVALID_ARGUMENT, "", detection().segment, "skeleton")
        with self.assertRaisesRegex(ValueError, "method is 'parts', not one of: auto, geodesic, k_means, skeleton"):
            detection().segment("parts")

    def test_correspondence(self):
        source, other = detection(), mesh(14, 0.02)
        found = source.correspond(model().detect(other))
        triangles, weights = found.points
        self.assertEqual((len(triangles), len(weights), len(weights[0])), (514, 514, 3))
        carried = rows(found.carry(other.vertices))
        for vertex in range(0, 514, 50):
            at = other.position_of((int(triangles[vertex]), [float(w) for w in weights[vertex]]))
            for x, y in zip(carried[vertex], at):
                self.assertAlmostEqual(float(x), y, 4)
        ones = list(found.carry([1] * other.vertex_count))
        self.assertEqual((len(ones), round(min(ones), 5), round(max(ones), 5)), (514, 1, 1))
        for wrong, kind in (([1, 2], ValueError), ("text", TypeError), (None, TypeError),
                            ([(1, 2)] * 3, ValueError), (["a"] * other.vertex_count, TypeError)):
            self.assertRaises(kind, found.carry, wrong)
        with self.assertRaisesRegex(TypeError, "target must be a focal.Detection"):
            source.correspond(other)
        foreign = focal.Model.train(training_set(count=2), tree_count=1, learn_confidence=False).detect(mesh())
        self.refused(Status.INVALID_ARGUMENT, "", source.correspond, foreign)

    def test_rig_needs_a_skeleton(self):
        self.refused(Status.INVALID_ARGUMENT, "rigged", detection().rig)


class Placed(Case):
    def test_marks_and_fixed_places_may_be_positions(self):
        given = mesh()
        place = tuple(float(x) for x in given.vertices[7])
        found = model().detect(given, fixed={NAMES[0]: place})
        for axis in range(3):
            self.assertAlmostEqual(found[NAMES[0]].position[axis], place[axis], 4)
        for wrong, kind in (((1, 2), TypeError), ((1, 2, "x"), TypeError), ("abc", TypeError)):
            with self.assertRaises(kind):
                model().detect(given, fixed={NAMES[0]: wrong})


class Written(Case):
    def test_files(self):
        folder = pathlib.Path(self.folder())
        source = folder / "mesh.glb"
        source.write_bytes(glb(*shape(16, 0.12)[:2]))
        found = model().detect(focal.Mesh.load(source))
        found.write(folder / "marked.glb")
        marked = gltf_json((folder / "marked.glb").read_bytes())
        self.assertLessEqual(set(NAMES), {node.get("name") for node in marked["nodes"]})
        found.write_votes(folder / "votes.glb")
        found.write_segments(str(folder / "parts.glb"), "geodesic")
        for name in ("votes.glb", "parts.glb"):
            attributes = gltf_json((folder / name).read_bytes())["meshes"][0]["primitives"][0]["attributes"]
            self.assertIn("COLOR_0", attributes)
        found.write(folder / "MARKED.GLB")
        self.assertEqual((folder / "MARKED.GLB").read_bytes(), (folder / "marked.glb").read_bytes())
        found.write(folder / "found.landmarks.json")
        written = json.loads((folder / "found.landmarks.json").read_text("utf-8"))
        self.assertEqual((written["format"], written["version"]), ("focal-landmarks", 1))
        self.assertEqual([one["name"] for one in written["landmarks"]], list(NAMES))
        self.assertEqual(written["landmarks"][0]["triangle"], found[0].triangle)
        found.write(folder / "found.csv")
        lines = (folder / "found.csv").read_text("utf-8").splitlines()
        self.assertEqual(lines[0], "name,x,y,z")
        self.assertEqual(len(lines), 1 + sum(not one.absent for one in found))
        for wrong in ("found.obj", "found", "found.mrk.json"):
            self.assertRaises(ValueError, found.write, folder / wrong)
        self.refused(Status.INVALID_ARGUMENT, "", found.write, folder / "marked.gltf")
        self.refused(Status.FILE_NOT_FOUND, "", found.write, folder / "none" / "marked.glb")
        for write in (found.write, found.write_votes, found.write_segments):
            self.assertRaises(TypeError, write, None)


if __name__ == "__main__":
    unittest.main()
