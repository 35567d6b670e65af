#include "landmarks/exemplar_maps.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "landmarks/embedded_surface.h"
#include "mesh/nearest_vertex.h"
#include "model/sections.h"

namespace focal {
namespace {

constexpr int32_t remembered_points = 800;  // per training shape; with 500 the error grows by a tenth
constexpr int32_t vertices_a_point = 3;     // fewer points on small proxies
constexpr int rings = 3;                    // of triangles around a vertex near a landmark's place
constexpr double noise_share = 0.5;         // of a map's dimensions with independent errors

MatrixX3 rows_of(const MatrixX3& positions, const std::vector<int32_t>& rows) {
  MatrixX3 result(rows.size(), 3);
  for (size_t i = 0; i < rows.size(); ++i) result.row(i) = positions.row(rows[i]);
  return result;
}

Eigen::VectorXf areas_round(const SurfaceAnalysis& analysis, const std::vector<int32_t>& points) {
  const MatrixX3 positions = rows_of(analysis.surface().positions, points);
  const NearestVertex search(positions);
  Eigen::VectorXf area = Eigen::VectorXf::Zero(static_cast<Eigen::Index>(points.size()));
  for (int32_t v = 0; v < analysis.surface().vertex_count(); ++v)
    area[search.nearest(analysis.surface().positions.row(v).transpose()).first] +=
        static_cast<float>(analysis.operators.mass[v]);
  return area;
}

// Stores positions and influences of the points, on the surface that the proxy represents.
void remember_rig(const SurfaceAnalysis& analysis, const std::vector<int32_t>& spread, const ShapeRig& rig,
                  Exemplar& shape) {
  const TriangleMesh& full = analysis.proxy.full->surface;
  const auto points = to_full(analysis.proxy, points_at(analysis.surface(), spread));
  shape.positions.resize(static_cast<Eigen::Index>(points.size()), 3);
  shape.rig = ShapeRig{rig.bind, rig.tip, {}};
  for (size_t i = 0; i < points.size(); ++i) {
    shape.positions.row(static_cast<Eigen::Index>(i)) = position_of(full, points[i]).transpose();
    std::vector<Influence> influences;
    for (int c = 0; c < 3; ++c)
      for (Influence one : rig.influences[full.triangles(points[i].triangle, c)]) {
        one.weight *= static_cast<float>(points[i].barycentric[c]);
        influences.push_back(one);
      }
    shape.rig->influences.push_back(heaviest(influences));
  }
}

// Initial image of each point: between the spread vertices with the most similar distances to the landmarks
// of both.
PlacesBetween first_images(const Exemplar& shape, float reach, const std::vector<int32_t>& landmark,
                           const RowMatrixf& fields, const SpectralTargets& targets) {
  const std::vector<int32_t>& spread = targets.spread;
  std::vector<Eigen::Index> shared;
  for (size_t p = 0; p < landmark.size(); ++p)
    if (shape.marked[landmark[p]]) shared.push_back(static_cast<Eigen::Index>(p));
  RowMatrixf there(shape.distances.rows(), shared.size()), here(spread.size(), shared.size());
  for (size_t s = 0; s < shared.size(); ++s) {
    for (size_t i = 0; i < spread.size(); ++i) here(i, s) = fields(shared[s], spread[i]);
    there.col(s) = shape.distances.col(landmark[shared[s]]).cast<float>() * (reach / target_steps);
  }
  PlacesBetween images = nearest_between(there, here, rows_of(targets.positions, spread));
  for (int32_t& i : images.vertex) i = spread[i];
  images.vertex.resize(shape.samples.Phi.rows() * PlacesBetween::vertices,
                       // The landmarks follow, without weight.
                       0);
  images.weight.resize(images.vertex.size(), 0);
  return images;
}

// The triangles up to a few edges away from a vertex.
std::vector<int32_t> surroundings(const TriangleMesh& mesh,
                                  const std::vector<std::vector<int32_t>>& triangles_at, int32_t vertex) {
  std::vector<int32_t> vertices = {vertex}, triangles;
  for (int ring = 0; ring < rings; ++ring) {
    triangles.clear();
    for (const int32_t v : vertices)
      triangles.insert(triangles.end(), triangles_at[v].begin(), triangles_at[v].end());
    std::sort(triangles.begin(), triangles.end());
    triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
    vertices.clear();
    for (const int32_t t : triangles)
      for (int c = 0; c < 3; ++c) vertices.push_back(mesh.triangles(t, c));
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  }
  return triangles;
}

// The mean of the nearest points of some triangles, weighted by their likelihood under the map's noise. The
// single nearest point would jump from triangle to triangle: off the surface, many are about equally near.
SurfaceQuery mean_of_nearest(const TriangleMesh& mesh, const MatrixX3& normals,
                             const EmbeddedSurface& embedded, const std::vector<int32_t>& triangles,
                             const Eigen::VectorXf& place) {
  std::vector<EmbeddedSurface::Nearest> nearest;
  float least = std::numeric_limits<float>::infinity();
  for (const int32_t t : triangles) {
    nearest.push_back(embedded.nearest(t, place));
    least = std::min(least, nearest.back().squared);
  }
  const double sharpness = noise_share * static_cast<double>(place.size()) / (2 * std::max(least, 1e-12f));
  SurfaceQuery sum{Vector3::Zero(), Vector3::Zero()};
  double total = 0;
  for (const auto& [point, squared] : nearest) {
    const double weight = std::exp(sharpness * (least - squared));
    sum.position += weight * position_of(mesh, point);
    sum.normal += weight * normals.row(point.triangle).transpose();
    total += weight;
  }
  sum.position /= total;
  return sum;
}

TransferredLandmarks carry(const Exemplar& shape, const FunctionalMap& map, const SurfaceAnalysis& analysis,
                           const MatrixX3& normals, const std::vector<std::vector<int32_t>>& triangles_at) {
  const auto L = static_cast<int32_t>(shape.marked.size());
  const auto points = static_cast<int32_t>(shape.distances.rows());
  const TriangleMesh& surface = analysis.surface();
  std::unordered_map<int32_t, Eigen::VectorXf> known;
  const EmbeddedSurface embedded(surface, [&](int32_t v) -> Eigen::VectorXf {
    Eigen::VectorXf& place = known[v];
    if (place.size() == 0) place = map.C * analysis.eigenfunctions.row(v).head(map.C.cols()).transpose();
    return place;
  });
  TransferredLandmarks result;
  result.residual = map.residual;
  result.places.resize(L);
  for (int32_t l = 0; l < L; ++l) {
    if (!shape.marked[l]) continue;
    for (int32_t i = 0; i < PlacesBetween::vertices; ++i) {
      const size_t at = static_cast<size_t>(points + l) * PlacesBetween::vertices + i;
      const float share = map.places.weight[at];
      if (share > 0)
        result.places[l].push_back(
            {mean_of_nearest(surface, normals, embedded,
                             surroundings(surface, triangles_at, map.places.vertex[at]),
                             shape.samples.Phi.row(points + l).head(map.C.rows()).transpose()),
             share});
    }
  }
  return result;
}

FunctionalMap refined(const Exemplar& shape, const SurfaceAnalysis& analysis, const SpectralTargets& targets,
                      PlacesBetween images, const MapParams& params) {
  return analysis.engine->zoom_out(shape.samples, targets, std::move(images), params);
}

// A shape and the initial images of its points on the new surface.
struct Start {
  int32_t shape = 0;
  PlacesBetween images;
  float residual = 0;  // of the coarse map
};

// The few starts whose coarse maps fit best; only these maps are continued.
std::vector<Start> most_alike(std::vector<Start> starts, const std::vector<Exemplar>& exemplars,
                              const SurfaceAnalysis& analysis, const SpectralTargets& targets,
                              const TransferParams& params, const Execution& execution) {
  const MapParams coarse{.first = params.map.first,
                         .last = params.map.first,
                         .step = 4,
                         .exact_from = std::numeric_limits<int32_t>::max()};
  parallel_for(execution, static_cast<int64_t>(starts.size()), [&](int64_t i) {
    Start& start = starts[i];
    FunctionalMap map = refined(exemplars[start.shape], analysis, targets, std::move(start.images), coarse);
    start.images = std::move(map.places), start.residual = map.residual;
  });
  std::stable_sort(starts.begin(), starts.end(),
                   [](const Start& a, const Start& b) { return a.residual < b.residual; });
  starts.resize(params.most_alike);
  return starts;
}

SpectralTargets spectral_targets(const SurfaceAnalysis& analysis, int32_t spread) {
  // Samples are drawn by number: unlike farthest points, which have many ties, they do not change when the
  // mesh is transformed.
  const auto count = std::min<size_t>(analysis.samples.size(), spread);
  return {analysis.eigenfunctions,
          {analysis.samples.begin(), analysis.samples.begin() + count},
          analysis.surface().positions};
}

}  // namespace

Exemplar remember_shape(const SurfaceAnalysis& analysis,
                        const std::vector<std::optional<SurfacePoint>>& points, const RowMatrixf& fields,
                        float reach, const std::optional<ShapeRig>& rig) {
  const auto& surface = analysis.surface();
  const auto Phi = analysis.eigenfunctions.leftCols(
      std::min<Eigen::Index>(analysis.eigenfunctions.cols(), MapParams().last));  // maps use no more
  const auto L = static_cast<Eigen::Index>(points.size());
  const int32_t proxy = analysis.params.proxy_vertices;
  const std::vector<int32_t> spread =
      farthest_points(surface.positions,
                      proxy > 0 ? std::min(remembered_points, proxy / vertices_a_point) : remembered_points);
  const auto count = static_cast<Eigen::Index>(spread.size());
  Exemplar shape;
  shape.samples.Phi = RowMatrixf::Zero(count + L, Phi.cols());
  shape.samples.weight = Eigen::VectorXf::Zero(count + L);
  shape.samples.weight.head(count) = areas_round(analysis, spread);
  shape.distances = TargetMatrix::Constant(count, L, target_missing);
  for (Eigen::Index i = 0; i < count; ++i) shape.samples.Phi.row(i) = Phi.row(spread[i]);
  Eigen::Index field = 0;
  for (Eigen::Index l = 0; l < L; ++l) {
    shape.marked.push_back(points[l].has_value());
    if (!points[l]) continue;
    for (int c = 0; c < 3; ++c)
      shape.samples.Phi.row(count + l) +=
          static_cast<float>(points[l]->barycentric[c]) * Phi.row(surface.triangles(points[l]->triangle, c));
    for (Eigen::Index i = 0; i < count; ++i)
      shape.distances(i, l) =
          static_cast<uint16_t>(std::lround(std::min(fields(field, spread[i]) / reach, 1.0f) * target_steps));
    ++field;
  }
  shape.bulge.resize(count, analysis.bulge.cols());
  for (Eigen::Index i = 0; i < count; ++i) shape.bulge.row(i) = analysis.bulge.row(spread[i]);
  for (float& value : shape.bulge.reshaped()) value = kept_bulge(value);
  shape.step = std::max(shape.samples.Phi.cwiseAbs().maxCoeff(), 1e-6f) / (eigenfunction_zero - 1);
  for (float& value : shape.samples.Phi.reshaped()) value = std::round(value / shape.step) * shape.step;
  if (rig) remember_rig(analysis, spread, *rig, shape);
  return shape;
}

std::vector<ShapeMap> map_shapes(const std::vector<Exemplar>& exemplars, std::span<const int32_t> among,
                                 float reach, const SurfaceAnalysis& analysis,
                                 const std::vector<int32_t>& landmark, const RowMatrixf& fields,
                                 const TransferParams& params, const Execution& execution) {
  const SpectralTargets targets = spectral_targets(analysis, params.spread);
  std::vector<Start> starts(among.size());
  parallel_for(execution, static_cast<int64_t>(among.size()), [&](int64_t s) {
    starts[s] = {among[s], first_images(exemplars[among[s]], reach, landmark, fields, targets)};
  });
  if (params.most_alike > 0 && params.most_alike < static_cast<int32_t>(starts.size()))
    starts = most_alike(std::move(starts), exemplars, analysis, targets, params, execution);
  std::vector<ShapeMap> result(starts.size());
  parallel_for(execution, static_cast<int64_t>(starts.size()), [&](int64_t i) {
    const Exemplar& shape = exemplars[starts[i].shape];
    MapParams map = params.map;
    map.exact_from = static_cast<int32_t>(shape.distances.rows());
    result[i] = {starts[i].shape, refined(shape, analysis, targets, std::move(starts[i].images), map)};
  });
  return result;
}

void find_exact_images(std::vector<ShapeMap>& maps, const std::vector<Exemplar>& exemplars,
                       const SurfaceAnalysis& analysis, const Execution& execution) {
  parallel_for(execution, static_cast<int64_t>(maps.size()), [&](int64_t m) {
    FunctionalMap& map = maps[m].map;
    const Exemplar& shape = exemplars[maps[m].shape];
    const auto images = nearest_rows(shape.samples.Phi.topLeftCorner(shape.distances.rows(), map.C.rows()),
                                     analysis.eigenfunctions.leftCols(map.C.cols()) * map.C.transpose());
    std::copy(images.begin(), images.end(), map.image.begin());
  });
}

float bulge_agreement(const Exemplar& shape, const FunctionalMap& map, const SurfaceAnalysis& analysis) {
  const Eigen::Index points = shape.bulge.rows();
  if (shape.bulge.size() == 0 || analysis.bulge.rows() == 0) return 0;
  const Eigen::VectorXf weight = shape.samples.weight.head(points) / shape.samples.weight.head(points).sum();
  float sum = 0;
  for (Eigen::Index r = 0; r < shape.bulge.cols(); ++r) {
    Eigen::VectorXf there = shape.bulge.col(r), here(points);
    for (Eigen::Index i = 0; i < points; ++i) here[i] = analysis.bulge(map.image[i], r);
    there.array() -= weight.dot(there), here.array() -= weight.dot(here);
    const float size = std::sqrt(weight.dot(there.cwiseAbs2()) * weight.dot(here.cwiseAbs2()));
    if (size > 0) sum += weight.dot(there.cwiseProduct(here)) / size;
  }
  return sum / static_cast<float>(shape.bulge.cols());
}

std::vector<TransferredLandmarks> transfer_landmarks(const std::vector<Exemplar>& exemplars,
                                                     const std::vector<ShapeMap>& maps,
                                                     const SurfaceAnalysis& analysis,
                                                     const Execution& execution) {
  const auto triangles_at = incident_triangles(analysis.surface());
  const MatrixX3 normals = face_normals(analysis.surface());
  std::vector<TransferredLandmarks> result(maps.size());
  parallel_for(execution, static_cast<int64_t>(maps.size()), [&](int64_t i) {
    result[i] = carry(exemplars[maps[i].shape], maps[i].map, analysis, normals, triangles_at);
  });
  return result;
}

}  // namespace focal
