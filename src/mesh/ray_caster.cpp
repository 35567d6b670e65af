#include "mesh/ray_caster.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace focal {
namespace {

constexpr int32_t leaf_size = 4;

double distance_to(const TriangleMesh& mesh, int32_t t, const Vector3& origin, const Vector3& direction) {
  const Vector3 a = mesh.positions.row(mesh.triangles(t, 0));
  const Vector3 ab = mesh.positions.row(mesh.triangles(t, 1)).transpose() - a,
                ac = mesh.positions.row(mesh.triangles(t, 2)).transpose() - a;
  const Vector3 across = direction.cross(ac);
  const double determinant = ab.dot(across);
  if (determinant == 0) return -1;
  const Vector3 from_a = origin - a;
  const double u = from_a.dot(across) / determinant;
  const Vector3 other = from_a.cross(ab);
  const double v = direction.dot(other) / determinant;
  if (!(u >= 0 && v >= 0 && u + v <= 1)) return -1;
  return ac.dot(other) / determinant;
}

bool meets(const Eigen::AlignedBox3d& box, const Vector3& origin, const Vector3& direction, double farthest) {
  double low = 0, high = farthest;
  for (int i = 0; i < 3; ++i) {
    if (direction[i] == 0) {
      if (origin[i] < box.min()[i] || origin[i] > box.max()[i]) return false;
      continue;
    }
    const double a = (box.min()[i] - origin[i]) / direction[i], b = (box.max()[i] - origin[i]) / direction[i];
    low = std::max(low, std::min(a, b)), high = std::min(high, std::max(a, b));
  }
  return low <= high;
}

}  // namespace

RayCaster::RayCaster(TriangleMesh mesh) : mesh_(std::move(mesh)), order_(mesh_.triangle_count()) {
  std::iota(order_.begin(), order_.end(), 0);
  MatrixX3 centres(mesh_.triangle_count(), 3);
  for (int32_t t = 0; t < mesh_.triangle_count(); ++t)
    centres.row(t) =
        (mesh_.positions.row(mesh_.triangles(t, 0)) + mesh_.positions.row(mesh_.triangles(t, 1)) +
         mesh_.positions.row(mesh_.triangles(t, 2))) /
        3;
  if (!order_.empty()) build(0, mesh_.triangle_count(), centres);
}

int32_t RayCaster::build(int32_t first, int32_t count, const MatrixX3& centres) {
  const auto index = static_cast<int32_t>(nodes_.size());
  nodes_.emplace_back();
  Eigen::AlignedBox3d box, middles;
  for (int32_t i = first; i < first + count; ++i) {
    for (int c = 0; c < 3; ++c)
      box.extend(Vector3(mesh_.positions.row(mesh_.triangles(order_[i], c)).transpose()));
    middles.extend(Vector3(centres.row(order_[i]).transpose()));
  }
  nodes_[index].box = box;
  if (count <= leaf_size) {
    nodes_[index].first = first, nodes_[index].count = count;
    return index;
  }
  Eigen::Index axis = 0;
  middles.sizes().maxCoeff(&axis);
  const int32_t half = count / 2;
  std::nth_element(order_.begin() + first, order_.begin() + first + half, order_.begin() + first + count,
                   [&](int32_t a, int32_t b) { return centres(a, axis) < centres(b, axis); });
  build(first, half, centres);
  const int32_t second = build(first + half, count - half, centres);
  nodes_[index].second = second;
  return index;
}

RayCaster::Hit RayCaster::first_hit(const Vector3& origin, const Vector3& direction, double farthest) const {
  Hit hit{farthest, -1};
  if (nodes_.empty()) return hit;
  int32_t open[64] = {0};  // halving: far fewer levels than that for 2^31 triangles
  for (int depth = 1; depth > 0;) {
    const int32_t at = open[--depth];
    const Node& node = nodes_[at];
    if (!meets(node.box, origin, direction, hit.distance)) continue;
    if (node.count == 0) {
      open[depth++] = node.second, open[depth++] = at + 1;
      continue;
    }
    for (int32_t i = node.first; i < node.first + node.count; ++i) {
      const double distance = distance_to(mesh_, order_[i], origin, direction);
      if (distance > 0 && distance < hit.distance) hit = {distance, order_[i]};
    }
  }
  return hit;
}

}  // namespace focal
