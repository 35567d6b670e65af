#include "mesh/components.h"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "mesh/nearest_vertex.h"

namespace focal {
namespace {

int32_t find_root(std::vector<int32_t>& parent, int32_t v) {
  while (parent[v] != v) v = parent[v] = parent[parent[v]];
  return v;
}

// Links one part to the joined ones by the nearest pair, then by pairs beside it: three links constrain a
// part, where heat would pass through a single point with only one.
void link_part(const TriangleMesh& mesh, const std::vector<int32_t>& part, const NearestVertex& joined,
               std::vector<std::pair<int32_t, int32_t>>& bridges) {
  std::vector<std::tuple<double, int32_t, int32_t>> pairs;
  for (const int32_t v : part) {
    const auto [other, squared] = joined.nearest(mesh.positions.row(v));
    pairs.emplace_back(squared, v, other);
  }
  std::sort(pairs.begin(), pairs.end());
  for (size_t i = 0; i < std::min<size_t>(3, pairs.size()); ++i)
    bridges.emplace_back(std::get<1>(pairs[i]), std::get<2>(pairs[i]));
}

}  // namespace

Components components_of(const TriangleMesh& mesh) {
  std::vector<int32_t> parent(mesh.vertex_count());
  std::iota(parent.begin(), parent.end(), 0);
  for (int32_t t = 0; t < mesh.triangle_count(); ++t)
    for (int i = 1; i < 3; ++i) {
      const int32_t a = find_root(parent, mesh.triangles(t, 0)), b = find_root(parent, mesh.triangles(t, i));
      parent[std::max(a, b)] = std::min(a, b);
    }
  Components result;
  result.of_vertex.resize(parent.size());
  for (size_t v = 0; v < parent.size(); ++v) {
    const int32_t root = find_root(parent, static_cast<int32_t>(v));
    result.of_vertex[v] = root == static_cast<int32_t>(v) ? result.count++ : result.of_vertex[root];
  }
  return result;
}

std::vector<std::pair<int32_t, int32_t>> bridge_pairs(const TriangleMesh& mesh,
                                                      const Components& components) {
  std::vector<std::pair<int32_t, int32_t>> bridges;
  if (components.count < 2) return bridges;
  std::vector<std::vector<int32_t>> parts(components.count);
  for (int32_t v = 0; v < mesh.vertex_count(); ++v) parts[components.of_vertex[v]].push_back(v);
  std::stable_sort(parts.begin(), parts.end(),
                   [](const auto& a, const auto& b) { return a.size() > b.size(); });
  // Each part, from large to small, is linked to the larger ones. With many parts the search tree is rebuilt
  // only when the joined set has grown by half: being nearest to the large parts is sufficient.
  std::vector<int32_t> joined = parts[0];
  NearestVertex tree(mesh.positions, joined);
  size_t indexed = joined.size();
  for (size_t p = 1; p < parts.size(); ++p) {
    if (joined.size() > indexed + indexed / 2 || parts.size() < 100) {
      tree = NearestVertex(mesh.positions, joined);
      indexed = joined.size();
    }
    link_part(mesh, parts[p], tree, bridges);
    joined.insert(joined.end(), parts[p].begin(), parts[p].end());
  }
  return bridges;
}

}  // namespace focal
