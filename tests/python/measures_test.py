"""What training learns from: descriptors, distances, the symmetry plane, regressed distances."""
import math
import unittest

import focal
from support import Case, mesh, model, shape

Status = focal.Status


def width_of(values):
    return len(values[0])


class Measures(Case):
    def test_vertices_are_described_alike_in_any_order(self):
        made = mesh()
        for name in focal.descriptors():
            few = made.describe([5, 90], name)
            other = made.describe([90, 5], name)
            self.assertEqual([list(row) for row in few], [list(row) for row in other][::-1])
            self.assertTrue(all(math.isfinite(value) for row in few for value in row))
        self.assertEqual(width_of(made.describe([1])), width_of(made.describe([1], focal.Descriptor.SI_HKS)))

    def test_distances_grow_from_their_source(self):
        made = mesh()
        source = made.vertices[40]
        for name in focal.distances():
            values = made.distances(40, name)
            self.assertEqual(len(values), made.vertex_count)
            self.assertEqual(min(range(len(values)), key=lambda v: values[v]), 40)
        exact = made.distances(made.point_at_vertex(40), focal.Distance.EXACT)
        for vertex, position in enumerate(made.vertices):
            self.assertGreaterEqual(exact[vertex], 0.9999 * math.dist(position, source) - 1e-5)

    def test_the_plane_mirrors_the_shape(self):
        vertices, faces, _ = shape()
        image = [(-6 - x, y, z) for x, y, z in vertices]
        count = len(vertices)
        plane = focal.Mesh(vertices + image, faces + [(count + a, count + c, count + b) for a, b, c in faces]).symmetry_plane()
        self.assertAlmostEqual(abs(plane.normal[0]), 1, places=2)
        self.assertAlmostEqual(plane.offset * plane.normal[0], -3, places=1)
        self.assertTrue(0.9 < plane.support <= 1)

    def test_regressed_beside_true_distances(self):
        made, learned = mesh(), model()
        mark = shape(16, 0.12)[2][0]
        told, true = learned.regress(learned.analyse(made), "nose", mark)
        self.assertEqual(len(told), len(true))
        self.assertLess(sum(abs(a - b) for a, b in zip(told, true)) / len(told), 0.2)
        self.assertRaises(KeyError, learned.regress, learned.analyse(made), "beak", mark)

    def test_what_is_none_is_refused(self):
        made = mesh()
        self.assertRaises(ValueError, made.describe, [0], "smell")
        self.assertRaises(ValueError, made.distances, 0, "far")
        self.refused(Status.INVALID_ARGUMENT, "", made.describe, [0], 99)
        self.refused(Status.INVALID_LANDMARK, "", made.describe, [made.vertex_count])
        self.refused(Status.INVALID_LANDMARK, "", made.distances, made.vertex_count)
        task = focal.Task()
        task.cancel()
        self.assertRaises(focal.Cancelled, made.symmetry_plane, task=task)
        self.assertRaises(focal.Cancelled, made.distances, 0, task=task)


if __name__ == "__main__":
    unittest.main()
