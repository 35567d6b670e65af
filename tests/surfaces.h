// Surfaces with known properties, as test input.
#pragma once
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <numbers>
#include <set>
#include <utility>
#include <vector>

#include "base/random.h"
#include "mesh/triangle_mesh.h"

namespace focal_test {

// Unit sphere: an octahedron subdivided `levels` times, 4^levels * 4 + 2 vertices.
inline focal::TriangleMesh sphere(int levels) {
  std::vector<focal::Vector3> points = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  std::vector<Eigen::Vector3i> faces = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                                        {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<int, int>, int> middle_of;
    const auto middle = [&](int a, int b) {
      const auto [at, is_new] = middle_of.try_emplace(std::minmax(a, b), static_cast<int>(points.size()));
      if (is_new) points.push_back((points[a] + points[b]).normalized());
      return at->second;
    };
    std::vector<Eigen::Vector3i> finer;
    for (const auto& f : faces) {
      const int a = middle(f[0], f[1]), b = middle(f[1], f[2]), c = middle(f[2], f[0]);
      finer.insert(finer.end(), {{f[0], a, c}, {a, f[1], b}, {c, b, f[2]}, {a, b, c}});
    }
    faces = std::move(finer);
  }
  focal::TriangleMesh mesh;
  mesh.positions.resize(static_cast<Eigen::Index>(points.size()), 3);
  mesh.triangles.resize(static_cast<Eigen::Index>(faces.size()), 3);
  for (size_t i = 0; i < points.size(); ++i) mesh.positions.row(i) = points[i];
  for (size_t i = 0; i < faces.size(); ++i) mesh.triangles.row(i) = faces[i];
  return mesh;
}

// The square [-1, 1]^2 in z = 0, (2 * half + 1)^2 vertices, inner ones moved by up to jitter spacings.
inline focal::TriangleMesh square(int half, double jitter = 0, uint64_t seed = 1) {
  const int side = 2 * half + 1;
  focal::Random random(seed);
  focal::TriangleMesh mesh;
  mesh.positions.resize(side * side, 3);
  mesh.triangles.resize(2 * (side - 1) * (side - 1), 3);
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const bool inner = x > 0 && y > 0 && x < side - 1 && y < side - 1;
      const double dx = inner ? jitter * (2 * random.uniform() - 1) : 0;
      const double dy = inner ? jitter * (2 * random.uniform() - 1) : 0;
      mesh.positions.row(y * side + x) << (x + dx) / half - 1, (y + dy) / half - 1, 0;
    }
  int t = 0;
  for (int y = 0; y + 1 < side; ++y)
    for (int x = 0; x + 1 < side; ++x) {
      const int a = y * side + x, b = a + 1, c = a + side, d = c + 1;
      if ((x + y) % 2) {  // alternating diagonals favour no direction
        mesh.triangles.row(t++) << a, b, c;
        mesh.triangles.row(t++) << b, d, c;
      } else {
        mesh.triangles.row(t++) << a, b, d;
        mesh.triangles.row(t++) << a, d, c;
      }
    }
  return mesh;
}

// A strip of columns x rows quads, twisted by half a turn and closed: one side, one border.
inline focal::TriangleMesh moebius_strip(int columns, int rows) {
  focal::TriangleMesh mesh;
  mesh.positions.resize(columns * (rows + 1), 3);
  mesh.triangles.resize(2 * columns * rows, 3);
  for (int i = 0; i < columns; ++i)
    for (int j = 0; j <= rows; ++j) {
      const double along = 2 * std::numbers::pi * i / columns,
                   width = 0.6 * (static_cast<double>(j) / rows - 0.5);
      const double r = 1 + width * std::cos(along / 2);
      mesh.positions.row(i * (rows + 1) + j) << r * std::cos(along), r * std::sin(along),
          width * std::sin(along / 2);
    }
  const auto at = [&](int i, int j) { return i < columns ? i * (rows + 1) + j : rows - j; };
  int t = 0;
  for (int i = 0; i < columns; ++i)
    for (int j = 0; j < rows; ++j) {
      mesh.triangles.row(t++) << at(i, j), at(i + 1, j), at(i + 1, j + 1);
      mesh.triangles.row(t++) << at(i, j), at(i + 1, j + 1), at(i, j + 1);
    }
  return mesh;
}

