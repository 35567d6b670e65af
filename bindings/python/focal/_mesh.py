"""Meshes for training and detection."""
from __future__ import annotations

import ctypes
import operator
import os
from typing import Any, Iterable, NamedTuple

from . import _abi
from ._abi import Scenery, Surface
from ._arrays import Floats, Numbers, block_of, copied, empty, far_origin, moved, result
from ._context import Context, context_or_default
from ._handle import Handle
from ._library import call, create, descriptors, distances, last_error, library
from ._pickled import Source, mesh_again, mesh_state, path_state, source_of
from ._task import Progress, Task, run
from ._values import Mark, SurfacePoint, as_dict, fill, floats, integer, listed, new, path_text, point_of, real

NO_VERTEX = _abi.FOCAL_NO_VERTEX
NO_TRIANGLE = _abi.FOCAL_NO_TRIANGLE


class LeftOut(NamedTuple):
    """A node or part of a scene that is not analysed."""

    name: str             # "node 'Ground'"
    reason: Scenery
    triangle_count: int   # 0 where it is hidden
    is_whole_node: bool   # written files keep such a node and its mesh unchanged, without a skin


class SymmetryPlane(NamedTuple):
    """{x: normal . x = offset}; the sign of the normal carries no meaning."""

    normal: tuple[float, float, float]  # of length 1
    offset: float                       # in the mesh's units
    support: float                      # 0..1: share of the surface whose mirror image lies on it


class Part(NamedTuple):
    """One of several parts of a Mesh: the numbers of its vertices and triangles among those of the mesh."""

    vertices: range
    triangles: range


