#include "descriptors/bulge.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace focal {
namespace {

constexpr int32_t max_points = 4000;  // that represent the surface

// Points of the surface in cubes as wide as the largest radius.
class Cubes {
 public:
  Cubes(const MatrixX3& positions, int32_t step) : low_(positions.colwise().minCoeff()) {
    const Vector3 extent = positions.colwise().maxCoeff() - low_.transpose();
    for (int a = 0; a < 3; ++a) count_[a] = static_cast<int32_t>(std::min(extent[a] / width, 200.0)) + 1;
    points_.resize(static_cast<size_t>(count_[0]) * count_[1] * count_[2]);
    for (int32_t v = 0; v < positions.rows(); v += step) points_[index(place(positions.row(v)))].push_back(v);
  }

  template <class Visit>
  void visit_near(const Vector3& p, const Visit& visit) const {
    const auto at = place(p);
    for (int32_t z = std::max(at[2] - 1, 0); z <= std::min(at[2] + 1, count_[2] - 1); ++z)
      for (int32_t y = std::max(at[1] - 1, 0); y <= std::min(at[1] + 1, count_[1] - 1); ++y)
        for (int32_t x = std::max(at[0] - 1, 0); x <= std::min(at[0] + 1, count_[0] - 1); ++x)
          for (const int32_t v : points_[index({x, y, z})]) visit(v);
  }

 private:
  static constexpr double width = bulge_radii.back();
  std::array<int32_t, 3> place(const Vector3& p) const {
    std::array<int32_t, 3> at;
    for (int a = 0; a < 3; ++a)
      at[a] = std::clamp(static_cast<int32_t>((p[a] - low_[a]) / width), 0, count_[a] - 1);
    return at;
  }
  size_t index(const std::array<int32_t, 3>& at) const {
    return at[0] + count_[0] * (at[1] + static_cast<size_t>(count_[1]) * at[2]);
  }

  Vector3 low_;
  std::array<int32_t, 3> count_{};
  std::vector<std::vector<int32_t>> points_;
};

}  // namespace

RowMatrixf bulge(const TriangleMesh& mesh, const MatrixX3& normals, const Vector& mass,
                 const Execution& execution) {
  const int32_t step = std::max(1, mesh.vertex_count() / max_points);
  const Cubes cubes(mesh.positions, step);
  RowMatrixf result(mesh.vertex_count(), static_cast<Eigen::Index>(bulge_radii.size()));
  parallel_for_ranges(execution, mesh.vertex_count(), 256, [&](int64_t begin, int64_t end) {
    for (int64_t v = begin; v < end; ++v) {
      const Vector3 p = mesh.positions.row(v), n = normals.row(v);
      std::array<double, bulge_radii.size()> sum{}, area{};
      cubes.visit_near(p, [&](int32_t x) {
        const Vector3 away = mesh.positions.row(x).transpose() - p;
        const double squared = away.squaredNorm();
        if (squared >= bulge_radii.back() * bulge_radii.back() || normals.row(x).dot(n) <= 0) return;
        const double height = mass[x] * n.dot(away);
        for (size_t r = 0; r < bulge_radii.size(); ++r)
          if (squared < bulge_radii[r] * bulge_radii[r]) sum[r] += height, area[r] += mass[x];
      });
      for (size_t r = 0; r < bulge_radii.size(); ++r)
        result(v, static_cast<Eigen::Index>(r)) =
            area[r] > 0 ? static_cast<float>(sum[r] / (area[r] * bulge_radii[r])) : 0;
    }
  });
  return result;
}

}  // namespace focal
