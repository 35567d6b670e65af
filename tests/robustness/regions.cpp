#include "regions.h"

#include <cmath>
#include <cstdio>

#include "geodesics/heat_method.h"
#include "landmarks/regions.h"
#include "operators/operators.h"

namespace focal_robustness {
namespace {

using namespace focal;

constexpr double radii[] = {0.1, 0.2};

// Distances in sqrt(area) from points of the mesh to all its vertices, points x vertices.
RowMatrixf distances_from(const PreparedMesh& mesh, std::vector<SurfacePoint> points) {
  for (auto& point : points) point = to_surface(mesh, point);
  const Operators operators = make_operators(mesh.surface, bridges_of(mesh), true);
  const HeatMethod heat(mesh.surface, operators);
  const RowMatrixf fields = heat.distances(points, {});
  RowMatrixf result(fields.rows(), mesh.source.vertex_count());
  for (Eigen::Index v = 0; v < result.cols(); ++v) result.col(v) = fields.col(mesh.surface_vertex[v]);
  return result;
}

// As focal_detection_distances gives them, in sqrt(area).
std::vector<std::vector<float>> product_distances(const std::shared_ptr<const PreparedMesh>& mesh,
                                                  const std::vector<DetectedLandmark>& landmarks) {
  const DistanceFields fields(make_proxy(mesh, TrainParams{}.proxy_vertices, {}, true), {});
  std::vector<std::vector<float>> result;
  for (const auto& landmark : landmarks) {
    result.push_back(fields.from(landmark.source_point, {}));
    for (float& distance : result.back()) distance /= static_cast<float>(mesh->scale);
  }
  return result;
}

Vector vertex_areas(const TriangleMesh& mesh) {
  Vector area = Vector::Zero(mesh.vertex_count());
  for (int32_t t = 0; t < mesh.triangle_count(); ++t) {
    const auto corner = [&](int i) -> Vector3 { return mesh.positions.row(mesh.triangles(t, i)); };
    const double whole = (corner(1) - corner(0)).cross(corner(2) - corner(0)).norm() / 2;
    for (int i = 0; i < 3; ++i) area[mesh.triangles(t, i)] += whole / 3;
  }
  return area;
}

std::vector<SurfacePoint> true_points(const Shape& shape) {
  std::vector<SurfacePoint> points;
  for (const auto& mark : shape.marks) points.push_back(mark.value());
  return points;
}

// Per vertex of `to` the vertex of `from` that is the same point of the body, or -1.
std::vector<int32_t> dense_map(const Shape& from, const Shape& to) {
  std::vector<int32_t> map(to.mesh.vertex_count(), -1);
  for (size_t k = 0; k < to.dense.size(); ++k) map[to.dense[k]] = from.dense[k];
  return map;
}

double iou(const Vector& area, const std::vector<int32_t>& map, const float* truth, const float* guess,
           double radius) {
  double both = 0, either = 0;
  for (size_t v = 0; v < map.size(); ++v) {
    if (map[v] < 0) continue;
    const bool a = truth[map[v]] <= radius, b = guess[v] <= radius;
    both += a && b ? area[v] : 0, either += a || b ? area[v] : 0;
  }
  return either > 0 ? both / either : 0;
}

}  // namespace

std::vector<RegionResult> measure_regions(const Shapes& shapes,
                                          const std::vector<std::vector<DetectedLandmark>>& found) {
  if (shapes.training.front().dense.empty()) return {};
  std::vector<RowMatrixf> truths;
  for (const Shape& shape : shapes.training)
    truths.push_back(distances_from(prepare(shape.mesh), true_points(shape)));
  std::vector<RegionResult> results;
  for (const double radius : radii) results.push_back({radius, 0, 0, 0, 0});
  for (size_t s = 0; s < shapes.judged.size(); ++s) {
    const Shape& shape = shapes.judged[s];
    const auto mesh = std::make_shared<const PreparedMesh>(prepare(in_single_precision(shape.mesh)));
    const RowMatrixf ideal = distances_from(*mesh, true_points(shape));
    const auto fields = product_distances(mesh, found[s]);
    const Vector area = vertex_areas(shape.mesh);
    const auto L = static_cast<Eigen::Index>(shape.marks.size());
    for (size_t t = 0; t < truths.size(); ++t) {
      const auto map = dense_map(shapes.training[t], shape);
      for (auto& r : results)
        for (Eigen::Index l = 0; l < L; ++l) {
          const float* truth = &truths[t](l, 0);
          const double value = iou(area, map, truth, fields[l].data(), r.radius);
          r.found_iou += value, r.share_under += value < 0.7, ++r.regions;
          r.true_iou += iou(area, map, truth, &ideal(l, 0), r.radius);
        }
    }
  }
  for (auto& r : results) {
    const auto n = static_cast<double>(r.regions);
    r.found_iou /= n, r.true_iou /= n, r.share_under /= n;
  }
  return results;
}

void print_regions(const std::vector<RegionResult>& results) {
  std::printf("\n%-24s %9s %9s %12s %12s\n", "regions", "wanted", "mean IoU", "round truth", "under 0.7");
  for (const auto& r : results)
    std::printf("radius %-17.1f %9s %9.3f %12.3f %12.3f\n", r.radius, ">= 0.8", r.found_iou, r.true_iou,
                r.share_under);
}

nlohmann::json json_of(const std::vector<RegionResult>& results) {
  auto regions = nlohmann::json::array();
  for (const auto& r : results)
    regions.push_back({{"radius", r.radius},
                       {"mean_iou", r.found_iou},
                       {"mean_iou_round_truth", r.true_iou},
                       {"share_under_0.7", r.share_under},
                       {"regions", r.regions}});
  return regions;
}

}  // namespace focal_robustness
