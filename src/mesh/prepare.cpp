#include "mesh/prepare.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/error.h"
#include "mesh/components.h"
#include "mesh/stitch.h"
#include "mesh/wrap.h"

namespace focal {
namespace {

constexpr int32_t smallest_surface = 12;  // vertices; fewer do not define a shape

void require_triangles(const TriangleMesh& mesh) {
  if (mesh.triangle_count() == 0)
    throw Error(Status::invalid_mesh, "the mesh has no triangles",
                "give a triangle mesh; points and lines are not analysed");
}

void validate(const TriangleMesh& mesh) {
  if (!mesh.positions.allFinite())
    throw Error(Status::invalid_mesh, "a vertex position is NaN or infinite",
                "clean the mesh in the tool that made it and export it again");
  if (mesh.triangles.minCoeff() < 0 || mesh.triangles.maxCoeff() >= mesh.vertex_count())
    throw Error(Status::invalid_mesh, "a triangle index is out of range",
                "indices run from 0 to the number of vertices - 1");
}

// Input that cannot be analysed.
struct Invalid {
  std::vector<char> vertex, triangle;
};

// Finds invalid input and replaces it by harmless values.
Invalid replace_invalid(TriangleMesh& mesh) {
  Invalid result{std::vector<char>(mesh.vertex_count(), 0), std::vector<char>(mesh.triangle_count(), 0)};
  for (int32_t v = 0; v < mesh.vertex_count(); ++v)
    if (!mesh.positions.row(v).allFinite()) result.vertex[v] = 1, mesh.positions.row(v).setZero();
  for (int32_t t = 0; t < mesh.triangle_count(); ++t)
    for (int i = 0; i < 3; ++i) {
      const int32_t v = mesh.triangles(t, i);
      if (v < 0 || v >= mesh.vertex_count() || result.vertex[v]) result.triangle[t] = 1;
    }
  for (int32_t t = 0; t < mesh.triangle_count(); ++t)
    if (result.triangle[t]) mesh.triangles.row(t).setZero();
  return result;
}

// The finaliser of MurmurHash3 (A. Appleby), which spreads similar numbers over a table.
uint64_t mixed(uint64_t x) {
  x = (x ^ (x >> 33)) * 0xff51afd7ed558ccdULL;
  x = (x ^ (x >> 33)) * 0xc4ceb9fe1a85ec53ULL;
  return x ^ (x >> 33);
}

// For each vertex the smallest number of a vertex at exactly its position.
std::vector<int32_t> weld(const MatrixX3& positions) {
  const auto n = static_cast<int32_t>(positions.rows());
  std::vector<int32_t> first(n), table(std::bit_ceil(2 * static_cast<size_t>(n) + 1), -1);
  const auto slot_of = [&](int32_t v) {
    uint64_t hash = 0;
    for (int i = 0; i < 3; ++i)  // + 0.0 makes -0 and 0 equal
      hash = mixed(hash ^ std::bit_cast<uint64_t>(positions(v, i) + 0.0));
    return hash & (table.size() - 1);
  };
  for (int32_t v = 0; v < n; ++v) {
    size_t slot = slot_of(v);
    while (table[slot] >= 0 && positions.row(table[slot]) != positions.row(v))
      slot = (slot + 1) & (table.size() - 1);
    if (table[slot] < 0) table[slot] = v;
    first[v] = table[slot];
  }
  return first;
}

// The source triangles that remain after dropping those with repeated corners and duplicates of the same
// corner set. Kept triangles are chained by their smallest corner, so that only a few are compared. invalid:
// others to drop; empty: none.
std::vector<int32_t> kept_triangles(const MatrixX3i& corners, int32_t vertex_count, bool drop,
                                    const std::vector<char>& invalid) {
  std::vector<int32_t> kept;
  kept.reserve(corners.rows());
  const auto sorted = [&](int32_t t) {
    std::array<int32_t, 3> c{corners(t, 0), corners(t, 1), corners(t, 2)};
    std::sort(c.begin(), c.end());
    return c;
  };
  std::vector<int32_t> head(drop ? vertex_count : 0, -1), next;
  next.reserve(drop ? corners.rows() : 0);
  for (int32_t t = 0; t < corners.rows(); ++t) {
    if (!invalid.empty() && invalid[t]) continue;
    if (drop) {
      const auto c = sorted(t);
      if (c[0] == c[1] || c[1] == c[2]) continue;
      int32_t other = head[c[0]];
      while (other >= 0 && sorted(kept[other]) != c) other = next[other];
      if (other >= 0) continue;
      next.push_back(std::exchange(head[c[0]], static_cast<int32_t>(kept.size())));
    }
    kept.push_back(t);
  }
  return kept;
}

// Sets surface and the four maps; first[v] is the source vertex that represents v.
void build_surface(PreparedMesh& mesh, const std::vector<int32_t>& first, const MatrixX3i& corners) {
  mesh.source_vertex.clear();
  mesh.surface_vertex.assign(mesh.source.vertex_count(), -1);
  mesh.surface_triangle.assign(mesh.source.triangle_count(), -1);
  std::vector<char> used(mesh.source.vertex_count(), 0);
  for (const int32_t t : mesh.source_triangle)
    for (int i = 0; i < 3; ++i) used[corners(t, i)] = 1;
  for (int32_t v = 0; v < mesh.source.vertex_count(); ++v)
    if (used[v]) {
      mesh.surface_vertex[v] = static_cast<int32_t>(mesh.source_vertex.size());
      mesh.source_vertex.push_back(v);
    }
  for (int32_t v = 0; v < mesh.source.vertex_count(); ++v)
    mesh.surface_vertex[v] = mesh.surface_vertex[first[v]];
  mesh.surface.positions.resize(mesh.source_vertex.size(), 3);
  for (size_t v = 0; v < mesh.source_vertex.size(); ++v)
    mesh.surface.positions.row(v) = mesh.source.positions.row(mesh.source_vertex[v]);
  mesh.surface.triangles.resize(mesh.source_triangle.size(), 3);
  for (size_t t = 0; t < mesh.source_triangle.size(); ++t) {
    mesh.surface_triangle[mesh.source_triangle[t]] = static_cast<int32_t>(t);
    for (int i = 0; i < 3; ++i)
      mesh.surface.triangles(t, i) = mesh.surface_vertex[corners(mesh.source_triangle[t], i)];
  }
}

// Input of build_surface; first: per source vertex the one that represents it.
struct Corners {
  std::vector<int32_t> first;
  MatrixX3i of_triangle;
};

void build_surface(PreparedMesh& mesh, const PrepareParams& params, const std::vector<char>& invalid,
                   Corners& corners) {
  corners.of_triangle = mesh.source.triangles.unaryExpr([&](int32_t v) { return corners.first[v]; });
  mesh.source_triangle =
      kept_triangles(corners.of_triangle, mesh.source.vertex_count(), params.drop_degenerate, invalid);
  build_surface(mesh, corners.first, corners.of_triangle);
}

// Joins borders that nearly meet and rebuilds the surface.
void stitch(PreparedMesh& mesh, const PrepareParams& params, const std::vector<char>& invalid,
            Corners& corners) {
  const std::vector<int32_t> together = stitched_borders(mesh.surface, edge_sides(mesh.surface));
  if (together.empty()) return;
  for (int32_t& v : corners.first)
    if (const int32_t s = mesh.surface_vertex[v]; s >= 0) v = mesh.source_vertex[together[s]];
  build_surface(mesh, params, invalid, corners);
}

void normalise(PreparedMesh& mesh) {
  auto& positions = mesh.surface.positions;
  const Vector3 low = positions.colwise().minCoeff(), high = positions.colwise().maxCoeff();
  mesh.centre = low + (high - low) / 2;
  const double size = (high - low).maxCoeff();
  if (!(size > 0) || !std::isfinite(size))
    throw Error(Status::invalid_mesh, "the mesh has no extent",
                "all its vertices are at one point, or their coordinates overflow");
  positions.rowwise() -= mesh.centre.transpose();
  positions /= size;  // first to size 1: areas of meshes of size 1e-30 or 1e30 stay in range
  const double area = surface_area(mesh.surface);
  if (!(area > 1e-12))
    throw Error(Status::invalid_mesh, "the surface has no area", "all its triangles are degenerate");
  positions /= std::sqrt(area);
  mesh.scale = size * std::sqrt(area);
}

// Flips triangles as Orientation requires, in the surface and for to_surface and to_source.
void inspect(PreparedMesh& mesh) {
  const EdgeSides edges = edge_sides(mesh.surface);
  mesh.topology = topology_of(mesh.surface, edges);
  Orientation orientation = consistent_orientation(mesh.surface, edges);
  mesh.is_oriented = orientation.is_consistent;
  if (orientation.flips == 0) return;
  mesh.flipped = std::move(orientation.flipped);
  for (int32_t t = 0; t < mesh.surface.triangle_count(); ++t)
    if (mesh.flipped[t]) std::swap(mesh.surface.triangles(t, 1), mesh.surface.triangles(t, 2));
}

void warn_of_topology(PreparedMesh& mesh) {
  const auto say = [&](int64_t count, const char* one, const char* several) {
    if (count > 0) mesh.warnings.push_back(std::to_string(count) + (count == 1 ? one : several));
  };
  say(mesh.topology->nonmanifold_edges, " edge is shared by more than two triangles",
      " edges are shared by more than two triangles");
  say(mesh.topology->nonmanifold_vertices,
      " vertex is non-manifold: parts of the surface meet only in this point",
      " vertices are non-manifold: parts of the surface meet only in these points");
  say(flipped_triangles(mesh), " triangle has the wrong orientation; it is flipped for the analysis",
      " triangles have the wrong orientation; they are flipped for the analysis");
  if (!mesh.is_oriented)
    mesh.warnings.push_back(
        "the triangles cannot be oriented consistently (as on a Moebius strip): left and right may be "
        "mistaken");
}

void warn(PreparedMesh& mesh, std::span<const MeshPiece> pieces) {
  const auto say = [&](const std::string& text) { mesh.warnings.push_back(text); };
  if (mesh.invalid_triangles > 0)
    say(std::to_string(mesh.invalid_triangles) +
        " triangles with a NaN or infinite corner, or an index out of range, are left out");
  if (const auto dropped = degenerate_triangles(mesh))
    say(std::to_string(dropped) + " degenerate or repeated triangles are ignored");
  for (const Scenery& scenery : mesh.scenery)
    say("left out of the analysis: " + describe(scenery, pieces) +
        "; keep_scenery (--keep-scenery) keeps it");
  if (mesh.components > 1)
    say("the surface has " + std::to_string(mesh.components) + " separate parts; they are analysed as one" +
        (mesh.is_wrapped ? ", by a closed surface round them all" : ", bridged at the nearest vertices"));
  if (mesh.topology) warn_of_topology(mesh);
}

// Removes scenery from the kept triangles and rebuilds the surface from the others.
void leave_out_scenery(const PrepareParams& params, const Corners& corners, PreparedMesh& mesh,
                       Components& components) {
  FoundScenery found = find_scenery(mesh.surface, components, mesh.source_triangle, params.pieces);
  if (found.parts.empty()) return;
  mesh.scenery = std::move(found.parts);
  std::vector<int32_t> kept;
  for (size_t t = 0; t < found.triangles.size(); ++t)
    if (!found.triangles[t]) kept.push_back(mesh.source_triangle[t]);
  mesh.scenery_triangles = static_cast<int64_t>(mesh.source_triangle.size() - kept.size());
  mesh.source_triangle = std::move(kept);
  build_surface(mesh, corners.first, corners.of_triangle);
  components = components_of(mesh.surface);
}

// Whether the triangles do not form a connected body: neighbours on the body need not share edges.
bool needs_wrap(const PreparedMesh& mesh) {
  constexpr double many = 0.02;  // of all edges
  if (mesh.components > 1) return true;
  return mesh.topology &&
         static_cast<double>(mesh.topology->nonmanifold_edges) > many * mesh.surface.vertex_count();
}

// Removes references to the vertices at the origin that replace_invalid created.
void forget(const std::vector<char>& invalid_vertices, PreparedMesh& mesh) {
  for (size_t v = 0; v < invalid_vertices.size(); ++v)
    if (invalid_vertices[v]) mesh.surface_vertex[v] = -1;
}

// The same point in the other order of its triangle's corners.
Vector3 renumbered(const PreparedMesh& mesh, int32_t surface_triangle, Vector3 barycentric) {
  if (surface_triangle >= 0 && !mesh.flipped.empty() && mesh.flipped[surface_triangle])
    std::swap(barycentric[1], barycentric[2]);
  return barycentric;
}

}  // namespace

PreparedMesh wrapped(const PreparedMesh& mesh, const Execution& execution) {
  return prepare(wrap(mesh.surface, {}, execution).mesh,
                 {.analysed = AnalysedSurface::as_it_is, .repair_orientation = false}, execution);
}

int64_t degenerate_triangles(const PreparedMesh& mesh) {
  return mesh.source.triangle_count() - mesh.surface.triangle_count() - mesh.invalid_triangles -
         mesh.scenery_triangles;
}

int64_t flipped_triangles(const PreparedMesh& mesh) {
  return std::count(mesh.flipped.begin(), mesh.flipped.end(), 1);
}

std::vector<std::pair<int32_t, int32_t>> bridges_of(const PreparedMesh& mesh) {
  return mesh.components > 1 ? bridge_pairs(mesh.surface, components_of(mesh.surface))
                             : std::vector<std::pair<int32_t, int32_t>>{};
}

MatrixX3 analysed_positions(const PreparedMesh& mesh) {
  MatrixX3 result(static_cast<Eigen::Index>(mesh.source_vertex.size()), 3);
  for (size_t v = 0; v < mesh.source_vertex.size(); ++v)
    result.row(static_cast<Eigen::Index>(v)) = mesh.source.positions.row(mesh.source_vertex[v]);
  return result;
}

PreparedMesh prepare(TriangleMesh source, const PrepareParams& params, const Execution& execution) {
  require_triangles(source);
  Invalid invalid;
  params.lenient ? void(invalid = replace_invalid(source)) : validate(source);
  PreparedMesh mesh;
  mesh.source = std::move(source);
  mesh.invalid_triangles = std::count(invalid.triangle.begin(), invalid.triangle.end(), 1);
  execution.check_cancelled();
  Corners corners{std::vector<int32_t>(mesh.source.vertex_count()), {}};
  std::iota(corners.first.begin(), corners.first.end(), 0);
  if (params.weld) corners.first = weld(mesh.source.positions);
  execution.check_cancelled();
  build_surface(mesh, params, invalid.triangle, corners);
  execution.check_cancelled();
  if (params.weld && params.repair_orientation) stitch(mesh, params, invalid.triangle, corners);
  if (mesh.surface.vertex_count() < smallest_surface)
    throw Error(Status::mesh_too_small,
                "the surface has " + std::to_string(mesh.surface.vertex_count()) + " different vertices",
                "at least " + std::to_string(smallest_surface) + " are needed");
  execution.check_cancelled();
  Components components = components_of(mesh.surface);
  if (params.leave_out_scenery) leave_out_scenery(params, corners, mesh, components);
  forget(invalid.vertex, mesh);
  mesh.components = components.count;
  execution.check_cancelled();
  normalise(mesh);
  execution.check_cancelled();
  if (params.repair_orientation) inspect(mesh);
  mesh.is_wrapped = params.analysed == AnalysedSurface::wrapped ||
                    (params.analysed == AnalysedSurface::automatic && needs_wrap(mesh));
  execution.check_cancelled();
  warn(mesh, params.pieces);
  return mesh;
}

SurfacePoint to_surface(const PreparedMesh& mesh, const SurfacePoint& source_point) {
  const int32_t triangle = mesh.surface_triangle[source_point.triangle];
  return {triangle, renumbered(mesh, triangle, source_point.barycentric)};
}

SurfacePoint to_source(const PreparedMesh& mesh, const SurfacePoint& surface_point) {
  return {mesh.source_triangle[surface_point.triangle],
          renumbered(mesh, surface_point.triangle, surface_point.barycentric)};
}

SurfacePoint at_vertex(const TriangleMesh& mesh, int32_t vertex) {
  for (int32_t t = 0; t < mesh.triangle_count(); ++t)
    for (int i = 0; i < 3; ++i)
      if (mesh.triangles(t, i) == vertex) return {t, Vector3::Unit(i)};
  return {};
}

std::vector<SurfacePoint> points_at(const TriangleMesh& mesh, std::span<const int32_t> vertices) {
  std::vector<SurfacePoint> corner(mesh.vertex_count()), result;
  for (int32_t t = 0; t < mesh.triangle_count(); ++t)
    for (int i = 0; i < 3; ++i) corner[mesh.triangles(t, i)] = {t, Vector3::Unit(i)};
  for (const int32_t v : vertices) result.push_back(corner[v]);
  return result;
}

}  // namespace focal
