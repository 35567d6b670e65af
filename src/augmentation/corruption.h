// Typical defects of scanned and modelled meshes, generated from a seed, with the landmarks transferred: for
// training on such meshes, and for measuring robustness.
//
//   Random random(seed, stream);
//   CorruptedMesh bad = intact(shape.surface, marks);
//   bad = with_noise(std::move(bad), 0.2, random);      // any order, any number of corruptions
//   bad = with_holes(std::move(bad), 20, 1.5, random);
// const PreparedMesh mesh = prepare(bad.mesh);        // bad.marks are on mesh.source: see to_surface
//
// Pure functions of their arguments and the state of `random`: the same seed gives the same bits. Each takes
// about 1 ms for 5,000 vertices. Lengths are in the units of the mesh, or in its mean edge lengths where
// stated. The meshes need not be closed or manifold. Vertices without triangles are dropped, so the result
// can be a mesh without triangles.
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "base/parallel.h"
#include "base/random.h"
#include "mesh/triangle_mesh.h"

namespace focal {

struct CorruptedMesh {
  TriangleMesh mesh;
  std::vector<std::optional<SurfacePoint>> marks;  // on mesh; empty: its piece of the surface was removed
  std::vector<int32_t> old_vertex;    // per vertex: number in the intact mesh, or -1: added by a corruption
  std::vector<int32_t> old_triangle;  // per triangle: the intact one that it is or is part of, or -1
};

// The input of every corruption. marks: on mesh; empty ones stay empty.
CorruptedMesh intact(TriangleMesh mesh, std::vector<std::optional<SurfacePoint>> marks = {});

// Removes every triangle whose flag is not set (one flag per triangle).
CorruptedMesh keep_triangles(CorruptedMesh corrupted, std::span<const char> stays);

// Adds to every coordinate a normal random number of standard deviation share * mean edge length.
CorruptedMesh with_noise(CorruptedMesh corrupted, double share, Random& random);

// Removes all vertices within `radius` mean edges along the edges of `count` random vertices; radius 0: only
// those vertices.
CorruptedMesh with_holes(CorruptedMesh corrupted, int32_t count, double radius, Random& random);

enum class CutEnd { open, capped };  // capped: a fan over each new border

// Removes every vertex whose flag is set.
CorruptedMesh without_vertices(CorruptedMesh corrupted, const std::vector<char>& lost, CutEnd end,
                               const Execution& execution = {});
// Removes every vertex nearer than radius to centre along the edges (up to a tenth less than the geodesic
// ball): for example a limb, by the landmark at its tip. Also removes fragments of less than a hundredth of
// the triangles. Throws cancelled.
CorruptedMesh cut_ball(CorruptedMesh corrupted, const SurfacePoint& centre, double radius, CutEnd end,
                       const Execution& execution = {});

// Length of the shortest edge path from a point to each vertex, infinity beyond `limit`.
Vector edge_path_lengths(const TriangleMesh& mesh, const SurfacePoint& from, double limit);

}  // namespace focal
