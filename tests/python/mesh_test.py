"""Meshes from arrays of every kind, from files and from memory; what is no mesh by its type or shape stays outside."""
import array
import decimal
import pathlib
import unittest

import focal
from support import Case, glb, mesh, numpy, rows, shape

Status = focal.Status


class Arrays(Case):
    def setUp(self):
        self.vertices, self.faces, _ = shape()
        flat = array.array("f", [x for vertex in self.vertices for x in vertex])
        self.expected = list(zip(*[iter(flat)] * 3))  # as 32-bit floats

    def same(self, vertices, faces):
        made = focal.Mesh(vertices, faces)
        self.assertEqual(rows(made.vertices), rows(self.expected))
        self.assertEqual(rows(made.faces), rows(self.faces))

    def test_parts(self):
        one = mesh()
        vertices, faces = rows(one.vertices), rows(one.faces)
        moved = [(x + 0.25, y, z) for x, y, z in vertices]
        both = focal.Mesh.from_parts([(vertices, faces), (moved, faces)])
        self.assertEqual(both.vertex_count, 2 * len(vertices))
        first, second = both.parts
        self.assertEqual(first, (range(0, len(vertices)), range(0, len(faces))))
        self.assertEqual(second.vertices, range(len(vertices), 2 * len(vertices)))
        self.assertEqual(rows(both.faces)[len(faces)], [v + len(vertices) for v in faces[0]])
        self.assertEqual(len(one.parts), 1)
        with self.assertRaises(focal.Error):
            focal.Mesh.from_parts([])
        with self.assertRaisesRegex(ValueError, "shape|rows of 3"):
            focal.Mesh.from_parts([([(0, 0)], faces)])

    def test_rows_flat_numbers_and_buffers_give_the_same_mesh(self):
        flat_vertices = [x for vertex in self.vertices for x in vertex]
        flat_faces = [x for face in self.faces for x in face]
        self.same(self.vertices, self.faces)
        self.same(flat_vertices, flat_faces)
        self.same(array.array("f", flat_vertices), array.array("I", flat_faces))
        self.same(array.array("d", flat_vertices), array.array("q", flat_faces))
        self.same(memoryview(array.array("f", flat_vertices)), memoryview(array.array("i", flat_faces)))
        two = memoryview(array.array("f", flat_vertices)).cast("B").cast("f", (len(self.vertices), 3))
        self.same(two, [tuple(face) for face in self.faces])

    def test_leniently_what_is_invalid_is_left_out_and_told(self):
        vertices, faces = [list(vertex) for vertex in self.vertices], [list(face) for face in self.faces]
        vertices[30][1] = float("nan")
        faces[0][2] = len(vertices)
        self.refused(Status.INVALID_MESH, "", focal.Mesh, vertices, faces)
        made = focal.Mesh(vertices, faces, lenient=True)
        expected = 1 + sum(30 in face for face in faces[1:])
        self.assertEqual(made.info["invalid_triangles"], expected)
        self.assertEqual(made.info["is_oriented"], 1)
        self.assertEqual(made.info["surface_triangle_count"], len(faces) - expected)

    def test_a_ground_is_left_out_unless_it_is_kept(self):
        n = len(self.vertices)
        vertices = [*self.vertices, (-50, -20, -50), (50, -20, -50), (-50, -20, 50), (50, -20, 50)]
        faces = [*self.faces, (n, n + 2, n + 1), (n + 1, n + 2, n + 3)]
        made = focal.Mesh(vertices, faces)
        self.assertEqual(made.left_out, [focal.LeftOut("the mesh", focal.Scenery.SHEET, 2, False)])
        self.assertEqual(made.info["surface_triangle_count"], len(self.faces))
        self.assertIn("a flat sheet", made.warnings[0])
        kept = focal.Mesh(vertices, faces, keep_scenery=True)
        self.assertEqual((kept.left_out, kept.info["component_count"]), ([], 2))

    @unittest.skipIf(numpy is None, "no NumPy")
    def test_arrays_of_every_layout(self):
        vertices, faces = numpy.array(self.vertices), numpy.array(self.faces)
        for kind in (numpy.float32, numpy.float64, ">f4"):
            for number in (numpy.int32, numpy.uint32, numpy.int64, numpy.uint16):
                self.same(vertices.astype(kind), faces.astype(number))
        self.same(numpy.asfortranarray(vertices), numpy.asfortranarray(faces))
        self.same(numpy.repeat(vertices, 2, axis=0)[::2], numpy.hstack([faces, faces])[:, :3])
        frozen = vertices.astype(numpy.float32)
        frozen.flags.writeable = False
        self.same(frozen, faces)

    @unittest.skipIf(numpy is None, "no NumPy")
    def test_arrays_come_out_with_numpy(self):
        made = mesh()
        self.assertEqual((made.vertices.dtype, made.vertices.shape), (numpy.float32, (made.vertex_count, 3)))
        self.assertEqual((made.faces.dtype, made.faces.shape), (numpy.uint32, (made.triangle_count, 3)))
        mine = made.vertices
        mine[:] = 7  # a copy: the mesh never changes
        self.assertNotEqual(float(made.vertices[0, 2]), 7)

    @unittest.skipIf(numpy is not None, "NumPy is here")
    def test_lists_come_out_without_numpy(self):
        made = mesh()
        self.assertIsInstance(made.vertices, list)
        self.assertIsInstance(made.vertices[0], tuple)
        self.assertIsInstance(made.faces[0][0], int)

    def test_arrays_outlive_their_mesh(self):
        with mesh() as made:
            vertices, expected = made.vertices, rows(made.vertices)
        self.assertEqual(rows(vertices), expected)


