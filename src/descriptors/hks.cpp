// Heat kernel signature: J. Sun, M. Ovsjanikov, L. Guibas, "A Concise and Provably Informative Multi-Scale
// Signature Based on Heat Diffusion", 2009. Component k is the heat that remains at a point at time t_k,
// times the area.
#include <cmath>

#include "descriptors/descriptor.h"

namespace focal {
namespace {

constexpr int32_t dimension = 96;
// The times of SI-HKS (Xia et al. 2016, Section 5): 2^1 to 2^25 on a surface of this area, evenly spaced
// exponents.
constexpr double first_exponent = 1, last_exponent = 25, shape_google_area = 2e4;

Matrix weights(const Vector& lambda, double area) {
  Matrix decay(lambda.size(), dimension);
  for (int32_t k = 0; k < dimension; ++k) {
    const double t = std::exp2(first_exponent + k * (last_exponent - first_exponent) / (dimension - 1));
    decay.col(k) = (-lambda.array() * area / shape_google_area * t).exp();
  }
  return decay;
}

}  // namespace

DescriptorKind hks_descriptor() { return {"hks", dimension, describe_spectrally<weights>, weights}; }

}  // namespace focal
