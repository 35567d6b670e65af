// Descriptors of the neighbourhood of a point: the interface of every descriptor, and the list of them.
#pragma once
#include <cstdint>
#include <span>
#include <string_view>

#include "base/matrix.h"
#include "base/parallel.h"
#include "mesh/prepare.h"
#include "operators/operators.h"
#include "spectrum/eigenbasis.h"

namespace focal {

// The input of a descriptor.
struct DescribedSurface {
  const TriangleMesh& mesh;
  const Operators& operators;
  const Eigenbasis& basis;
};

inline constexpr int32_t max_components = 128;  // of a descriptor: the limit of model files

struct DescriptorKind {
  std::string_view name;  // a literal, used on the command line and in model files
  int32_t dimension;      // at most max_components
  // vertices: rows of mesh.positions to describe. Returns vertices x dimension.
  RowMatrix (*describe)(const DescribedSurface& surface, std::span<const int32_t> vertices,
                        const Execution& execution);
  // For descriptors that are area x squared eigenfunctions x weights: eigenpairs x dimension, which a GPU can
  // apply too; else null.
  Matrix (*spectral_weights)(const Vector& lambda, double area) = nullptr;
};

// Evaluates such a descriptor.
RowMatrix weighted_squares(const DescribedSurface& surface, const Matrix& weights,
                           std::span<const int32_t> vertices, const Execution& execution);
template <Matrix (*weights)(const Vector& lambda, double area)>
RowMatrix describe_spectrally(const DescribedSurface& surface, std::span<const int32_t> vertices,
                              const Execution& execution) {
  return weighted_squares(surface, weights(surface.basis.lambda, surface.operators.area), vertices,
                          execution);
}

// All descriptors, one per line: line n defines number n in focal.h, so lines may only be added at the end. A
// line `kind(NAME)` refers to a function `DescriptorKind NAME_descriptor()` in a file of its own.
// clang-format off
#define FOCAL_DESCRIPTORS(kind) \
  kind(si_hks)                  \
  kind(hks)                     \
  kind(wks)                     \
  kind(spin_image)              \
  kind(unique_shape_context)
// clang-format on

std::span<const DescriptorKind> descriptor_kinds();

// Of vertices of mesh.surface, with the basis that a fresh analysis of this surface has.
RowMatrix describe(const PreparedMesh& mesh, const DescriptorKind& kind, std::span<const int32_t> vertices,
                   const Execution& execution);

}  // namespace focal
