"""Meshes, detections and analyses as bytes: the same again, in this process and in another one."""
import concurrent.futures
import math
import multiprocessing
import pathlib
import pickle
import unittest

import focal
from support import NAMES, Case, detection, glb, mesh, model, numpy, rows, shape

Status = focal.Status


def again(one):
    return pickle.loads(pickle.dumps(one))


def found_elsewhere(given):
    """What another process finds on a mesh that was sent to it."""
    trained, surface = given
    return trained.detect(surface, keep_votes=False)


class Meshes(Case):
    def same(self, one, other):
        self.assertEqual(rows(other.vertices), rows(one.vertices))
        self.assertEqual(rows(other.faces), rows(one.faces))
        self.assertEqual((other.parts, other.origin, other.warnings), (one.parts, one.origin, one.warnings))
        facts = {name: value for name, value in one.info.items() if "seconds" not in name}
        self.assertEqual({name: value for name, value in other.info.items() if "seconds" not in name}, facts)

    def test_of_arrays(self):
        vertices, faces, _ = shape()
        self.same(mesh(), again(mesh()))
        self.same(mesh(), again(again(mesh())))
        for named in ({"surface": "wrapped"}, {"weld": False, "drop_degenerate": False}):
            one = focal.Mesh(vertices, faces, **named)
            self.same(one, again(one))
        damaged = focal.Mesh(vertices, [*faces, (0, 0, 1), (0, 1, 600)], lenient=True)
        self.assertEqual(rows(again(damaged).faces), rows(damaged.faces))

    def test_of_parts(self):
        vertices, faces, _ = shape()
        away = [(x + 4, y, z) for x, y, z in vertices]
        one = focal.Mesh.from_parts([(vertices, faces), (away, faces)], surface="as-is")
        self.assertEqual(len(one.parts), 2)
        self.same(one, again(one))

    def test_far_away(self):
        vertices, faces, _ = shape()
        far = [(x + 6e6, y, z - 3e6) for x, y, z in vertices]
        one = focal.Mesh(numpy.array(far) if numpy is not None else far, faces)
        self.assertGreater(one.origin[0], 5e6)
        self.same(one, again(one))

    def test_of_files(self):
        path = pathlib.Path(self.folder()) / "cat.glb"
        path.write_bytes(glb(*shape()[:2]))
        loaded = focal.Mesh.load(path)
        from_bytes = focal.Mesh.from_bytes(path.read_bytes(), keep_scenery=True)
        for one in (loaded, from_bytes):
            self.same(one, again(one))
        state = pickle.dumps(loaded)
        path.write_bytes(glb(*shape(8)[:2]))  # what was pickled before does not need the file
        self.same(loaded, pickle.loads(state))
        self.refused(Status.IO, "is not the file any more", pickle.dumps, loaded)
        path.unlink()
        self.refused(Status.IO, "is not the file any more", pickle.dumps, loaded)

    def test_written_files_are_the_same(self):
        folder = pathlib.Path(self.folder())
        (folder / "cat.glb").write_bytes(glb(*shape(16, 0.12)[:2]))
        surface = focal.Mesh.load(folder / "cat.glb")
        for name, one in (("first", surface), ("second", again(surface))):
            model().detect(one).write(folder / f"{name}.glb")
        self.assertEqual((folder / "first.glb").read_bytes(), (folder / "second.glb").read_bytes())

    def test_closed(self):
        one = mesh()
        one.close()
        self.refused(Status.INVALID_HANDLE, "has been closed", pickle.dumps, one)


class Detections(Case):
    def same(self, one, other):
        self.assertEqual(other.landmarks, one.landmarks)
        self.assertEqual((other.info, other.warnings, other.seconds), (one.info, one.warnings, one.seconds))
        self.assertEqual(repr(other), repr(one))

    def test_what_is_known_at_once(self):
        one = model().detect(mesh(), quality="interactive")
        other = again(one)
        self.assertIsNone(other._pointer)  # nothing was found again
        self.same(one, other)
        self.assertIsNone(other._pointer)
        self.assertFalse(other.closed)
        self.same(one, again(other))

    def test_what_is_made_again(self):
        one = model().detect(mesh(), fixed={"tail": shape(16, 0.12)[2][2]}, found_confidence=0.7)
        other = again(one)
        for name in NAMES:
            self.assertEqual(list(other.votes(name)), list(one.votes(name)))
        self.assertIsNotNone(other._pointer)
        self.assertEqual(list(other.segment()), list(one.segment()))
        self.same(one, other)
        first, second = again([one, model().detect(mesh(16, 0.05))])  # together they have one model
        self.assertEqual(rows(first.correspond(second).points[1]), rows(one.correspond(model().detect(mesh(16, 0.05))).points[1]))

    def test_of_an_analysis_and_of_many(self):
        analysis = model().analyse(mesh())
        for one in (model().detect(analysis), *model().detect_many([mesh(), mesh(16, 0.05)])):
            other = again(one)
            self.same(one, other)
            self.assertEqual(list(other.votes(0)), list(one.votes(0)))
        self.assertEqual(model().detect(again(analysis)).landmarks, model().detect(analysis).landmarks)

    def test_closed(self):
        other = again(detection())
        other.close()
        self.assertTrue(other.closed)
        self.refused(Status.INVALID_HANDLE, "has been closed", lambda: other.landmarks)
        self.refused(Status.INVALID_HANDLE, "has been closed", other.votes, 0)

    def test_across_processes(self):
        work = [(model(), mesh(16, variation)) for variation in (0.05, 0.12)]
        context = multiprocessing.get_context("spawn")
        with concurrent.futures.ProcessPoolExecutor(2, context) as pool:
            found = list(pool.map(found_elsewhere, work))
        for (trained, surface), one in zip(work, found):
            here = trained.detect(surface, keep_votes=False)
            self.assertEqual(one.landmarks, here.landmarks)
            self.assertTrue(all(math.isfinite(x) for x in one["nose"].position))


if __name__ == "__main__":
    unittest.main()
