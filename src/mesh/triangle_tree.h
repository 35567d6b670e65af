// A bounding-box hierarchy over the triangles of a mesh, split at the median, for many queries per mesh.
#pragma once
#include <limits>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "mesh/triangle_mesh.h"

namespace focal {

class TriangleTree {
 public:
  explicit TriangleTree(const TriangleMesh& mesh, const Execution& execution = Execution().inner());

  // Calls visit(triangle) for candidates, near ones first. least(box): lower bound, in any unit, for a
  // triangle in the box, infinite: none is possible; most(): the current upper bound.
  template <class Least, class Most, class Visit>
  void search(const Least& least, const Most& most, const Visit& visit) const;

 private:
  struct Node {
    Eigen::AlignedBox3d box;
    int32_t first = 0,
            // Of order_; count 0: an inner node, whose halves are the next node and `second`.
        count = 0;
    int32_t second = 0;
  };
  int32_t build(int32_t first, int32_t count, const TriangleMesh& mesh, const MatrixX3& centres,
                const Execution& execution);

  std::vector<int32_t> order_;
  std::vector<Node> nodes_;
};

template <class Least, class Most, class Visit>
void TriangleTree::search(const Least& least, const Most& most, const Visit& visit) const {
  if (nodes_.empty()) return;
  std::pair<double, int32_t> open[64] = {
      {least(nodes_[0].box), 0}};  // halving: far fewer levels for 2^31 triangles
  for (int depth = 1; depth > 0;) {
    const auto [distance, at] = open[--depth];
    if (distance > most() || distance == std::numeric_limits<double>::infinity()) continue;
    const Node& node = nodes_[at];
    for (int32_t i = node.first; i < node.first + node.count; ++i) visit(order_[i]);
    if (node.count > 0) continue;
    std::pair near{least(nodes_[at + 1].box), at + 1}, far{least(nodes_[node.second].box), node.second};
    if (far.first < near.first) std::swap(near, far);
    open[depth++] = far, open[depth++] = near;
  }
}

}  // namespace focal