class Mesh(Handle):
    """A triangle mesh, ready to be analysed. It is immutable and can be pickled.

    vertices  (n, 3) numbers, in your own units; stored as 32-bit floats. 64-bit coordinates that are too far from 0 for this
              precision (earth-centred ones) are moved to 0 first, see origin
    faces     (m, 3) vertex numbers from 0, counter-clockwise seen from outside
    weld               merge vertices of equal position, and open borders that meet within 2e-4 of the size. Default True
    drop_degenerate    drop triangles with a repeated corner and repeated triangles. Default True
    surface            the surface to analyse, a focal.Surface or its name: "as-is": the mesh's own triangles, separate parts
                       linked at their nearest vertices; "wrapped": one closed surface around everything visible from
                       outside (models of preset default only); "auto", the default: wrapped if the mesh has several
                       parts or many edges of more than two triangles. Results always refer to your triangles
    lenient            leave out triangles with a NaN or infinite corner or a vertex number out of range, with a
                       warning, instead of raising an error. Default False
    keep_scenery       also analyse parts that are clearly not the character (a ground, a backdrop, an enclosing shape, a
                       prop that stands apart) and nodes that a file hides. Default False: they are left out with a
                       warning, see left_out
    max_vertices, max_triangles  larger meshes are refused. Defaults 5,000,000 and 10,000,000
    task               cancels the work on a large mesh, see focal.Task

    Blocks of numbers may be NumPy arrays, anything NumPy takes, buffers such as array.array, or sequences; flat ones
    are read three numbers at a time. Raises TypeError and ValueError for any other value; Error with
    Status.INVALID_MESH (no triangles, a vertex number out of range, NaN) or MESH_TOO_SMALL.

    Vertex and triangle numbers in all results are those given here.
    """

    _kind = "mesh"
    _source: Source
    origin: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """What was taken from 64-bit vertices before they were rounded; positions in results have it again, but not those in
    files that are written."""

    def __init__(self, vertices: Any, faces: Any, *, weld: bool | None = None, drop_degenerate: bool | None = None,
                 surface: Surface | str | int | None = None, lenient: bool | None = None,
                 keep_scenery: bool | None = None, max_vertices: int | None = None, max_triangles: int | None = None,
                 context: Context | None = None, task: Task | None = None) -> None:
        block_of(vertices, "vertices", "f", 3)  # refused as they were given
        far = far_origin(vertices)
        if far is not None:
            self.origin, vertices = far, moved(vertices, (-far[0], -far[1], -far[2]))
        self._source = source_of("arrays", weld=weld, drop_degenerate=drop_degenerate, surface=surface, lenient=lenient,
                                 keep_scenery=keep_scenery, max_vertices=max_vertices, max_triangles=max_triangles)
        desc, running = _described(vertices, faces), context_or_default(context)
        params = fill(new(_abi.focal_mesh_params), **self._source.parameters)
        self._take(_made(params, task, "focal_mesh_create", running._handle, ctypes.byref(desc)), running)

    @classmethod
    def from_parts(cls, parts: Iterable[tuple[Any, Any]], *, weld: bool | None = None,
                   drop_degenerate: bool | None = None, surface: Surface | str | int | None = None,
                   lenient: bool | None = None, keep_scenery: bool | None = None, max_vertices: int | None = None,
                   max_triangles: int | None = None, context: Context | None = None, task: Task | None = None) -> Mesh:
        """Makes one mesh of a character with several parts (body, eyes, clothes): (vertices, faces) of each, in one coordinate system.
        Vertices and triangles are numbered consecutively, part after part; `parts` says where each begins. Parameters and errors as Mesh."""
        descs = [_described(vertices, faces) for vertices, faces in parts]
        source = source_of("parts", weld=weld, drop_degenerate=drop_degenerate, surface=surface, lenient=lenient,
                           keep_scenery=keep_scenery, max_vertices=max_vertices, max_triangles=max_triangles)
        params = fill(new(_abi.focal_mesh_params), **source.parameters)
        pointers = (ctypes.POINTER(_abi.focal_mesh_desc) * max(1, len(descs)))(*[ctypes.pointer(one) for one in descs])
        running = context_or_default(context)
        return cls._from(source, _made(params, task, "focal_mesh_create_parts", running._handle, pointers, len(descs)), running)

    @classmethod
    def _from(cls, source: Source, pointer: Any, context: Context) -> Mesh:
        made = cls._adopt(pointer, context)
        made._source = source
        return made

    def __reduce__(self) -> tuple[Any, ...]:
        return mesh_again, (Mesh, *mesh_state(self))

    def _own_arrays(self) -> tuple[bytes, bytes]:
        """Vertices and faces as the library has them: floats and 32-bit numbers."""
        counts = 12 * self.vertex_count, 12 * self.triangle_count
        with self._borrow() as handle:
            return (ctypes.string_at(library().focal_mesh_positions(handle), counts[0]),
                    ctypes.string_at(library().focal_mesh_triangles(handle), counts[1]))

    def _facts(self) -> str:
        info = self.info
        return f"{info['vertex_count']} vertices, {info['triangle_count']} triangles"

    @property
    def parts(self) -> list[Part]:
        """Where each part's vertices and triangles are among those of the mesh; of a file its triangle primitives."""
        struct, found = new(_abi.focal_mesh_part), []
        with self._borrow() as handle:
            for index in range(library().focal_mesh_part_count(handle)):
                call("focal_mesh_get_part", handle, index, ctypes.byref(struct))
                found.append(Part(range(struct.first_vertex, struct.first_vertex + struct.vertex_count),
                                  range(struct.first_triangle, struct.first_triangle + struct.triangle_count)))
        return found

    @classmethod
    def load(cls, path: str | os.PathLike[str], *, weld: bool | None = None, drop_degenerate: bool | None = None,
             surface: Surface | str | int | None = None, lenient: bool | None = None,
             keep_scenery: bool | None = None, allow_external_files: bool | None = None,
             keep_source_file: bool | None = None, max_vertices: int | None = None,
             max_triangles: int | None = None, max_nodes: int | None = None, max_json_bytes: int | None = None,
             max_file_bytes: int | None = None, pose_animation: str | None = None, pose_time: float | None = None,
             context: Context | None = None, task: Task | None = None) -> Mesh:
        """A glTF scene (.glb or .gltf) as one mesh, node transforms applied, skins at bind pose.

        allow_external_files  also read .bin files beside a .gltf, inside its folder only. Default False
        keep_source_file      keep the file's bytes, so that results can be written into it. Default True
        max_nodes, max_json_bytes, max_file_bytes  larger files are refused. Defaults 1,000,000, 64 MiB, 2 GiB
        task                  cancels loading a large file, see focal.Task
        pose_animation, pose_time  the name of an animation, and seconds: skinned meshes are loaded in that pose.
                                   Such a mesh keeps no file

        Error: FILE_NOT_FOUND, IO, INVALID_FILE, UNSUPPORTED, and those of Mesh.
        """
        file, running = path_text(path), context_or_default(context)
        state = path_state(path) if os.path.exists(path) else None
        source = source_of("path", state, weld=weld, drop_degenerate=drop_degenerate,
                           surface=surface, lenient=lenient, keep_scenery=keep_scenery,
                           allow_external_files=allow_external_files, keep_source_file=keep_source_file,
                           max_vertices=max_vertices, max_triangles=max_triangles, max_nodes=max_nodes, max_json_bytes=max_json_bytes,
                           max_file_bytes=max_file_bytes, pose_animation=pose_animation, pose_time=pose_time)
        params = fill(new(_abi.focal_mesh_params), **source.parameters)
        return cls._from(source, _made(params, task, "focal_mesh_load_gltf", running._handle, file), running)

    @classmethod
    def from_bytes(cls, data: Any, *, weld: bool | None = None, drop_degenerate: bool | None = None,
                   surface: Surface | str | int | None = None, lenient: bool | None = None,
                   keep_scenery: bool | None = None, keep_source_file: bool | None = None,
                   max_vertices: int | None = None, max_triangles: int | None = None, max_nodes: int | None = None,
                   max_json_bytes: int | None = None, max_file_bytes: int | None = None,
                   pose_animation: str | None = None, pose_time: float | None = None,
                   context: Context | None = None, task: Task | None = None) -> Mesh:
        """The same from the bytes of a file (bytes-like); external files are refused."""
        memory, running = bytes_of(data), context_or_default(context)
        source = source_of("bytes", memory, weld=weld, drop_degenerate=drop_degenerate,
                           surface=surface, lenient=lenient, keep_scenery=keep_scenery, keep_source_file=keep_source_file,
                           max_vertices=max_vertices, max_triangles=max_triangles, max_nodes=max_nodes,
                           max_json_bytes=max_json_bytes, max_file_bytes=max_file_bytes, pose_animation=pose_animation,
                           pose_time=pose_time)
        params = fill(new(_abi.focal_mesh_params), **source.parameters)
        return cls._from(source, _made(params, task, "focal_mesh_load_gltf_memory", running._handle, memory, len(memory)), running)

    @property
    def info(self) -> dict[str, Any]:
        """All figures that the library reports: counts of the mesh and of the surface that is analysed
        (surface_vertex_count, ...), mean_edge_length, surface_area, load_seconds, repair_seconds, and what was found and repaired: invalid_triangles,
        degenerate_triangles, flipped_triangles, nonmanifold_edges, nonmanifold_vertices, boundary_loops,
        component_count, is_oriented; is_wrapped: the closed surface around the mesh is analysed; left_out_count,
        left_out_triangles: see left_out."""
        info = new(_abi.focal_mesh_info)
        call("focal_mesh_get_info", self._handle, ctypes.byref(info))
        return as_dict(info)

    @property
    def vertex_count(self) -> int:
        return int(self.info["vertex_count"])

    @property
    def triangle_count(self) -> int:
        return int(self.info["triangle_count"])

    @property
    def surface_area(self) -> float:
        """In the square of the mesh's units."""
        return float(self.info["surface_area"])

    @property
    def vertices(self) -> Floats:
        """(vertex_count, 3) floats, a copy."""
        given = self._copied("focal_mesh_positions", "f", self.vertex_count)
        found: Floats = moved(given, self.origin) if any(self.origin) else given
        return found

    @property
    def faces(self) -> Numbers:
        """(triangle_count, 3) vertex numbers, a copy."""
        found: Numbers = self._copied("focal_mesh_triangles", "I", self.triangle_count)
        return found

    def _copied(self, getter: str, code: str, count: int) -> Any:
        with self._borrow() as handle:
            pointer = getattr(library(), getter)(handle)
            if not pointer:
                raise last_error(_abi.Status.INVALID_HANDLE)
            return copied(pointer, code, count, 3)

    @property
    def warnings(self) -> list[str]:
        """Plain sentences on what was found and done."""
        return self._texts("focal_mesh_warning", self.info["warning_count"])

    @property
    def left_out(self) -> list[LeftOut]:
        """Hidden nodes and parts that are not the character; empty with keep_scenery."""
        found = []
        for index in range(self.info["left_out_count"]):
            one = new(_abi.focal_left_out)
            call("focal_mesh_get_left_out", self._handle, index, ctypes.byref(one))
            found.append(LeftOut(one.name.decode(), Scenery(one.reason), one.triangle_count, bool(one.is_whole_node)))
        return found

    def write_wrap(self, path: str | os.PathLike[str]) -> None:
        """Writes the closed surface around the mesh as a .glb, for inspection; it is what is analysed if info["is_wrapped"].
        Error: INVALID_ARGUMENT (a path that ends in .gltf), IO, FILE_NOT_FOUND (no such folder)."""
        call("focal_mesh_write_wrap_gltf", self._handle, path_text(path))

    def position_of(self, point: SurfacePoint) -> tuple[float, float, float]:
        """Where a surface point lies. Error with Status.INVALID_LANDMARK when its triangle does not exist."""
        given, position = surface_point(point, "point"), (ctypes.c_float * 3)()
        call("focal_mesh_position_of", self._handle, ctypes.byref(given), position)
        return placed(position, self.origin)

    def closest_point(self, position: Any) -> SurfacePoint:
        """The point of the surface nearest to (x, y, z). Error: INVALID_ARGUMENT (not finite)."""
        x, y, z = (real(value, "position") - start for value, start in zip(_three(position, "position"), self.origin))
        out, given = _abi.focal_surface_point(), (ctypes.c_float * 3)(x, y, z)
        call("focal_mesh_closest_point", self._handle, given, ctypes.byref(out))
        return point_of(out)  # type: ignore[return-value]

    def describe(self, vertices: Any, descriptor: _abi.Descriptor | str | int = "si-hks", *,
                 context: Context | None = None, task: Task | None = None, on_progress: Progress | None = None) -> Floats:
        """(len(vertices), n) floats: descriptors of the surroundings of these vertices, of a kind named in
        focal.descriptors(). Error: INVALID_LANDMARK (no such vertex, or no triangle uses it); Cancelled."""
        chosen = listed(descriptor, descriptors(), "descriptor")
        wanted, handle, running = block_of(vertices, "vertices", "I", 1), self._handle, context_or_default(context)
        width = library().focal_descriptor_dimension(chosen)
        room = empty("f", wanted.rows * width)
        run(lambda task_handle: call("focal_mesh_describe", running._handle, handle, chosen, wanted.pointer,
                                     wanted.rows, task_handle, room.pointer), task, on_progress)
        rows: Floats = result(room.owner, width)
        return rows

    def distances(self, source: Mark, distance: _abi.Distance | str | int = "heat", *, context: Context | None = None,
                  task: Task | None = None, on_progress: Progress | None = None) -> Floats:
        """(vertex_count,) floats: distances from a vertex number or a SurfacePoint, of a kind named in focal.distances();
        infinite where no triangle uses the vertex. Error: INVALID_LANDMARK; Cancelled."""
        chosen, running = listed(distance, distances(), "distance"), context_or_default(context)
        place, handle, room = marked_point(self, source, "source"), self._handle, empty("f", self.vertex_count)
        run(lambda task_handle: call("focal_mesh_distances", running._handle, handle, chosen, ctypes.byref(place),
                                     task_handle, room.rows, room.pointer), task, on_progress)
        found: Floats = result(room.owner)
        return found

    def symmetry_plane(self, *, seed: int = 0, context: Context | None = None, task: Task | None = None,
                       on_progress: Progress | None = None) -> SymmetryPlane:
        """The plane that mirrors most of the surface onto itself. Cancelled."""
        plane, handle, running = new(_abi.focal_symmetry_plane), self._handle, context_or_default(context)
        number = integer(seed, "seed", ctypes.c_uint64)
        run(lambda task_handle: call("focal_mesh_symmetry_plane", running._handle, handle, number, task_handle,
                                     ctypes.byref(plane)), task, on_progress)
        normal = floats(plane.normal)
        offset = plane.offset + sum(n * start for n, start in zip(normal, self.origin))
        return SymmetryPlane(normal, offset, plane.support)

    def point_at_vertex(self, vertex: int) -> SurfacePoint:
        """The surface point at a vertex. Error with Status.INVALID_LANDMARK when no triangle uses it."""
        out = _abi.focal_surface_point()
        number = integer(vertex, "vertex", ctypes.c_uint32)
        call("focal_mesh_point_at_vertex", self._handle, number, ctypes.byref(out))
        return point_of(out)  # type: ignore[return-value]


