#include "mesh/edges.h"

#include <algorithm>
#include <numeric>

namespace focal {

EdgeSides edge_sides(const TriangleMesh& mesh) {
  struct Side {
    int32_t high, side;
    bool operator<(const Side& other) const {
      return high != other.high ? high < other.high : side < other.side;
    }
  };
  const auto ends = [&](int32_t s) {
    return std::minmax(mesh.triangles(s / 3, (s + 1) % 3), mesh.triangles(s / 3, (s + 2) % 3));
  };
  const int32_t count = 3 * mesh.triangle_count();
  std::vector<int32_t> first(mesh.vertex_count() + 1, 0);  // by the smaller end
  for (int32_t s = 0; s < count; ++s) ++first[ends(s).first + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<int32_t> next(first.begin(), first.end() - 1);
  std::vector<Side> sides(count);
  for (int32_t s = 0; s < count; ++s) sides[next[ends(s).first]++] = {ends(s).second, s};
  EdgeSides result;
  result.side.resize(count);
  result.start.reserve(count / 2 + 2);
  for (int32_t v = 0; v < mesh.vertex_count(); ++v) {
    std::sort(sides.begin() + first[v], sides.begin() + first[v + 1]);
    for (int32_t p = first[v]; p < first[v + 1]; ++p) {
      result.side[p] = sides[p].side;
      if (p + 1 == first[v + 1] || sides[p + 1].high != sides[p].high) result.start.push_back(p + 1);
    }
  }
  return result;
}

}  // namespace focal
