"""Meshes of Blender as arrays for focal, and places on their surface.

focal gets each mesh as a glTF file would hold it: Y up, the object's rotation and scale applied, so that models go
back and forth between Blender and the command. The location is left out: far from the origin floats get coarse.
"""
import hashlib

import bpy
import numpy
from mathutils import Matrix, Vector
from mathutils.bvhtree import BVHTree

# Blender (x, y, z) is glTF (x, z, -y).
TO_GLTF = Matrix(((1, 0, 0, 0), (0, 0, 1, 0), (0, -1, 0, 0), (0, 0, 0, 1)))
FROM_GLTF = TO_GLTF.transposed()

# Modifiers without which the stored mesh is not the shape that the user sees.
_SHAPING = {"MIRROR": "half of the shape", "ARRAY": "one piece of the shape", "BOOLEAN": "another shape",
            "REMESH": "another surface", "SKIN": "only the edges", "SCREW": "only the profile"}


class Unusable(Exception):
    """Why an object cannot be worked on, in words for the user."""


def problem_of(obj):
    """Why focal cannot work on the object, or ''. Cheap enough for a panel's draw."""
    if obj is None:
        return "Select a mesh"
    if obj.type != "MESH":
        return f"'{obj.name}' is no mesh ({obj.type.replace('_', ' ').lower()}): select a mesh"
    if obj.library is not None or obj.data.library is not None:
        return f"'{obj.name}' is linked from another file: make it local first"
    if not obj.data.polygons and obj.mode != "EDIT":
        return f"'{obj.name}' has no faces"
    if abs(obj.matrix_world.determinant()) < 1e-12:
        return f"'{obj.name}' is flat: one of its scales is 0"
    for modifier in obj.modifiers:
        if modifier.type in _SHAPING and modifier.show_viewport:
            return (f"'{obj.name}' has the modifier '{modifier.name}', without which it is "
                    f"{_SHAPING[modifier.type]}: apply it first, or switch it off")
    return ""


def hints_of(obj):
    """What works but may surprise, as sentences."""
    hints = []
    scale = obj.matrix_world.to_scale()
    if max(abs(s - scale[0]) for s in scale) > 1e-3 * abs(scale[0]):
        hints.append("its scale differs between axes: apply it (Ctrl A) before exporting a rig")
    if any(m.type == "NODES" and m.show_viewport for m in obj.modifiers):  # many only set normals
        hints.append("its geometry nodes were not looked at")
    if obj.data.shape_keys:
        hints.append("its shape keys are left as they are; the basis was used")
    return hints


def armature_of(obj):
    """The armature that moves the object, or None."""
    for modifier in obj.modifiers:
        if modifier.type == "ARMATURE" and modifier.object is not None:
            return modifier.object
    return obj.parent if obj.parent is not None and obj.parent.type == "ARMATURE" else None


class Surface:
    """The triangles of one object, local and as focal sees them. Holds arrays only, so any thread may use it."""

    def __init__(self, obj):
        problem = problem_of(obj)
        if problem:
            raise Unusable(problem)
        if obj.mode == "EDIT":
            obj.update_from_editmode()
        self.name = obj.name
        self.location = obj.matrix_world.translation.copy()
        self.local = _local_positions(obj.data)
        self.triangles = _triangles(obj.data)
        if not len(self.triangles):
            raise Unusable(f"'{obj.name}' has no faces")
        if not numpy.isfinite(self.local).all():
            raise Unusable(f"'{obj.name}' has a vertex at no finite place")
        self.to_focal = TO_GLTF @ obj.matrix_world.to_3x3().to_4x4()
        # A mirrored object shows its faces from behind: focal wants them counter-clockwise from outside.
        self.mirrored = self.to_focal.determinant() < 0
        self._span = None

    def positions(self):
        rotation = numpy.array(self.to_focal.to_3x3(), dtype=numpy.float64)
        return numpy.ascontiguousarray(self.local @ rotation.T, dtype=numpy.float32)

    def faces(self):
        order = [0, 2, 1] if self.mirrored else [0, 1, 2]
        return numpy.ascontiguousarray(self.triangles[:, order])

    def turned(self, barycentric):
        """Weights in the order of the faces that focal sees, from ours, or back."""
        a, b, c = (float(w) for w in barycentric)
        return (a, c, b) if self.mirrored else (a, b, c)

    def at(self, triangle, barycentric):
        """The local position of a place of ours."""
        return Vector(numpy.asarray(barycentric, dtype=float) @ self.local[self.triangles[triangle]])

    def size(self):
        """The diagonal of the local bounding box."""
        return float(numpy.linalg.norm(self.local.max(axis=0) - self.local.min(axis=0)))

    def cast(self, origin, direction):
        """(location, triangle) where a local ray first meets the surface, or None. Only triangles that the ray's line may meet
        go into a tree: that of a whole mesh takes seconds where there are a million."""
        first = direction.orthogonal().normalized()
        axes = numpy.array((first, direction.cross(first).normalized()), dtype=numpy.float32)
        away = (self.local - numpy.array(origin, dtype=numpy.float32)) @ axes.T
        near = numpy.hypot(away[:, 0], away[:, 1])[self.triangles[:, 0]] <= self._spans()
        location, number, _distance = self._among(near, lambda tree: tree.ray_cast(origin, direction))
        return None if location is None else (location, number)

    def nearest(self, position):
        """(location, triangle, distance) of the place of the surface nearest to a local position."""
        away = self.local - numpy.array(position, dtype=numpy.float32)
        distances = numpy.sqrt(numpy.einsum("ij,ij->i", away, away))[self.triangles[:, 0]]
        near = distances - self._spans() <= 1.0001 * distances.min()
        return self._among(near, lambda tree: tree.find_nearest(Vector(position)))

    def _spans(self):
        """How far each triangle reaches from its first corner, and a little more for what floats lose."""
        if self._span is None:
            first, *others = self.triangles.T.astype(numpy.intp)
            squares = numpy.zeros((2, len(first)), dtype=numpy.float32)
            for values in numpy.ascontiguousarray(self.local.T):  # one axis after the other: three times as fast as rows
                start = values.take(first)
                for square, other in zip(squares, others):
                    square += (values.take(other) - start) ** 2
            self._span = 1.0001 * numpy.sqrt(squares.max(axis=0)) + 1e-6 * abs(self.local).max()
        return self._span

    def _among(self, chosen, ask):
        """(location, triangle, distance) that a tree of some triangles answers; chosen: a truth for each triangle."""
        numbers = numpy.flatnonzero(chosen)
        location, _normal, number, distance = ask(self._tree(numbers))
        return location, -1 if number is None else int(numbers[number]), distance

    def _tree(self, numbers):
        corners = self.local[self.triangles[numbers]].reshape(-1, 3)
        return BVHTree.FromPolygons(corners.tolist(), numpy.arange(len(corners)).reshape(-1, 3).tolist())

    def barycentric(self, triangle, position):
        """Weights of a point in the plane of a triangle, clamped to it."""
        a, b, c = self.local[self.triangles[triangle]].astype(float)
        u, v, w = b - a, c - a, numpy.asarray(position, dtype=float) - a
        uu, uv, vv, wu, wv = u @ u, u @ v, v @ v, w @ u, w @ v
        area = uu * vv - uv * uv
        if area <= 0:
            return (1.0, 0.0, 0.0)
        weights = numpy.clip([(vv * wu - uv * wv) / area, (uu * wv - uv * wu) / area], 0, 1)
        weights /= max(1.0, weights.sum())
        return (float(1 - weights.sum()), float(weights[0]), float(weights[1]))

    def key(self):
        """Differs when anything that focal sees differs."""
        digest = hashlib.blake2b(self.positions().tobytes(), digest_size=16)
        digest.update(self.faces().tobytes())
        return digest.hexdigest()