def _made(params: Any, task: Task | None, function: str, *arguments: Any) -> Any:
    """The new mesh's handle."""
    def make(task_handle: Any) -> Any:
        params.task = task_handle
        return create(function, _abi.focal_mesh, *arguments, ctypes.byref(params))
    return make(None) if task is None else run(make, task, None)


def bytes_of(data: Any) -> bytes:
    if isinstance(data, str):
        raise TypeError("data must be bytes-like, not str")
    try:
        return data if isinstance(data, bytes) else memoryview(data).tobytes()
    except TypeError:
        raise TypeError(f"data must be bytes-like, not {type(data).__name__}") from None


def surface_point(value: Any, name: str) -> _abi.focal_surface_point:
    """From a SurfacePoint, or (triangle, (a, b, c))."""
    try:
        triangle, weights = value
        weights = list(weights)
    except (TypeError, ValueError):
        raise TypeError(f"{name} must be a focal.SurfacePoint, not {value!r:.60}") from None
    if len(weights) != 3:
        raise ValueError(f"{name} must have three barycentric weights, not {len(weights)}")
    number = integer(triangle, f"the triangle of {name}", ctypes.c_uint32)
    return _abi.focal_surface_point(number, (ctypes.c_float * 3)(*(real(w, f"weights of {name}") for w in weights)))


