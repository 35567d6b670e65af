#include "descriptors/descriptor.h"

#include <array>

namespace focal {

RowMatrix weighted_squares(const DescribedSurface& surface, const Matrix& weights,
                           std::span<const int32_t> vertices, const Execution& execution) {
  RowMatrix result(vertices.size(), weights.cols());
  parallel_for_ranges(execution, result.rows(), 32, [&](int64_t begin, int64_t end) {
    for (int64_t i = begin; i < end; ++i)
      result.row(i) = surface.operators.area * surface.basis.Phi.row(vertices[i]).cwiseAbs2() * weights;
  });
  return result;
}

#define FOCAL_DECLARE(name) DescriptorKind name##_descriptor();
#define FOCAL_MAKE(name) name##_descriptor(),
FOCAL_DESCRIPTORS(FOCAL_DECLARE)

std::span<const DescriptorKind> descriptor_kinds() {
  static const std::array all = {FOCAL_DESCRIPTORS(FOCAL_MAKE)};
  return all;
}

RowMatrix describe(const PreparedMesh& mesh, const DescriptorKind& kind, std::span<const int32_t> vertices,
                   const Execution& execution) {
  execution.begin_stage("spectrum", 0, 0.9);
  const Operators operators = make_operators(mesh.surface, bridges_of(mesh));
  const Eigenbasis basis = eigenbasis(operators.L, operators.mass, EigenParams{}, execution);
  execution.begin_stage("descriptors", 0.9, 1);
  return kind.describe({mesh.surface, operators, basis}, vertices, execution);
}

}  // namespace focal
