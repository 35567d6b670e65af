// Unique shape context: F. Tombari, S. Salti, L. Di Stefano, "Unique Shape Context for 3D Data Description",
// 2010. A histogram of the nearby surface over a ball divided by distance, height and azimuth in a local
// frame of the point (their "Unique Signatures of Histograms for Local Surface Description", 2010). Points
// are weighted by the area around them.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "descriptors/local_support.h"

namespace focal {
namespace {

constexpr int32_t shells = 3, elevations = 4, azimuths = 8;
constexpr double innermost = 0.125;  // of the radius: nearer points are in no bin

// Columns x, y, z: the directions of largest and smallest spread, towards the larger part of the surface.
Matrix3 frame_of(const std::vector<Neighbour>& neighbours, double radius) {
  Matrix3 spread = Matrix3::Zero();
  for (const auto& [offset, share] : neighbours)
    spread += share * (radius - offset.norm()) * offset * offset.transpose();
  const Matrix3 axes = Eigen::SelfAdjointEigenSolver<Matrix3>(spread).eigenvectors();
  const auto pointed = [&](Vector3 axis) -> Vector3 {
    double side = 0;
    for (const auto& [offset, share] : neighbours) {
      const double along = offset.dot(axis);
      side += along > 0 ? share : along < 0 ? -share : 0;
    }
    return side < 0 ? -axis : axis;
  };
  Matrix3 frame;
  frame.col(0) = pointed(axes.col(2)), frame.col(2) = pointed(axes.col(0));
  frame.col(1) = frame.col(2).cross(frame.col(0));
  return frame;
}

int32_t step_of(double share, int32_t steps) {
  return std::clamp(static_cast<int32_t>(std::floor(share * steps)), 0, steps - 1);
}

RowMatrix describe_shape_context(const DescribedSurface& surface, std::span<const int32_t> vertices,
                                 const Execution& execution) {
  const double radius = support_radius * std::sqrt(surface.operators.area);
  RowMatrix result = RowMatrix::Zero(vertices.size(), shells * elevations * azimuths);
  parallel_for_ranges(execution, result.rows(), 32, [&](int64_t begin, int64_t end) {
    for (int64_t i = begin; i < end; ++i) {
      const auto neighbours = local_support(surface, vertices[i], radius);
      const Matrix3 frame = frame_of(neighbours, radius);
      for (const auto& [offset, share] : neighbours) {
        const double distance = offset.norm();
        if (distance < innermost * radius) continue;
        const Vector3 local = frame.transpose() * offset;
        const double elevation = std::acos(std::clamp(local.z() / distance, -1.0, 1.0)) / std::numbers::pi;
        const double azimuth = std::atan2(local.y(), local.x()) / (2 * std::numbers::pi);
        const double shell = std::log(distance / (innermost * radius)) / -std::log(innermost);
        const int32_t bin =
            (step_of(shell, shells) * elevations + step_of(elevation, elevations)) * azimuths +
            step_of(azimuth < 0 ? azimuth + 1 : azimuth, azimuths);
        result(i, bin) += share;
      }
    }
  });
  return result;
}

}  // namespace

DescriptorKind unique_shape_context_descriptor() {
  return {"unique-shape-context", shells * elevations * azimuths, describe_shape_context};
}

}  // namespace focal