def is_number(mark: Any) -> bool:
    try:
        operator.index(mark)
    except TypeError:
        return False
    return True


def _three(value: Any, name: str) -> list[Any]:
    try:
        numbers = list(value)
    except TypeError:
        raise TypeError(f"{name} must be (x, y, z), not {type(value).__name__}") from None
    if len(numbers) != 3:
        raise ValueError(f"{name} must be three numbers, not {len(numbers)}")
    return numbers


def placed(position: Any, origin: tuple[float, float, float]) -> tuple[float, float, float]:
    """A position of the library in the caller's coordinates."""
    return tuple(x + start for x, start in zip(position, origin))  # type: ignore[return-value]


def _is_position(mark: Any) -> bool:
    """Three numbers; a SurfacePoint has two members."""
    try:
        return len(mark) == 3 and not isinstance(mark, (str, bytes))
    except TypeError:
        return False


def marked_point(mesh: Mesh, mark: Mark, name: str) -> _abi.focal_surface_point:
    """From a vertex number, a SurfacePoint, a position (x, y, z), or None for no point."""
    if mark is None:
        return _abi.focal_surface_point(NO_TRIANGLE)
    if is_number(mark):
        mark = mesh.point_at_vertex(operator.index(mark))  # type: ignore[arg-type]
    elif _is_position(mark):
        mark = mesh.closest_point(mark)
    return surface_point(mark, name)


def _described(vertices: Any, faces: Any) -> _abi.focal_mesh_desc:
    positions = block_of(vertices, "vertices", "f", 3)
    indices = block_of(faces, "faces", "I", 3)
    desc: _abi.focal_mesh_desc = new(_abi.focal_mesh_desc)
    desc.positions, desc.vertex_count = positions.pointer, positions.rows
    desc.indices, desc.index_count = indices.pointer, 3 * indices.rows
    desc._blocks = positions, indices  # their memory lives as long as the struct
    return desc
