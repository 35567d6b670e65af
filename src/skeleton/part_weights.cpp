#include "skeleton/part_weights.h"

#include <algorithm>
#include <cmath>

#include "mesh/closest_point.h"
#include "mesh/components.h"
#include "mesh/stitch.h"

namespace focal {
namespace {
// Lengths relative to the extent of the mesh, areas relative to its area. Chosen on characters of game packs.
constexpr double touching = 5e-4;  // vertices that touch
constexpr double max_rigid_area = 0.4, small_extent = 0.45, tiny_extent = 0.2;
constexpr float nearly_one = 0.9F;      // weight of the main joint in a part of any shape that is rigid
constexpr float one_bone = 0.75F;       // in a small one that does not bend with a joint
constexpr float tiny_one_bone = 0.55F;  // in a tiny one
constexpr float two_bones = 0.85F;      // of the two main joints in a tiny one
constexpr float bends_with = 0.2F;      // weight of a joint that a part around it bends with
// Largest extra distance of a point with a similar normal relative to the nearest point, in mean edges of the
// analysed surface.
constexpr double faces_other_way = 1.5;

double extent_of(const MatrixX3& positions) {
  return (positions.colwise().maxCoeff() - positions.colwise().minCoeff()).norm();
}

// Of the nearest point and the nearest with a similar normal the latter, unless it is on another part of the
// body.
std::vector<SurfacePoint> places_of_vertices(const Proxy& proxy, const Execution& execution) {
  const TriangleMesh& full = proxy.full->surface;
  const TriangleMesh& coarse = proxy.coarse->surface;
  const MatrixX3 normals = area_normals(full);
  std::vector<SurfaceQuery> facing, any;
  for (int32_t v = 0; v < full.vertex_count(); ++v) {
    const Vector3 place = (full.positions.row(v).transpose() - proxy.coarse->centre) / proxy.coarse->scale;
    any.push_back({place, Vector3::Zero()});
    facing.push_back({place, normals.row(v).transpose()});
  }
  const double edge = mean_edge_length(coarse);
  std::vector<SurfacePoint> result = closest_points(coarse, any, 2 * edge, execution);
  const auto alike = closest_points(coarse, facing, 2 * edge, execution);
  for (size_t v = 0; v < result.size(); ++v) {
    const auto away = [&](const SurfacePoint& p) {
      return (position_of(coarse, p) - any[v].position).norm();
    };
    if (alike[v].triangle >= 0 && away(alike[v]) < away(result[v]) + faces_other_way * edge)
      result[v] = alike[v];
  }
  return result;
}

RowMatrixf lifted(const RowMatrixf& weights, const SurfaceAnalysis& analysis, const Execution& execution) {
  if (analysis.proxy.is_full()) return weights;
  const auto places = places_of_vertices(analysis.proxy, execution);
  RowMatrixf result = RowMatrixf::Zero(static_cast<Eigen::Index>(places.size()), weights.cols());
  parallel_for_ranges(execution, result.rows(), 1024, [&](int64_t begin, int64_t end) {
    for (int64_t v = begin; v < end; ++v)
      for (int c = 0; c < 3; ++c)
        result.row(v) += static_cast<float>(places[v].barycentric[c]) *
                         weights.row(analysis.surface().triangles(places[v].triangle, c));
  });
  return result;
}

// Vertices at one position get the mean of their weights, so that seams between parts stay closed.
void close_seams(RowMatrixf& weights, const MatrixX3& positions) {
  const std::vector<int32_t> first = first_at_place(positions, touching * extent_of(positions));
  std::vector<float> count(first.size(), 1);
  for (size_t v = 0; v < first.size(); ++v)
    if (first[v] != static_cast<int32_t>(v))
      weights.row(first[v]) += weights.row(static_cast<Eigen::Index>(v)), ++count[first[v]];
  for (size_t v = 0; v < first.size(); ++v)
    if (first[v] == static_cast<int32_t>(v)) weights.row(first[v]) /= count[v];
  for (size_t v = 0; v < first.size(); ++v) weights.row(static_cast<Eigen::Index>(v)) = weights.row(first[v]);
}

struct Part {
  std::vector<int32_t> vertices;
  double area = 0;
  Eigen::RowVectorXf mean;  // weights
};

std::vector<Part> parts_of(const TriangleMesh& mesh, const RowMatrixf& weights) {
  const Components components = components_of(mesh);
  std::vector<Part> parts(static_cast<size_t>(components.count));
  const Vector area = area_normals(mesh).rowwise().norm();
  for (Part& part : parts) part.mean = Eigen::RowVectorXf::Zero(weights.cols());
  for (int32_t v = 0; v < mesh.vertex_count(); ++v) {
    Part& part = parts[components.of_vertex[v]];
    part.vertices.push_back(v), part.area += area[v];
    part.mean += static_cast<float>(area[v]) * weights.row(v);
  }
  for (Part& part : parts)
    if (const float sum = part.mean.sum(); sum > 0) part.mean /= sum;
  return parts;
}

struct Box {
  Vector3 low, high;
};

Box box_of(const Part& part, const MatrixX3& positions) {
  Box box{positions.row(part.vertices[0]).transpose(), positions.row(part.vertices[0]).transpose()};
  for (const int32_t v : part.vertices) {
    box.low = box.low.cwiseMin(positions.row(v).transpose());
    box.high = box.high.cwiseMax(positions.row(v).transpose());
  }
  return box;
}

// Whether a part is around a joint that moves some of it, like a cuff or a collar, and bends with it.
bool is_round_a_joint(const Part& part, const Box& box, const std::vector<Vector3>& place) {
  for (size_t j = 0; j < place.size(); ++j)
    if (part.mean[static_cast<Eigen::Index>(j)] > bends_with && (place[j] - box.low).minCoeff() > 0 &&
        (box.high - place[j]).minCoeff() > 0)
      return true;
  return false;
}

// The common weights of all vertices of a rigid part; empty: not rigid. extent, area: of the mesh.
Eigen::RowVectorXf rigid_weights(const Part& part, const MatrixX3& positions, const PlacedSkeleton& skeleton,
                                 double extent, double area) {
  if (part.area > max_rigid_area * area) return {};
  Eigen::Index main = 0, second = 0;
  Eigen::RowVectorXf rest = part.mean;
  const float most = rest.maxCoeff(&main);
  Eigen::RowVectorXf result = Eigen::RowVectorXf::Zero(rest.size());
  if (most > nearly_one) return result[main] = 1, result;
  const Box box = box_of(part, positions);
  const double size = (box.high - box.low).norm() / extent;
  if (size > small_extent || is_round_a_joint(part, box, skeleton.place)) return {};
  if (most > one_bone) return result[main] = 1, result;
  if (size > tiny_extent) return {};
  rest[main] = 0;
  const float more = rest.maxCoeff(&second);
  const bool are_neighbours =
      skeleton.joints[main].parent == second || skeleton.joints[second].parent == main;
  if (are_neighbours && most + more > two_bones)
    return result[main] = most / (most + more), result[second] = more / (most + more), result;
  if (most < tiny_one_bone) return {};
  return result[main] = 1, result;
}

// skeleton: in the coordinates of the mesh.
void stiffen_parts(RowMatrixf& weights, const TriangleMesh& mesh, const PlacedSkeleton& skeleton) {
  const std::vector<Part> parts = parts_of(mesh, weights);
  if (parts.size() < 2) return;
  const double extent = extent_of(mesh.positions);
  double area = 0;
  for (const Part& part : parts) area += part.area;
  for (const Part& part : parts) {
    const Eigen::RowVectorXf rigid = rigid_weights(part, mesh.positions, skeleton, extent, area);
    if (rigid.size() > 0)
      for (const int32_t v : part.vertices) weights.row(v) = rigid;
  }
}

}  // namespace

void put_influences_by_parts(const SurfaceWeights& found, const PlacedSkeleton& skeleton,
                             const SurfaceAnalysis& analysis, int32_t most, Rig& rig,
                             const Execution& execution) {
  const PreparedMesh& full = *analysis.proxy.full;
  RowMatrixf weights = lifted(found.weights, analysis, execution);
  close_seams(weights, full.surface.positions);
  for (Eigen::Index v = 0; v < weights.rows(); ++v) sharpen(weights.row(v), found.exponent);
  PlacedSkeleton on_mesh = skeleton;
  if (!analysis.proxy.is_full())
    for (Vector3& p : on_mesh.place) p = analysis.proxy.coarse->centre + analysis.proxy.coarse->scale * p;
  stiffen_parts(weights, full.surface, on_mesh);
  clear_influences(full.surface_vertex.size(), most, rig);
  for (size_t v = 0; v < full.surface_vertex.size(); ++v)
    if (full.surface_vertex[v] >= 0) put_influences(weights.row(full.surface_vertex[v]), most, v, rig);
}

}  // namespace focal