class Character:
    """One or several objects as one surface: vertices and triangles numbered through, the first object at the origin."""

    def __init__(self, surfaces):
        self.surfaces = surfaces
        self.first_vertex = _starts(len(s.local) for s in surfaces)
        self.first_triangle = _starts(len(s.triangles) for s in surfaces)

    def parts(self):
        """(positions, faces) of each object, in one coordinate system."""
        origin = self.surfaces[0].location
        return [(s.positions() + numpy.array(TO_GLTF.to_3x3() @ (s.location - origin), dtype=numpy.float32), s.faces())
                if s is not self.surfaces[0] else (s.positions(), s.faces()) for s in self.surfaces]

    def vertices_of(self, number):
        """The slice of an object's vertices."""
        return slice(self.first_vertex[number], self.first_vertex[number + 1])

    def triangles_of(self, number):
        return slice(self.first_triangle[number], self.first_triangle[number + 1])

    def owner(self, triangle):
        """(number of the object, the triangle's own number there)"""
        number = int(numpy.searchsorted(self.first_triangle, triangle, side="right")) - 1
        return number, triangle - self.first_triangle[number]

    def key(self):
        """Differs when anything that focal sees differs."""
        if len(self.surfaces) == 1:
            return self.surfaces[0].key()
        digest = hashlib.blake2b(digest_size=16)
        for positions, faces in self.parts():
            digest.update(positions.tobytes())
            digest.update(faces.tobytes())
        return digest.hexdigest()


def _starts(counts):
    return [0, *numpy.cumsum(list(counts)).tolist()]


def _local_positions(mesh):
    """Of the basis where there are shape keys: what they show now is not the shape."""
    source = mesh.shape_keys.reference_key.data if mesh.shape_keys else mesh.vertices
    positions = numpy.empty(len(source) * 3, dtype=numpy.float32)
    source.foreach_get("co", positions)
    return positions.reshape(-1, 3)


def _triangles(mesh):
    mesh.calc_loop_triangles()
    triangles = numpy.empty(len(mesh.loop_triangles) * 3, dtype=numpy.int32)
    mesh.loop_triangles.foreach_get("vertices", triangles)
    return triangles.reshape(-1, 3).astype(numpy.uint32)


def selected_meshes(context):
    """The active mesh first, then the other selected ones."""
    active = context.active_object
    chosen = [o for o in context.selected_objects if o.type == "MESH"]
    if active is not None and active in chosen:
        chosen.remove(active)
        chosen.insert(0, active)
    return chosen


def character_of(context, obj):
    """The objects that are one character with this one: the selected meshes; else those that it was looked at with; itself first."""
    chosen = selected_meshes(context)
    if obj is None or (obj in chosen and len(chosen) > 1):
        return chosen or [obj]
    return [other for other in remembered_character(obj) if other == obj or other.name in context.scene.objects]


def remembered_character(obj):
    """The object and those that were looked at, or listed for training, as one character with it."""
    known = [item.object for item in obj.focal.character if item.object is not None] if obj.type == "MESH" else []
    return [obj] + [other for other in known if other != obj and other.type == "MESH"]


def remember_character(objects):
    """So that a correction of one of them looks at all of them again, and one row of the training list stands for all."""
    for obj in objects:
        obj.focal.character.clear()
        for other in objects if len(objects) > 1 else ():
            obj.focal.character.add().object = other


def object_named(name):
    """The object of this name as it is now: undo replaces objects, so none is kept while work runs."""
    obj = bpy.data.objects.get(name)
    if obj is None:
        raise Unusable(f"'{name}' is no longer there")
    return obj
