#include "mesh/triangle_tree.h"

#include <algorithm>
#include <numeric>

namespace focal {
namespace {

constexpr int32_t leaf_size = 4;
constexpr int32_t long_work = 1 << 14;  // triangles; about a millisecond

}  // namespace

TriangleTree::TriangleTree(const TriangleMesh& mesh, const Execution& execution)
    : order_(mesh.triangle_count()) {
  std::iota(order_.begin(), order_.end(), 0);
  MatrixX3 centres(mesh.triangle_count(), 3);
  for (int32_t t = 0; t < mesh.triangle_count(); ++t)
    centres.row(t) = (mesh.positions.row(mesh.triangles(t, 0)) + mesh.positions.row(mesh.triangles(t, 1)) +
                      mesh.positions.row(mesh.triangles(t, 2))) /
                     3;
  if (!order_.empty()) build(0, mesh.triangle_count(), mesh, centres, execution);
}

int32_t TriangleTree::build(int32_t first, int32_t count, const TriangleMesh& mesh, const MatrixX3& centres,
                            const Execution& execution) {
  if (count > long_work) execution.check_cancelled();
  const auto index = static_cast<int32_t>(nodes_.size());
  nodes_.emplace_back();
  Eigen::AlignedBox3d box, middles;
  if (count <= leaf_size) {
    for (int32_t i = first; i < first + count; ++i)
      for (int c = 0; c < 3; ++c)
        box.extend(Vector3(mesh.positions.row(mesh.triangles(order_[i], c)).transpose()));
    nodes_[index] = {box, first, count};
    return index;
  }
  for (int32_t i = first; i < first + count; ++i) middles.extend(Vector3(centres.row(order_[i]).transpose()));
  Eigen::Index axis = 0;
  middles.sizes().maxCoeff(&axis);
  const int32_t half = count / 2;
  std::nth_element(order_.begin() + first, order_.begin() + first + half, order_.begin() + first + count,
                   [&](int32_t a, int32_t b) { return centres(a, axis) < centres(b, axis); });
  build(first, half, mesh, centres, execution);
  const int32_t second = build(first + half, count - half, mesh, centres, execution);
  nodes_[index].second = second;
  nodes_[index].box = nodes_[index + 1].box.merged(nodes_[second].box);
  return index;
}

}  // namespace focal
