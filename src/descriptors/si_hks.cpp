#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "descriptors/descriptor.h"

namespace focal {
namespace {

constexpr int time_count = 241;  // tau = 1, 1.1, ... 25
constexpr int frequency_count = 20;
constexpr double reference_area = 2e4;  // the scale of the Shape-Google database, to which the times belong

// 20 samples at 0..19 -> values at `si_hks_dimension` even steps over [0, 19] by the cubic spline whose third derivative
// is continuous at the second and last but one knot ("not a knot"): a linear map, so a matrix.
Matrix spline_matrix() {
  constexpr int n = frequency_count;
  Matrix system = Matrix::Zero(n, n),
         right = Matrix::Zero(n, n);  // system * second derivatives = right * values
  for (int i = 1; i + 1 < n; ++i) {
    system(i, i - 1) = system(i, i + 1) = 1, system(i, i) = 4;
    right(i, i - 1) = right(i, i + 1) = 6, right(i, i) = -12;
  }
  system.row(0).head(3) << 1, -2, 1;
  system.row(n - 1).tail(3) << 1, -2, 1;
  const Matrix second = system.partialPivLu().solve(right);
  Matrix result = Matrix::Zero(si_hks_dimension, n);
  for (int k = 0; k < si_hks_dimension; ++k) {
    const double x = k * (n - 1.0) / (si_hks_dimension - 1);
    const int i = std::min(static_cast<int>(x), n - 2);
    const double b = x - i, a = 1 - b;
    result(k, i) += a, result(k, i + 1) += b;
    result.row(k) += ((a * a * a - a) * second.row(i) + (b * b * b - b) * second.row(i + 1)) / 6;
  }
  return result.transpose();
}

// Fourier transform of 240 differences, lowest 20 frequencies: real parts, then imaginary parts.
Matrix fourier_matrix() {
  constexpr int n = time_count - 1;
  Matrix result(n, 2 * frequency_count);
  for (int i = 0; i < n; ++i)
    for (int f = 0; f < frequency_count; ++f) {
      const double angle = 2 * std::numbers::pi * f * i / n;
      result(i, f) = std::cos(angle), result(i, frequency_count + f) = -std::sin(angle);
    }
  return result;
}

}  // namespace

RowMatrix si_hks(const Eigenbasis& basis, double area, std::span<const int32_t> vertices) {
  const double scale = area / reference_area;  // eigenvalues of the shape scaled to the reference area
  Matrix decay(basis.lambda.size(), time_count);
  for (int k = 0; k < time_count; ++k)
    decay.col(k) = (-basis.lambda.array() * scale * std::exp2(1 + 0.1 * k)).exp();
  Matrix squared(vertices.size(), basis.Phi.cols());
  for (size_t v = 0; v < vertices.size(); ++v)
    squared.row(v) = basis.Phi.row(vertices[v]).array().square() * scale;
  const Matrix log_hks = (squared * decay).array().max(1e-300).log();
  const Matrix derivative = log_hks.rightCols(time_count - 1) - log_hks.leftCols(time_count - 1);
  const Matrix spectrum = derivative * fourier_matrix();
  const Matrix magnitude = (spectrum.leftCols(frequency_count).array().square() +
                            spectrum.rightCols(frequency_count).array().square())
                               .sqrt();
  return magnitude * spline_matrix();
}

}  // namespace focal
