// Spin image: A. Johnson, M. Hebert, "Using Spin Images for Efficient Object Recognition in Cluttered 3D
// Scenes", 1999. A histogram of the nearby surface over the distance from the normal's line and the height
// along it. Points are weighted by the area around them, so that uneven triangles change little.
#include <algorithm>
#include <cmath>

#include "descriptors/local_support.h"

namespace focal {
namespace {

constexpr int32_t distances = 8, heights = 12;

// A position between the centres of two bins, and its weight for the upper one.
struct Place {
  int32_t lower;
  double share;
};

Place place_of(double value, double bin, int32_t bins) {
  const double at = std::clamp(value / bin - 0.5, 0.0, bins - 1.0);
  const int32_t lower = std::min(static_cast<int32_t>(at), bins - 2);
  return {lower, at - lower};
}

RowMatrix describe(const DescribedSurface& surface, std::span<const int32_t> vertices,
                   const Execution& execution) {
  const double radius = support_radius * std::sqrt(surface.operators.area);
  const MatrixX3 normals = area_normals(surface.mesh);
  RowMatrix result = RowMatrix::Zero(vertices.size(), distances * heights);
  parallel_for_ranges(execution, result.rows(), 32, [&](int64_t begin, int64_t end) {
    for (int64_t i = begin; i < end; ++i) {
      const Vector3 normal = normals.row(vertices[i]).transpose().stableNormalized();
      for (const auto& [offset, share] : local_support(surface, vertices[i], radius)) {
        const double height = offset.dot(normal);
        const double distance = std::sqrt(std::max(offset.squaredNorm() - height * height, 0.0));
        const Place d = place_of(distance, radius / distances, distances);
        const Place h = place_of(height + radius, 2 * radius / heights, heights);
        double* image = &result(i, d.lower * heights + h.lower);
        image[0] += share * (1 - d.share) * (1 - h.share), image[1] += share * (1 - d.share) * h.share;
        image[heights] += share * d.share * (1 - h.share), image[heights + 1] += share * d.share * h.share;
      }
    }
  });
  return result;
}

}  // namespace

DescriptorKind spin_image_descriptor() { return {"spin-image", distances * heights, describe}; }

}  // namespace focal
