// Scale-invariant heat kernel signature: the descriptor of preset `paper` and preset `default`.
#pragma once
#include <cstdint>
#include <span>

#include "base/matrix.h"
#include "base/parallel.h"
#include "spectrum/eigenbasis.h"

namespace focal {

inline constexpr int32_t si_hks_dimension = 96;

// M. Bronstein, I. Kokkinos, "Scale-Invariant Heat Kernel Signatures for Non-Rigid Shape Recognition", 2010, with the
// times and frequencies of Xia et al. 2016, Section 5. Equal at equal points of isometric surfaces.
// area: of the surface; vertices: the rows of basis.Phi to describe. Returns vertices x 96, >= 0, no unit.
RowMatrix si_hks(const Eigenbasis& basis, double area, std::span<const int32_t> vertices,
                 const Execution& execution = Execution().inner());

// The same as three linear maps, with the logarithm's differences and the magnitudes between them, for
// implementations elsewhere; the input is the squared eigenfunctions times `scale`.
struct SiHksMaps {
  double scale;
  int32_t frequencies;
  RowMatrix decay;    // times x eigenpairs
  RowMatrix fourier;  // 2 frequencies x (times - 1), real parts first
  RowMatrix spline;   // si_hks_dimension x frequencies
};
SiHksMaps si_hks_maps(const Vector& lambda, double area);

}  // namespace focal
