// From the implicit body to a first closed triangle mesh.
// A. Doi, A. Koide, "An Efficient Method of Triangulating Equi-Valued Surfaces by Using Tetrahedral Cells", 1991,
// on the six-tetrahedra (Kuhn) subdivision of a cubic lattice.
#include "polygonise.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>

namespace creatures {
namespace {

struct Lattice {
  Eigen::Array3i count;
  Vec3 origin;
  Eigen::Matrix3d rotation;
  double cell;
  std::vector<float> values;

  int64_t index(int i, int j, int k) const { return (static_cast<int64_t>(k) * count[1] + j) * count[0] + i; }
  Vec3 point(const Vec3& ijk) const { return rotation * (origin + cell * ijk); }
  Vec3 point(int64_t at) const {
    const int64_t row = at / count[0];
    return point(Vec3(static_cast<double>(at % count[0]), static_cast<double>(row % count[1]),
                      static_cast<double>(row / count[1])));
  }
};

Lattice lattice_around(const Body& body, double cell, const Eigen::Quaterniond& rotation, const Vec3& shift) {
  Lattice lattice{{}, {}, rotation.toRotationMatrix(), cell, {}};
  const Eigen::AlignedBox3d box = body.bounds();
  Eigen::AlignedBox3d turned;
  for (int corner = 0; corner < 8; ++corner)
    turned.extend(lattice.rotation.transpose() *
                  box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner)));
  lattice.origin = turned.min() - cell * (Vec3::Ones() + shift);
  lattice.count = ((turned.max() - lattice.origin) / cell).array().ceil().cast<int>() + 2;
  return lattice;
}

// Blocks that the surface cannot reach get one value; the others one a lattice point.
void sample(Lattice& lattice, const Body& body) {
  constexpr int block = 4;
  const double reach = 1.5 * lattice.cell * 0.5 * block * std::sqrt(3.0);
  const Eigen::Array3i& n = lattice.count;
  lattice.values.resize(static_cast<size_t>(n[0]) * n[1] * n[2]);
  for (int k0 = 0; k0 < n[2]; k0 += block)
    for (int j0 = 0; j0 < n[1]; j0 += block)
      for (int i0 = 0; i0 < n[0]; i0 += block) {
        const double middle = body.distance(lattice.point(Vec3(i0, j0, k0) + Vec3::Constant(0.5 * block)));
        for (int k = k0; k < std::min(k0 + block, n[2]); ++k)
          for (int j = j0; j < std::min(j0 + block, n[1]); ++j)
            for (int i = i0; i < std::min(i0 + block, n[0]); ++i)
              lattice.values[lattice.index(i, j, k)] = static_cast<float>(
                  std::abs(middle) > reach ? middle : body.distance(lattice.point(Vec3(i, j, k))));
      }
}

class Marcher {
 public:
  explicit Marcher(const Lattice& lattice) : lattice_(lattice) {}

  void tetrahedron(const std::array<int64_t, 4>& corners, bool positive) {
    std::array<int64_t, 4> inside, outside;
    int in = 0, out = 0;
    // The parity of the reordering into inside, outside decides which way the triangle faces.
    bool even = positive;
    for (int i = 0; i < 4; ++i) {
      if (lattice_.values[corners[i]] < 0) {
        if (out % 2 == 1) even = !even;
        inside[in++] = corners[i];
      } else {
        outside[out++] = corners[i];
      }
    }
    if (in == 1) {
      add(cut(inside[0], outside[0]), cut(inside[0], outside[1]), cut(inside[0], outside[2]), even);
    } else if (in == 3) {
      add(cut(inside[0], outside[0]), cut(inside[1], outside[0]), cut(inside[2], outside[0]), even);
    } else if (in == 2) {
      const int a = cut(inside[0], outside[0]), b = cut(inside[0], outside[1]);
      const int c = cut(inside[1], outside[1]), d = cut(inside[1], outside[0]);
      add(a, b, c, even);
      add(a, c, d, even);
    }
  }

  Mesh mesh;

 private:
  int cut(int64_t inside, int64_t outside) {
    const uint64_t key = static_cast<uint64_t>(std::min(inside, outside)) * lattice_.values.size() +
                         static_cast<uint64_t>(std::max(inside, outside));
    const auto [at, fresh] = vertex_of_edge_.try_emplace(key, static_cast<int>(mesh.positions.size()));
    if (fresh) {
      const double a = lattice_.values[inside], b = lattice_.values[outside];
      const double t = std::clamp(a / (a - b), 0.1, 0.9);  // keeps vertices of neighbouring edges apart
      mesh.positions.push_back((1 - t) * lattice_.point(inside) + t * lattice_.point(outside));
    }
    return at->second;
  }
  void add(int a, int b, int c, bool even) {
    mesh.triangles.push_back(even ? Triangle{a, b, c} : Triangle{a, c, b});
  }

  const Lattice& lattice_;
  std::unordered_map<uint64_t, int> vertex_of_edge_;
};

}  // namespace

Mesh polygonise(const Body& body, double cell, const Eigen::Quaterniond& rotation, const Vec3& shift) {
  Lattice lattice = lattice_around(body, cell, rotation, shift);
  sample(lattice, body);
  constexpr std::array<std::array<int, 3>, 6> walks{
      {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
  Marcher marcher(lattice);
  const Eigen::Array3i& n = lattice.count;
  for (int k = 0; k + 1 < n[2]; ++k)
    for (int j = 0; j + 1 < n[1]; ++j)
      for (int i = 0; i + 1 < n[0]; ++i) {
        bool below = false, above = false;
        for (int corner = 0; corner < 8; ++corner) {
          const float v =
              lattice.values[lattice.index(i + (corner & 1), j + (corner >> 1 & 1), k + (corner >> 2))];
          (v < 0 ? below : above) = true;
        }
        if (!below || !above) continue;
        for (size_t w = 0; w < walks.size(); ++w) {
          // From the lowest to the highest corner of the cube, one axis at a time.
          std::array<int, 3> at{i, j, k};
          std::array<int64_t, 4> corners{lattice.index(i, j, k)};
          for (int step = 0; step < 3; ++step) {
            ++at[walks[w][step]];
            corners[step + 1] = lattice.index(at[0], at[1], at[2]);
          }
          marcher.tetrahedron(corners, w < 3);
        }
      }
  return std::move(marcher.mesh);
}

}  // namespace creatures
