#include "correspondence/dense_map.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "landmarks/embedded_surface.h"
#include "mesh/closest_point.h"
#include "mesh/similarity.h"
#include "spectrum/functional_map.h"

namespace focal {
namespace {

// Chosen on faust5k's meshes outside its test split; the comments give the mean errors there, x 100 /
// sqrt(area), of alternatives.
// In sqrt(area): falloff of the landmarks' influence in the first map; plain distances: 2.40.
constexpr double near_landmarks = 0.3;
constexpr int32_t spread_vertices = 1200;  // represent all until the last round; using all is no better
constexpr MapParams rounds_of_map{.first = 20, .last = 128, .step = 8};
constexpr int smoothing_rounds = 2;       // without: 2.6
constexpr double smoothing_radius = 0.1;  // in sqrt(area); 0.06 and 0.15 are slightly worse

void check(const Detection& from, const Detection& to) {
  if (from.model != to.model)
    throw Error(Status::invalid_argument, "the two detections were made by different models",
                "detect on both meshes with one model");
  if (!from.analysis || !to.analysis || from.analysis->params.paper_exact)
    throw Error(Status::invalid_argument, "a detection keeps no analysis that maps can start from",
                "detect with a model of preset default");
}

// The landmarks found on both meshes.
std::vector<int32_t> shared_landmarks(const Detection& from, const Detection& to) {
  std::vector<int32_t> shared = placed_landmarks(from);
  std::erase_if(shared, [&](int32_t l) { return to.places[l].triangle < 0; });
  if (shared.size() < 3)
    throw Error(Status::invalid_argument, "fewer than three landmarks were found on both meshes",
                "check that both belong to the category that the model was trained on");
  return shared;
}

// vertices x landmarks (padded to a multiple of 4): proximity of each landmark.
RowMatrixf nearness(const Detection& detection, const std::vector<int32_t>& landmarks,
                    const Execution& execution) {
  const RowMatrixf distances =
      detection.analysis->metric->distances(places_of(detection, landmarks), execution);
  RowMatrixf result = RowMatrixf::Zero(distances.cols(), (distances.rows() + 3) / 4 * 4);
  result.leftCols(distances.rows()) =
      (-distances.transpose().array() / static_cast<float>(near_landmarks)).exp();
  return result;
}

FunctionalMap map_between(const Detection& from, const Detection& to, const Execution& execution) {
  const std::vector<int32_t> shared = shared_landmarks(from, to);
  const SurfaceAnalysis &a = *from.analysis, &b = *to.analysis;
  auto first = nearest_rows(nearness(from, shared, execution), nearness(to, shared, execution));
  execution.check_cancelled();
  return zoom_out(
      {a.eigenfunctions, a.operators.mass.cast<float>()},
      {b.eigenfunctions, farthest_points(b.surface().positions, spread_vertices), b.surface().positions},
      std::move(first), rounds_of_map, execution);
}

// For every vertex of `a` the nearest point of `b` in the embedding.
std::vector<SurfacePoint> nearest_images(const SurfaceAnalysis& a, const SurfaceAnalysis& b,
                                         const FunctionalMap& map, const Execution& execution) {
  const RowMatrixf here = b.eigenfunctions.leftCols(map.C.cols()) * map.C.transpose();
  const EmbeddedSurface embedded(b.surface(),
                                 [&](int32_t v) -> Eigen::VectorXf { return here.row(v).transpose(); });
  const auto triangles_at = incident_triangles(b.surface());
  std::vector<SurfacePoint> images(static_cast<size_t>(a.surface().vertex_count()));
  parallel_for(execution, a.surface().vertex_count(), [&](int64_t v) {
    images[v] =
        embedded.nearest(triangles_at[map.image[v]], a.eigenfunctions.row(v).head(map.C.rows()).transpose());
  });
  return images;
}

// Smooths the map: moves the image of each vertex to where the best similarity transform of the images around
// it maps it.
void smooth(const SurfaceAnalysis& a, const SurfaceAnalysis& b, std::vector<SurfacePoint>& images,
            const Execution& execution) {
  const auto n = static_cast<int64_t>(images.size());
  const MatrixX3& positions = a.surface().positions;
  MatrixX3 place(n, 3);
  for (int64_t v = 0; v < n; ++v) place.row(v) = position_of(b.surface(), images[v]).transpose();
  const MatrixX3 normals = face_normals(b.surface());
  std::vector<SurfaceQuery> queries(images.size());
  parallel_for(execution, n, [&](int64_t v) {
    const auto ball = connected_ball(a.operators.L, positions, static_cast<int32_t>(v), smoothing_radius);
    const auto count = static_cast<Eigen::Index>(ball.size());
    MatrixX3 there(count, 3), here(count, 3);
    Vector weight(count);
    for (Eigen::Index i = 0; i < count; ++i) {
      there.row(i) = positions.row(ball[i]), here.row(i) = place.row(ball[i]);
      const double near = (there.row(i) - positions.row(v)).squaredNorm() / std::pow(smoothing_radius, 2);
      const double apart =
          (here.row(i) - place.row(v)).norm() / (2 * smoothing_radius);  // on another limb: no weight
      weight[i] = a.operators.mass[ball[i]] * (1 - near) / (1 + std::pow(apart, 4));
    }
    Vector3 to = place.row(v);
    if (count >= 4) to = fit_similarity(there, here, weight)(positions.row(v).transpose());
    queries[v] = {to, normals.row(images[v].triangle).transpose()};
  });
  images = closest_points(b.surface(), queries, 2 * b.operators.mean_edge, execution);
}

// Extends the map from the vertices of the analysed surface to those of the full one: between the images of
// the corners.
std::vector<SurfacePoint> at_full_vertices(const SurfaceAnalysis& a, const SurfaceAnalysis& b,
                                           const std::vector<SurfacePoint>& images,
                                           const Execution& execution) {
  const MatrixX3 normals = face_normals(b.surface());
  std::vector<SurfaceQuery> queries;
  for (const SurfacePoint& place : coarse_place_of_vertices(a.proxy, execution)) {
    SurfaceQuery query{Vector3::Zero(), Vector3::Zero()};
    for (int i = 0; i < 3; ++i) {
      const SurfacePoint& image = images[a.surface().triangles(place.triangle, i)];
      query.position += place.barycentric[i] * position_of(b.surface(), image);
      query.normal += place.barycentric[i] * normals.row(image.triangle).transpose();
    }
    queries.push_back(query);
  }
  return closest_points(b.surface(), queries, 2 * b.operators.mean_edge, execution);
}

}  // namespace

DenseMap dense_map(const Detection& from, const Detection& to, const Execution& execution) {
  check(from, to);
  const SurfaceAnalysis &a = *from.analysis, &b = *to.analysis;
  execution.begin_stage("map", 0, 0.6);
  const FunctionalMap map = map_between(from, to, execution);
  execution.begin_stage("points", 0.6, 1);
  std::vector<SurfacePoint> images = nearest_images(a, b, map, execution);
  for (int round = 0; round < smoothing_rounds; ++round) smooth(a, b, images, execution);
  const auto points = to_full(b.proxy, at_full_vertices(a, b, images, execution), execution);
  DenseMap result{std::vector<SurfacePoint>(from.mesh->surface_vertex.size()), map.residual};
  for (size_t v = 0; v < result.point.size(); ++v)
    if (const int32_t at = from.mesh->surface_vertex[v]; at >= 0)
      result.point[v] = to_source(*to.mesh, points[at]);
  return result;
}

RowMatrixf pulled_back(const DenseMap& map, const PreparedMesh& to, const RowMatrixf& values) {
  RowMatrixf result = RowMatrixf::Zero(static_cast<Eigen::Index>(map.point.size()), values.cols());
  for (size_t v = 0; v < map.point.size(); ++v) {
    if (map.point[v].triangle < 0) continue;
    for (int i = 0; i < 3; ++i)
      result.row(static_cast<Eigen::Index>(v)) += static_cast<float>(map.point[v].barycentric[i]) *
                                                  values.row(to.source.triangles(map.point[v].triangle, i));
  }
  return result;
}

}  // namespace focal
