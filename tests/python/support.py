"""What the tests of the Python package share: shapes with limbs as tests/capi/shapes.c makes them, and models of them.

The package is found through PYTHONPATH (run.sh sets it). FOCAL_TEST_NO_NUMPY=1 hides NumPy.
"""
import functools
import math
import os
import struct
import sys
import tempfile
import unittest

if os.environ.get("FOCAL_TEST_NO_NUMPY"):
    sys.modules["numpy"] = None

import focal  # noqa: E402  (after NumPy is hidden)

try:
    import numpy
except ImportError:
    numpy = None

NAMES = ["nose", "hand.L", "tail"]
LIMBS = ((0, 0, 1), (0.8, 0.6, 0), (0, -0.6, -0.8))


def _dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def _pushed_out(point, variation):
    lengths = (0.6, 1 + variation, 1.5 - variation)
    radius = 1 + sum(length * math.exp(-12 * (1 - _dot(point, limb))) for length, limb in zip(lengths, LIMBS))
    return tuple(radius * x for x in point)


def _faces(rings):
    around, faces = 2 * rings, []
    for ring in range(rings + 1):
        below, above = 2 + ring * around, 2 + (ring - 1) * around
        for j in range(around):
            k = (j + 1) % around
            if ring == 0:
                faces.append((0, below + j, below + k))
            elif ring == rings:
                faces.append((above + j, 1, above + k))
            else:
                faces += [(above + j, below + j, below + k), (above + j, below + k, above + k)]
    return faces


@functools.lru_cache(maxsize=None)
def shape(rings=16, variation=0.0):
    """A ball with three limbs: vertices, faces, and the vertices of its marks in the order of NAMES."""
    sphere, around = [(0, 0, 1), (0, 0, -1)], 2 * rings
    for ring in range(1, rings + 1):
        polar = math.pi * ring / (rings + 1)
        for j in range(around):
            turn = 2 * math.pi * j / around
            sphere.append((math.sin(polar) * math.cos(turn), math.sin(polar) * math.sin(turn), math.cos(polar)))
    vertices = [_pushed_out(point, variation) for point in sphere]
    marks = [max(range(len(vertices)), key=lambda v: _dot(vertices[v], limb)) for limb in LIMBS]
    return vertices, _faces(rings), marks


def mesh(rings=16, variation=0.12):
    vertices, faces, _ = shape(rings, variation)
    return focal.Mesh(vertices, faces)


def training_set(rings=16, count=4):
    marked = focal.TrainingSet(NAMES)
    for number in range(count):
        marked.add(mesh(rings, 0.05 * number), shape(rings, 0.05 * number)[2])
    return marked


@functools.lru_cache(maxsize=None)
def model():
    """A quick model of four shapes, made once a program."""
    return focal.Model.train(training_set(), tree_count=10)


@functools.lru_cache(maxsize=None)
def detection():
    return model().detect(mesh())


def glb(vertices, faces):
    """The bytes of a .glb with these triangles."""
    positions = b"".join(struct.pack("<3f", *vertex) for vertex in vertices)
    indices = b"".join(struct.pack("<3I", *face) for face in faces)
    text = ('{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{'
            '"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],'
            '"buffers":[{"byteLength":%d}],"bufferViews":[{"buffer":0,'
            '"byteLength":%d},{"buffer":0,"byteOffset":%d,"byteLength":%d}],"accessors":[{"bufferView":0,'
            '"componentType":5126,"count":%d,"type":"VEC3","min":[-9,-9,-9],"max":[9,9,9]},{"bufferView":1,'
            '"componentType":5125,"count":%d,"type":"SCALAR"}]}' %
            (len(positions) + len(indices), len(positions), len(positions), len(indices), len(vertices),
             3 * len(faces)))
    json = text.encode() + b" " * (-len(text) % 4)
    body = positions + indices
    return (struct.pack("<4sII", b"glTF", 2, 28 + len(json) + len(body)) +
            struct.pack("<I4s", len(json), b"JSON") + json + struct.pack("<I4s", len(body), b"BIN\0") + body)


def rows(block):
    """A block of rows as lists, from NumPy or not."""
    return [list(row) for row in block]


class Case(unittest.TestCase):
    """With a folder of its own, and a look at the code and hint of errors."""

    def folder(self):
        made = tempfile.TemporaryDirectory()
        self.addCleanup(made.cleanup)
        return made.name

    def refused(self, status, text, function, *arguments, **named):
        """function must raise Error with the status, the text in its message, and a hint."""
        with self.assertRaises(focal.Error) as caught:
            function(*arguments, **named)
        self.assertIs(caught.exception.code, status)
        self.assertIn(text, caught.exception.message)
        self.assertTrue(caught.exception.hint)
        return caught.exception
