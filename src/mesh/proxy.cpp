#include "mesh/proxy.h"

#include <algorithm>
#include <limits>

#include "mesh/closest_point.h"
#include "mesh/decimate.h"
#include "mesh/fill_holes.h"
#include "mesh/nearest_vertex.h"
#include "mesh/wrap.h"

namespace focal {
namespace {

constexpr double cells_a_vertex = 12;  // of a wrap: small proxies do not need a finer one
constexpr double worth_it = 1.1;       // a surface hardly larger than the proxy is analysed directly
constexpr double search_radius = 2;    // in mean edge lengths of the coarse surface

// Whether decimation has lost more than triangles: many small parts, or a few triangles with all the area.
bool has_collapsed(const TriangleMesh& coarse, int32_t vertices) {
  return coarse.vertex_count() < 0.25 * vertices || surface_area(coarse) < 0.5;  // the original area is 1
}

Vector3 normal_of(const TriangleMesh& mesh, int32_t t) {
  const Vector3 a = mesh.positions.row(mesh.triangles(t, 0)), b = mesh.positions.row(mesh.triangles(t, 1)),
                c = mesh.positions.row(mesh.triangles(t, 2));
  return (b - a).cross(c - a);
}

}  // namespace

Proxy make_proxy(std::shared_ptr<const PreparedMesh> mesh, int32_t vertices, const Execution& execution,
                 bool may_mend) {
  if (mesh->is_wrapped && may_mend) {
    WrapParams how;
    if (vertices > 0) how.area_cells = std::min(how.area_cells, cells_a_vertex * vertices);
    TriangleMesh shell = wrap(mesh->surface, how, execution).mesh;
    if (vertices > 0 && shell.vertex_count() > worth_it * vertices)
      shell = decimate(shell, vertices, execution);
    return {mesh,
            std::make_shared<const PreparedMesh>(prepare(
                std::move(shell), {.analysed = AnalysedSurface::as_it_is, .repair_orientation = false}))};
  }
  const bool may_have_holes = !mesh->topology || mesh->topology->boundary_loops > 0;
  const FilledMesh filled = may_mend && may_have_holes ? fill_holes(mesh->surface) : FilledMesh{};
  const TriangleMesh& surface = filled.holes > 0 ? filled.mesh : mesh->surface;
  const bool is_small = vertices == 0 || surface.vertex_count() <= worth_it * vertices;
  if (is_small && filled.holes == 0) return {mesh, mesh};
  TriangleMesh coarse = is_small ? surface : decimate(surface, vertices, execution);
  if (!is_small && has_collapsed(coarse, vertices)) return {mesh, mesh};
  return {mesh,
          std::make_shared<const PreparedMesh>(prepare(
              std::move(coarse), {.analysed = AnalysedSurface::as_it_is, .repair_orientation = false})),
          filled.holes};
}

std::vector<SurfacePoint> to_coarse(const Proxy& proxy, std::span<const SurfacePoint> full_points) {
  std::vector<SurfacePoint> result(full_points.begin(), full_points.end());
  if (proxy.is_full()) return result;
  std::vector<SurfaceQuery> queries;
  for (const auto& point : full_points)
    queries.push_back({(position_of(proxy.full->surface, point) - proxy.coarse->centre) / proxy.coarse->scale,
                       normal_of(proxy.full->surface, point.triangle)});
  return closest_points(proxy.coarse->surface, queries,
                        search_radius * mean_edge_length(proxy.coarse->surface));
}

std::vector<SurfacePoint> to_full(const Proxy& proxy, std::span<const SurfacePoint> coarse_points,
                                  const Execution& execution) {
  std::vector<SurfacePoint> result(coarse_points.begin(), coarse_points.end());
  if (proxy.is_full()) return result;
  const TriangleMesh& coarse = proxy.coarse->surface;
  std::vector<SurfaceQuery> queries;
  for (const auto& point : coarse_points)
    queries.push_back({proxy.coarse->centre + proxy.coarse->scale * position_of(coarse, point),
                       normal_of(coarse, point.triangle)});
  return closest_points(proxy.full->surface, queries,
                        search_radius * mean_edge_length(coarse) * proxy.coarse->scale, execution);
}

std::vector<SurfacePoint> coarse_place_of_vertices(const Proxy& proxy, const Execution& execution) {
  const TriangleMesh& coarse = proxy.coarse->surface;
  const int32_t n = proxy.full->surface.vertex_count();
  std::vector<SurfacePoint> result(n);
  std::vector<std::vector<int32_t>> around(coarse.vertex_count());
  for (int32_t t = 0; t < coarse.triangle_count(); ++t)
    for (int i = 0; i < 3; ++i) around[coarse.triangles(t, i)].push_back(t);
  const NearestVertex search(coarse.positions);
  const auto place_vertex = [&](int64_t v) {
    Vector3 place = proxy.full->surface.positions.row(v);
    if (!proxy.is_full()) place = (place - proxy.coarse->centre) / proxy.coarse->scale;
    double nearest = std::numeric_limits<double>::infinity();
    for (const int32_t t : around[search.nearest(place).first]) {
      Vector3 at[3];
      for (int i = 0; i < 3; ++i) at[i] = coarse.positions.row(coarse.triangles(t, i));
      const Vector3 weights = closest_on_triangle(place, at[0], at[1], at[2]);
      const double squared =
          (weights[0] * at[0] + weights[1] * at[1] + weights[2] * at[2] - place).squaredNorm();
      if (squared < nearest) nearest = squared, result[v] = {t, weights};
    }
  };
  parallel_for_ranges(execution, n, 1024, [&](int64_t begin, int64_t end) {
    for (int64_t v = begin; v < end; ++v) place_vertex(v);
  });
  return result;
}

}  // namespace focal