class Refused(Case):
    """Before the library is called, so with Python's own exceptions."""

    def raises(self, kind, text, vertices, faces):
        with self.assertRaisesRegex(kind, text):
            focal.Mesh(vertices, faces)

    def test_wrong_types(self):
        vertices, faces, _ = shape()
        for wrong in ("text", b"bytes", bytearray(12), None, 3, object()):
            self.raises(TypeError, "vertices must", wrong, faces)
            self.raises(TypeError, "faces must", vertices, wrong)
        self.raises(TypeError, "vertices must", [("a", "b", "c")] * 4, faces)
        self.raises(TypeError, "vertices must", [(1j, 0, 0)] * 4, faces)
        self.raises(TypeError, "vertices must", [(None, 0, 0)] * 4, faces)
        self.raises(TypeError, "faces must hold integers", vertices, [(0.0, 1.0, 2.0)])
        self.raises(TypeError, "faces must hold integers", vertices, array.array("f", [0, 1, 2]))
        self.raises(TypeError, "faces must hold integers", vertices, [(decimal.Decimal(1), 1, 2)])
        with self.assertRaisesRegex(TypeError, "context must be a focal.Context"):
            focal.Mesh(vertices, faces, context="cpu")

    def test_wrong_shapes(self):
        vertices, faces, _ = shape()
        self.raises(ValueError, "vertices", [(0, 0)] * 4, faces)
        self.raises(ValueError, "vertices", [(0, 0, 0), (0, 0)], faces)
        self.raises(ValueError, "faces", vertices, [(0, 1, 2, 3)])
        self.raises(ValueError, "vertices has 4 numbers, not a multiple of 3", [0.0, 0.0, 0.0, 1.0], faces)
        grid = memoryview(array.array("f", range(24))).cast("B").cast("f", (2, 4, 3))
        self.raises(ValueError, "shape", grid, faces)
        turned = memoryview(array.array("f", range(12))).cast("B").cast("f", (3, 4))
        self.raises(ValueError, r"shape \(n, 3\), not \(3, 4\)", turned, faces)

    def test_numbers_that_are_no_indices(self):
        vertices, faces, _ = shape()
        for number in (-1, 2**32, 2**64):
            with self.assertRaises((ValueError, TypeError)):
                focal.Mesh(vertices, faces[:-1] + [(0, 1, number)])

    def test_parameters(self):
        vertices, faces, _ = shape()
        for name in ("weld", "drop_degenerate", "max_vertices", "max_triangles"):
            with self.assertRaisesRegex(TypeError, f"{name} must be an integer"):
                focal.Mesh(vertices, faces, **{name: "yes"})
        with self.assertRaisesRegex(ValueError, "weld is 4294967296"):
            focal.Mesh(vertices, faces, weld=2**32)  # would be 0 when wrapped
        with self.assertRaisesRegex(ValueError, "max_vertices is -1"):
            focal.Mesh(vertices, faces, max_vertices=-1)
        with self.assertRaisesRegex(ValueError, "surface is 'closed', not one of: auto, as_is, wrapped"):
            focal.Mesh(vertices, faces, surface="closed")
        self.refused(Status.INVALID_ARGUMENT, "weld is 2", focal.Mesh, vertices, faces, weld=2)
        self.refused(Status.UNSUPPORTED, "more vertices", focal.Mesh, vertices, faces, max_vertices=10)


