// Numbers that describe the surroundings of a point: the interface of every descriptor, and the list of them.
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

// What a descriptor may look at.
struct DescribedSurface {
  const TriangleMesh& mesh;
  const Operators& operators;
  const Eigenbasis& basis;
};

inline constexpr int32_t max_components = 128;  // of a descriptor: as model files have room for

struct DescriptorKind {
  std::string_view name;  // a literal: on the command line and in model files
  int32_t dimension;      // at most max_components
  // vertices: rows of mesh.positions to describe. Returns vertices x dimension.
  RowMatrix (*describe)(const DescribedSurface& surface, std::span<const int32_t> vertices,
                        const Execution& execution);
  // Of those that are area x squared eigenfunctions x weights: eigenpairs x dimension, which a GPU applies too; else null.
  Matrix (*spectral_weights)(const Vector& lambda, double area) = nullptr;
};

// How those describe.
RowMatrix weighted_squares(const DescribedSurface& surface, const Matrix& weights,
                           std::span<const int32_t> vertices, const Execution& execution);
template <Matrix (*weights)(const Vector& lambda, double area)>
RowMatrix describe_spectrally(const DescribedSurface& surface, std::span<const int32_t> vertices,
                              const Execution& execution) {
  return weighted_squares(surface, weights(surface.basis.lambda, surface.operators.area), vertices,
                          execution);
}

// All descriptors there are, one line each: the n-th line defines number n in focal.h, so lines are only ever added at the
// end. A line `kind(NAME)` stands for a function `DescriptorKind NAME_descriptor()` in a file of its own.
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