// Three sheets of (2 half + 1)^2 vertices that share a spine along z, at 120 degrees to each other.
inline focal::TriangleMesh book(int half) {
  const focal::TriangleMesh page = square(half);
  const int side = 2 * half + 1, n = page.vertex_count(), m = page.triangle_count(), outer = n - side;
  focal::TriangleMesh mesh;
  mesh.positions.resize(side + 3 * outer, 3);
  mesh.triangles.resize(3 * m, 3);
  for (int sheet = 0; sheet < 3; ++sheet) {
    const double turn = 2 * std::numbers::pi * sheet / 3;
    const auto number = [&](int v) {  // the first column is the spine
      const int x = v % side, y = v / side;
      return x == 0 ? y : side + sheet * outer + y * (side - 1) + x - 1;
    };
    for (int v = 0; v < n; ++v) {
      const double out = page.positions(v, 0) + 1;
      mesh.positions.row(number(v)) << out * std::cos(turn), out * std::sin(turn), page.positions(v, 1);
    }
    for (int t = 0; t < m; ++t)
      for (int i = 0; i < 3; ++i) mesh.triangles(sheet * m + t, i) = number(page.triangles(t, i));
  }
  return mesh;
}

// Every vertex moved along its own direction from the origin to radius(direction).
inline focal::TriangleMesh with_radius(focal::TriangleMesh mesh,
                                       const std::function<double(const focal::Vector3&)>& radius) {
  for (Eigen::Index v = 0; v < mesh.positions.rows(); ++v) {
    const focal::Vector3 direction = mesh.positions.row(v).normalized();
    mesh.positions.row(v) = radius(direction) * direction;
  }
  return mesh;
}

// Each directed edge once, and its opposite too: closed, oriented, manifold along edges.
inline bool is_closed(const focal::TriangleMesh& mesh) {
  std::set<std::pair<int32_t, int32_t>> directed;
  for (int32_t t = 0; t < mesh.triangle_count(); ++t)
    for (int i = 0; i < 3; ++i)
      if (!directed.emplace(mesh.triangles(t, i), mesh.triangles(t, (i + 1) % 3)).second) return false;
  for (const auto& [a, b] : directed)
    if (!directed.contains({b, a})) return false;
  return true;
}

inline void turn_over(focal::TriangleMesh& mesh, int32_t t) {
  std::swap(mesh.triangles(t, 1), mesh.triangles(t, 2));
}

inline Eigen::Matrix3d random_rotation(focal::Random& random) {
  Eigen::Quaterniond q(random.normal(), random.normal(), random.normal(), random.normal());
  return q.normalized().toRotationMatrix();
}

// A lump with bumps that differ in every direction.
inline double lump(const focal::Vector3& d) {
  const auto bump = [&](double height, double x, double y, double z) {
    return height * std::exp(-(d - focal::Vector3(x, y, z).normalized()).squaredNorm() / 0.15);
  };
  return 1 + bump(0.8, 0.3, 1, 0.2) + bump(0.5, -1, 0.2, 0.4) + bump(0.6, 0.2, -0.6, 1) +
         bump(0.3, 1, -1, -1);
}

// The same, mirror symmetric in x: eared, nosed and with one tail; no other symmetry.
inline double mirror_lump(const focal::Vector3& direction) {
  const focal::Vector3 d(std::abs(direction.x()), direction.y(), direction.z());
  const auto bump = [&](double height, double x, double y, double z) {
    return height * std::exp(-(d - focal::Vector3(x, y, z).normalized()).squaredNorm() / 0.15);
  };
  return 1 + bump(0.8, 0.8, 0.7, 0.2) + bump(0.5, 0, -0.3, 1) + bump(0.6, 0.5, -1, -0.4) +
         bump(0.9, 0, 0.3, -1);
}

}  // namespace focal_test
