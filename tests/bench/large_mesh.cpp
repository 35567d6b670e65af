#include "large_mesh.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <tuple>
#include <unordered_set>
#include <vector>

#include "base/random.h"

namespace focal_bench {
namespace {

using namespace focal;

constexpr double relief = 0.03;    // height of a new vertex over its edge, of the edge's length
constexpr double wander = 0.15;    // along the surface, of the mean edge
constexpr double flip_rate = 0.2;  // of the edges

struct Edge {
  int32_t a, b;                    // a < b
  int32_t triangle[2] = {-1, -1};  // on either side
  int32_t corner[2] = {-1, -1};    // of these triangles: the one opposite the edge
  int32_t uses = 0;
};

struct Edges {
  std::vector<Edge> list;                      // sorted by (a, b)
  std::vector<std::array<int32_t, 3>> facing;  // per triangle and corner: the edge opposite
};

Edges edges_with_sides(const TriangleMesh& mesh) {
  struct Use {
    int32_t a, b, triangle, corner;
    auto key() const { return std::tuple(a, b, triangle); }
  };
  std::vector<Use> uses;
  uses.reserve(3 * static_cast<size_t>(mesh.triangle_count()));
  for (int32_t t = 0; t < mesh.triangle_count(); ++t)
    for (int i = 0; i < 3; ++i) {
      const auto [a, b] = std::minmax({mesh.triangles(t, (i + 1) % 3), mesh.triangles(t, (i + 2) % 3)});
      uses.push_back({a, b, t, i});
    }
  std::sort(uses.begin(), uses.end(), [](const Use& x, const Use& y) { return x.key() < y.key(); });
  Edges edges;
  edges.facing.resize(mesh.triangle_count());
  for (const Use& use : uses) {
    if (edges.list.empty() || edges.list.back().a != use.a || edges.list.back().b != use.b)
      edges.list.push_back({.a = use.a, .b = use.b});
    Edge& edge = edges.list.back();
    if (edge.uses < 2) edge.triangle[edge.uses] = use.triangle, edge.corner[edge.uses] = use.corner;
    ++edge.uses;
    edges.facing[use.triangle][use.corner] = static_cast<int32_t>(edges.list.size()) - 1;
  }
  return edges;
}

Vector3 raw_normal(const MatrixX3& positions, int32_t a, int32_t b, int32_t c) {
  const Vector3 p = positions.row(a), q = positions.row(b), r = positions.row(c);
  return (q - p).cross(r - p);
}

MatrixX3 vertex_normals(const TriangleMesh& mesh) {
  MatrixX3 normals = MatrixX3::Zero(mesh.vertex_count(), 3);
  for (int32_t t = 0; t < mesh.triangle_count(); ++t) {
    const auto corner = mesh.triangles.row(t);
    const Vector3 normal = raw_normal(mesh.positions, corner[0], corner[1], corner[2]);
    for (int i = 0; i < 3; ++i) normals.row(corner[i]) += normal.transpose();
  }
  return normals.rowwise().normalized();
}

// The edges to split, -1 or the number of their new vertex; long ones first, not quite in order.
std::vector<int32_t> chosen_edges(const TriangleMesh& mesh, const Edges& edges, int32_t wanted,
                                  Random& random) {
  std::vector<double> length(edges.list.size());
  for (size_t e = 0; e < length.size(); ++e)
    length[e] = (mesh.positions.row(edges.list[e].a) - mesh.positions.row(edges.list[e].b)).norm() *
                (0.7 + 0.6 * random.uniform());
  std::vector<int32_t> order(length.size());
  std::iota(order.begin(), order.end(), 0);
  const auto count = std::min<size_t>(wanted, order.size());
  std::nth_element(order.begin(), order.begin() + static_cast<int64_t>(count) - 1, order.end(),
                   [&](int32_t x, int32_t y) { return std::pair(length[x], x) > std::pair(length[y], y); });
  std::vector<int32_t> middle(length.size(), -1);
  for (size_t i = 0; i < count; ++i) middle[order[i]] = mesh.vertex_count() + static_cast<int32_t>(i);
  return middle;
}

// One triangle whose edges opposite corner i hold the vertex m[i], or -1.
void cut(const std::array<int32_t, 3>& c, const std::array<int32_t, 3>& m, bool choice,
         std::vector<std::array<int32_t, 3>>& out) {
  const auto count = std::count_if(m.begin(), m.end(), [](int32_t v) { return v >= 0; });
  if (count == 0) out.push_back(c);
  if (count == 3) {
    for (int i = 0; i < 3; ++i) out.push_back({c[i], m[(i + 2) % 3], m[(i + 1) % 3]});
    out.push_back({m[0], m[1], m[2]});
  }
  for (int i = 0; i < 3 && count > 0 && count < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    if (count == 1 && m[i] >= 0) {
      out.push_back({c[i], c[j], m[i]});
      out.push_back({c[i], m[i], c[k]});
    }
    if (count == 2 && m[i] < 0) {
      out.push_back({c[i], m[k], m[j]});
      out.push_back({m[k], c[j], choice ? c[k] : m[j]});
      out.push_back(choice ? std::array{m[k], c[k], m[j]} : std::array{c[j], c[k], m[j]});
    }
  }
}

TriangleMesh split_edges(const TriangleMesh& mesh, int32_t wanted, Random& random) {
  const Edges edges = edges_with_sides(mesh);
  const std::vector<int32_t> middle = chosen_edges(mesh, edges, wanted, random);
  const MatrixX3 normals = vertex_normals(mesh);
  const auto added = std::count_if(middle.begin(), middle.end(), [](int32_t v) { return v >= 0; });
  TriangleMesh result;
  result.positions.resize(mesh.vertex_count() + added, 3);
  result.positions.topRows(mesh.vertex_count()) = mesh.positions;
  for (size_t e = 0; e < middle.size(); ++e) {
    if (middle[e] < 0) continue;
    const auto p = mesh.positions.row(edges.list[e].a), q = mesh.positions.row(edges.list[e].b);
    const double t = 0.4 + 0.2 * random.uniform(), height = relief * random.normal() * (p - q).norm();
    result.positions.row(middle[e]) =
        (1 - t) * p + t * q + height / 2 * (normals.row(edges.list[e].a) + normals.row(edges.list[e].b));
  }
  std::vector<std::array<int32_t, 3>> triangles;
  for (int32_t t = 0; t < mesh.triangle_count(); ++t) {
    std::array<int32_t, 3> c, m;
    for (int i = 0; i < 3; ++i) c[i] = mesh.triangles(t, i), m[i] = middle[edges.facing[t][i]];
    cut(c, m, random.below(2) == 0, triangles);
  }
  result.triangles = Eigen::Map<const MatrixX3i>(triangles.data()->data(), triangles.size(), 3);
  return result;
}

void move_along_surface(TriangleMesh& mesh, Random& random) {
  const MatrixX3 normals = vertex_normals(mesh);
  std::vector<double> shortest(mesh.vertex_count(), 1e300);  // so that no triangle turns over
  for (int32_t t = 0; t < mesh.triangle_count(); ++t)
    for (int i = 0; i < 3; ++i) {
      const int32_t a = mesh.triangles(t, i), b = mesh.triangles(t, (i + 1) % 3);
      const double length = (mesh.positions.row(a) - mesh.positions.row(b)).norm();
      shortest[a] = std::min(shortest[a], length), shortest[b] = std::min(shortest[b], length);
    }
  for (int32_t v = 0; v < mesh.vertex_count(); ++v) {
    const Vector3 normal = normals.row(v);
    Vector3 step(random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5);
    step -= step.dot(normal) * normal;
    mesh.positions.row(v) += (2 * wander * shortest[v] * step).transpose();
  }
}

bool flip_is_sound(const TriangleMesh& mesh, const Edge& edge, int32_t c, int32_t d, bool forward) {
  const int32_t a = forward ? edge.a : edge.b, b = forward ? edge.b : edge.a;
  const Vector3 before = raw_normal(mesh.positions, a, b, c) + raw_normal(mesh.positions, b, a, d);
  const Vector3 first = raw_normal(mesh.positions, a, d, c), second = raw_normal(mesh.positions, d, b, c);
  const double least = 0.1 * before.squaredNorm();
  return first.dot(before) > least && second.dot(before) > least;
}

void flip_edges(TriangleMesh& mesh, Random& random) {
  const Edges edges = edges_with_sides(mesh);
  const auto key = [](int32_t a, int32_t b) {
    return static_cast<uint64_t>(std::min(a, b)) << 32 | static_cast<uint64_t>(std::max(a, b));
  };
  std::unordered_set<uint64_t> present;
  for (const Edge& edge : edges.list) present.insert(key(edge.a, edge.b));
  std::vector<char> touched(mesh.triangle_count(), 0);
  for (const Edge& edge : edges.list) {
    if (random.uniform() > flip_rate || edge.uses != 2) continue;
    if (touched[edge.triangle[0]] || touched[edge.triangle[1]]) continue;
    const int32_t c = mesh.triangles(edge.triangle[0], edge.corner[0]);
    const int32_t d = mesh.triangles(edge.triangle[1], edge.corner[1]);
    // In the first triangle the edge runs from a to b, or the other way round.
    const bool forward = mesh.triangles(edge.triangle[0], (edge.corner[0] + 1) % 3) == edge.a;
    if (c == d || present.contains(key(c, d)) || !flip_is_sound(mesh, edge, c, d, forward)) continue;
    const int32_t a = forward ? edge.a : edge.b, b = forward ? edge.b : edge.a;
    mesh.triangles.row(edge.triangle[0]) << a, d, c;
    mesh.triangles.row(edge.triangle[1]) << d, b, c;
    touched[edge.triangle[0]] = touched[edge.triangle[1]] = 1;
    present.insert(key(c, d));
    present.erase(key(edge.a, edge.b));
  }
}

TriangleMesh decimated(const TriangleMesh& mesh, int32_t vertex_count) {
  const Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor> positions = mesh.positions.cast<float>();
  const Eigen::Matrix<uint32_t, Eigen::Dynamic, 3, Eigen::RowMajor> indices = mesh.triangles.cast<uint32_t>();
  const size_t wanted = 6 * static_cast<size_t>(vertex_count);  // a closed surface has two triangles a vertex
  std::vector<uint32_t> kept(indices.size());
  kept.resize(meshopt_simplify(kept.data(), indices.data(), kept.size(), positions.data(), positions.rows(),
                               3 * sizeof(float), wanted, 1.0f));
  std::vector<int32_t> number(mesh.vertex_count(), -1);
  TriangleMesh result;
  result.positions.resize(mesh.vertex_count(), 3);
  result.triangles.resize(static_cast<Eigen::Index>(kept.size()) / 3, 3);
  int32_t used = 0;
  for (size_t i = 0; i < kept.size(); ++i) {
    if (number[kept[i]] < 0) {
      result.positions.row(used) = mesh.positions.row(kept[i]);
      number[kept[i]] = used++;
    }
    result.triangles.data()[i] = number[kept[i]];
  }
  result.positions.conservativeResize(used, 3);
  return result;
}

}  // namespace

int64_t open_edges(const TriangleMesh& mesh) {
  const auto edges = edges_with_sides(mesh).list;
  return std::count_if(edges.begin(), edges.end(), [](const Edge& edge) { return edge.uses != 2; });
}

TriangleMesh resized(const TriangleMesh& mesh, int32_t vertex_count, uint64_t seed) {
  if (vertex_count == mesh.vertex_count()) return mesh;
  if (vertex_count < mesh.vertex_count()) return decimated(mesh, vertex_count);
  Random random(seed);
  TriangleMesh result = mesh;
  while (result.vertex_count() < vertex_count)
    result = split_edges(result, vertex_count - result.vertex_count(), random);
  move_along_surface(result, random);
  flip_edges(result, random);
  return result;
}

}  // namespace focal_bench
