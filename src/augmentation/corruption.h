// Meshes as scanners and artists spoil them, from a seed, with the marks on them carried along: for training on what
// detection will meet, and for measuring how it copes.
//
//   Random random(seed, stream);
//   CorruptedMesh bad = intact(shape.surface, marks);
//   bad = with_noise(std::move(bad), 0.2, random);      // any order, any number of corruptions
//   bad = with_holes(std::move(bad), 20, 1.5, random);
//   const PreparedMesh mesh = prepare(bad.mesh);        // bad.marks lie on mesh.source: see to_surface
//
// Pure functions of their arguments and the state of `random`: the same seed, the same bits. About 1 ms for 5,000
// vertices each. Lengths are in the units of the mesh, or in its mean edge lengths where it says so. The meshes need not
// be closed or manifold. Vertices that no triangle uses any more are dropped, so a mesh without triangles can come out.
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
  std::vector<std::optional<SurfacePoint>> marks;  // on mesh; empty: went away with its piece of surface
  std::vector<int32_t> old_vertex;    // per vertex: of the intact mesh, or -1: made by a corruption
  std::vector<int32_t> old_triangle;  // per triangle: the intact one that it is or lies in, or -1
};

// What every corruption starts from. marks: on mesh; empty ones stay empty.
CorruptedMesh intact(TriangleMesh mesh, std::vector<std::optional<SurfacePoint>> marks = {});

// Loses every triangle whose number does not stay (one flag a triangle).
CorruptedMesh keep_triangles(CorruptedMesh corrupted, std::span<const char> stays);

// Every coordinate moves by a normal random number of deviation share * mean edge length.
CorruptedMesh with_noise(CorruptedMesh corrupted, double share, Random& random);

// `count` random places lose all vertices within `radius` mean edges along the surface's edges; 0: one vertex each.
CorruptedMesh with_holes(CorruptedMesh corrupted, int32_t count, double radius, Random& random);

enum class CutEnd { open, capped };  // capped: a fan over each new border

// Loses every vertex whose flag is set.
CorruptedMesh without_vertices(CorruptedMesh corrupted, const std::vector<char>& lost, CutEnd end,
                               const Execution& execution = {});
// Loses every vertex nearer than radius to centre along the surface's edges (so up to a tenth less than the geodesic
// ball): a limb, by a mark at its tip. Crumbs that this leaves, below a hundredth of the triangles, go too.
// Throws cancelled.
CorruptedMesh cut_ball(CorruptedMesh corrupted, const SurfacePoint& centre, double radius, CutEnd end,
                       const Execution& execution = {});

// Length of the shortest way along edges from a point to each vertex, infinity beyond `limit`.
Vector edge_path_lengths(const TriangleMesh& mesh, const SurfacePoint& from, double limit);

}  // namespace focal