class ByTheLibrary(Case):
    def test_what_is_no_mesh(self):
        vertices, faces, _ = shape()
        self.refused(Status.INVALID_MESH, "names vertex", focal.Mesh, vertices, faces + [(0, 1, len(vertices))])
        self.refused(Status.INVALID_MESH, "", focal.Mesh, [(float("nan"), 0, 0)] + vertices[1:], faces)
        self.refused(Status.INVALID_MESH, "", focal.Mesh, [(1e300, 0, 0)] + vertices[1:], faces)
        self.refused(Status.INVALID_MESH, "no triangles", focal.Mesh, vertices, [])
        self.refused(Status.INVALID_MESH, "no triangles", focal.Mesh, [], [])
        self.refused(Status.MESH_TOO_SMALL, "", focal.Mesh, vertices[:3], [(0, 1, 2)])

    def test_files(self):
        vertices, faces, _ = shape()
        path = pathlib.Path(self.folder()) / "Körper 体.glb"
        path.write_bytes(glb(vertices, faces))
        for given in (path, str(path), bytes(path)):
            self.assertEqual(focal.Mesh.load(given).triangle_count, len(faces))
        for data in (path.read_bytes(), bytearray(path.read_bytes()), memoryview(path.read_bytes())):
            self.assertEqual(focal.Mesh.from_bytes(data).vertex_count, len(vertices))
        self.refused(Status.FILE_NOT_FOUND, "nowhere.glb", focal.Mesh.load, path.parent / "nowhere.glb")
        self.refused(Status.INVALID_FILE, "", focal.Mesh.from_bytes, b"no glTF at all")
        self.refused(Status.INVALID_FILE, "", focal.Mesh.from_bytes, path.read_bytes()[:1000])
        self.refused(Status.INVALID_ARGUMENT, "animation", focal.Mesh.load, path, pose_animation="walk", pose_time=1)
        self.refused(Status.INVALID_ARGUMENT, "empty", focal.Mesh.load, "")
        for wrong in (None, 3, 1.5, ["a"]):
            with self.assertRaisesRegex(TypeError, "path must be"):
                focal.Mesh.load(wrong)
        with self.assertRaisesRegex(ValueError, "NUL"):
            focal.Mesh.load("a\0b")
        with self.assertRaisesRegex(TypeError, "bytes-like"):
            focal.Mesh.from_bytes("text")


