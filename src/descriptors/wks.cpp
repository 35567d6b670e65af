// Wave kernel signature: M. Aubry, U. Schlickewei, D. Cremers, "The Wave Kernel Signature: A Quantum
// Mechanical Approach to Shape Analysis", 2011. Component k is the probability of finding a particle of
// energy about exp(e_k) at a point, times the area.
#include <algorithm>
#include <cmath>

#include "descriptors/descriptor.h"

namespace focal {
namespace {

constexpr int32_t dimension = 96;
constexpr double steps_a_deviation = 7;  // of the energies, as in the authors' program

// eigenpairs x energies: the weight of each eigenfunction; every column sums to 1.
Matrix weights(const Vector& lambda, double area) {
  const Vector e = (lambda.array() * area).max(1e-6).log();
  const auto positive = std::find_if(lambda.begin(), lambda.end(), [&](double l) { return l * area > 1e-3; });
  const auto first = std::min<Eigen::Index>(positive - lambda.begin(), lambda.size() - 1);
  const double low = e[first], high = std::max(e[lambda.size() - 1] / 1.02, low + 1e-3);
  const double step = (high - low) / (dimension - 1), deviation = steps_a_deviation * step;
  Matrix result = Matrix::Zero(lambda.size(), dimension);
  for (int32_t k = 0; k < dimension; ++k) {
    const auto apart = e.tail(lambda.size() - first).array() - (low + k * step);
    result.col(k).tail(lambda.size() - first) = (-apart.square() / (2 * deviation * deviation)).exp();
    result.col(k) /= result.col(k).sum();
  }
  return result;
}

}  // namespace

DescriptorKind wks_descriptor() { return {"wks", dimension, describe_spectrally<weights>, weights}; }

}  // namespace focal
