// Meshes as scanners and artists spoil them, from a seed, with the marks on them carried along: for training on what
// detection will meet, and for measuring how it copes.
//
//   Random random(seed, stream);
//   DamagedMesh bad = undamaged(shape.surface, marks);
//   bad = with_noise(std::move(bad), 0.2, random);      // any order, any number of damages
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

struct DamagedMesh {
  TriangleMesh mesh;
  std::vector<std::optional<SurfacePoint>> marks;  // on mesh; empty: went away with its piece of surface
  std::vector<int32_t> old_vertex;    // per vertex: of the undamaged mesh, or -1: made by a damage
  std::vector<int32_t> old_triangle;  // per triangle: the undamaged one that it is or lies in, or -1
};

// What every damage starts from. marks: on mesh; empty ones stay empty.
DamagedMesh undamaged(TriangleMesh mesh, std::vector<std::optional<SurfacePoint>> marks = {});

// Loses every triangle whose number does not stay (one flag a triangle).
DamagedMesh keep_triangles(DamagedMesh damaged, std::span<const char> stays);

// Every coordinate moves by a normal random number of deviation share * mean edge length.
DamagedMesh with_noise(DamagedMesh damaged, double share, Random& random);

// `count` random places lose all vertices within `radius` mean edges along the surface's edges; 0: one vertex each.
DamagedMesh with_holes(DamagedMesh damaged, int32_t count, double radius, Random& random);

enum class CutEnd { open, capped };  // capped: a fan over each new border

// Loses every vertex p with (p - point) . normal > 0.
DamagedMesh cut_beyond(DamagedMesh damaged, const Vector3& point, const Vector3& normal, CutEnd end);
// Loses every vertex nearer than radius to centre along the surface's edges (so up to a tenth less than the geodesic
// ball): a limb, by a mark at its tip. Crumbs that this leaves, below a hundredth of the triangles, go too.
// Throws cancelled.
DamagedMesh cut_ball(DamagedMesh damaged, const SurfacePoint& centre, double radius, CutEnd end,
                     const Execution& execution = {});

// About factor times the vertices: below 1 decimated by quadric error, above 1 the longest edges split at random places
// along them, which leaves the surface as it is. old_triangle of a decimated mesh is -1 throughout.
DamagedMesh resampled(DamagedMesh damaged, double factor, Random& random);

// By any affine map that does not mirror.
DamagedMesh moved(DamagedMesh damaged, const Matrix4& map);
// A uniformly random turn about the origin, then a move by up to `distance` along each axis, after scaling.
Matrix4 random_similarity(double scale, double distance, Random& random);

// Length of the shortest way along edges from a point to each vertex, infinity beyond `limit`.
Vector edge_path_lengths(const TriangleMesh& mesh, const SurfacePoint& from, double limit);

}  // namespace focal