class Surface(Case):
    def test_wrap(self):
        vertices, faces, _ = shape(8)
        made, path = focal.Mesh(vertices, faces, surface="wrapped"), pathlib.Path(self.folder()) / "wrap.glb"
        self.assertEqual((made.info["is_wrapped"], focal.Mesh(vertices, faces).info["is_wrapped"]), (1, 0))
        self.assertEqual(focal.Mesh(vertices, faces, surface=focal.Surface.AS_IS).info["is_wrapped"], 0)
        made.write_wrap(path)
        wrap = focal.Mesh.load(path)
        self.assertEqual((wrap.info["component_count"], wrap.info["boundary_loops"]), (1, 0))
        self.refused(Status.INVALID_ARGUMENT, ".gltf", made.write_wrap, "wrap.gltf")
        with self.assertRaisesRegex(ValueError, "auto, as_is, wrapped"):
            focal.Mesh(vertices, faces, surface="paper")

    def test_what_it_tells(self):
        made = mesh()
        info = made.info
        self.assertEqual((info["vertex_count"], info["triangle_count"]), (514, 1024))
        self.assertEqual((made.vertex_count, made.triangle_count), (514, 1024))
        self.assertGreater(made.surface_area, 4 * 3.1415)
        self.assertEqual(made.surface_area, info["surface_area"])
        self.assertEqual(made.warnings, [])
        self.assertEqual((len(made.warnings), "struct_size" in info), (info["warning_count"], False))

    def test_warnings(self):
        vertices, faces, _ = shape()
        made = focal.Mesh(vertices, faces + [faces[0], (1, 1, 2)])
        self.assertTrue(made.warnings)
        self.assertTrue(all(isinstance(one, str) and one for one in made.warnings))

    def test_many_parts(self):
        vertices, faces, _ = shape()
        count = len(vertices)
        vertices = vertices + [(x + 6, y, z) for x, y, z in vertices]
        faces = faces + [tuple(count + v for v in face) for face in faces]
        for given, expected in ((None, "closed surface"), ("auto", "closed surface"), ("wrapped", "closed surface"),
                                ("as-is", "bridged"), (focal.Surface.AS_IS, "bridged"), (1, "bridged")):
            made = focal.Mesh(vertices, faces, surface=given)
            self.assertEqual(made.info["component_count"], 2)
            self.assertIn(expected, made.warnings[0])
            self.assertEqual(len(made.vertices), 2 * count)

    def test_points(self):
        made = mesh()
        corner = made.point_at_vertex(5)
        self.assertIn(5, list(made.faces[corner.triangle]))
        self.assertEqual(list(made.position_of(corner)), [float(x) for x in made.vertices[5]])
        middle = made.position_of(focal.SurfacePoint(7, (1 / 3, 1 / 3, 1 / 3)))
        corners = [made.vertices[int(v)] for v in made.faces[7]]
        for axis in range(3):
            self.assertAlmostEqual(middle[axis], sum(float(c[axis]) for c in corners) / 3, 5)
        self.refused(Status.INVALID_LANDMARK, "", made.position_of, (1024, (1, 0, 0)))
        self.refused(Status.INVALID_LANDMARK, "", made.point_at_vertex, 514)
        for wrong in (None, 3, (1, 2, 3), (0, 1)):
            with self.assertRaises(TypeError):
                made.position_of(wrong)
        for wrong, kind in (((0, (1, 0)), ValueError), (("0", (1, 0, 0)), TypeError), ((-1, (1, 0, 0)), ValueError),
                            ((0, ("1", 0, 0)), TypeError)):
            with self.assertRaises(kind):
                made.position_of(wrong)
        for wrong, kind in ((-1, ValueError), (2**32, ValueError), (1.0, TypeError), ("1", TypeError)):
            with self.assertRaises(kind):
                made.point_at_vertex(wrong)

    def test_closest_point(self):
        made = mesh()
        place = [float(x) for x in made.vertices[5]]
        found = made.position_of(made.closest_point([1.001 * x for x in place]))
        for axis in range(3):
            self.assertAlmostEqual(found[axis], place[axis], 2)
        self.refused(Status.INVALID_ARGUMENT, "not finite", made.closest_point, (0, float("nan"), 0))
        for wrong, kind in ((3, TypeError), ((1, 2), ValueError), (("a", 0, 0), TypeError)):
            with self.assertRaises(kind):
                made.closest_point(wrong)

    def test_far_vertices_keep_their_shape(self):
        vertices, faces, _ = shape()
        near, far = focal.Mesh(vertices, faces), (-2487002.88, -4684683.67, 3529638.98)
        moved = [tuple(x + f for x, f in zip(vertex, far)) for vertex in vertices]
        made = focal.Mesh(numpy.array(moved) if numpy is not None else moved, faces)
        self.assertEqual(made.info["surface_vertex_count"], near.info["surface_vertex_count"])
        self.assertAlmostEqual(made.surface_area, near.surface_area, 4)
        for got, given in zip(rows(made.vertices), moved):
            for axis in range(3):
                self.assertAlmostEqual(got[axis], given[axis], 5)
        place = made.position_of(made.closest_point(moved[5]))
        for axis in range(3):
            self.assertAlmostEqual(place[axis], moved[5][axis], 5)
        self.assertEqual(near.origin, (0, 0, 0))  # what lies near stays as it is


if __name__ == "__main__":
    unittest.main()
