#include "descriptors/si_hks.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/aligned_array.h"
#include "descriptors/descriptor.h"
#include "linear/block_kernels.h"

namespace focal {
namespace {

constexpr int lanes = 32;
constexpr int time_count = 241;  // tau = 1, 1.1, ... 25
constexpr int frequency_count = 20;
// The scale of the Shape-Google database, for which the times are defined.
constexpr double reference_area = 2e4;

// Maps 20 samples at 0..19 to values at `si_hks_dimension` even steps over [0, 19] by the cubic spline whose
// third derivative is continuous at the second and the last but one knot ("not a knot"): a linear map, so a
// matrix.
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
  return result;
}

// Fourier transform of 240 differences, lowest 20 frequencies: real parts, then imaginary parts.
Matrix fourier_matrix() {
  constexpr int n = time_count - 1;
  Matrix result(2 * frequency_count, n);
  for (int i = 0; i < n; ++i)
    for (int f = 0; f < frequency_count; ++f) {
      const double angle = 2 * std::numbers::pi * f * i / n;
      result(f, i) = std::cos(angle), result(frequency_count + f, i) = -std::sin(angle);
    }
  return result;
}

// Sums of products for 32 interleaved samples at a time: C = A B.
class Product {
 public:
  explicit Product(const Matrix& A) : rows_((A.rows() + 3) / 4 * 4), inner_(A.cols()), A_(rows_ * inner_) {
    Eigen::Map<Matrix> padded(A_.data(), rows_, inner_);
    padded.setZero();
    padded.topRows(A.rows()) = A;
  }
  void apply(const double* B, double* C) const {
    std::fill_n(C, rows_ * lanes, 0.0);
    multiply_add(StridedView<double>{A_.data(), 1, rows_}, rows_, inner_, B, C);
  }
  int64_t size() const { return rows_ * lanes; }

 private:
  int64_t rows_, inner_;
  AlignedArray<double> A_;  // column-major
};

struct Steps {
  Product decay, fourier, spline;
};

// The signatures of up to 32 vertices; missing samples repeat the first.
void describe(const Steps& steps, const Eigenbasis& basis, double scale, std::span<const int32_t> vertices,
              double* result) {
  const Eigen::Index k = basis.Phi.cols();
  const AlignedArray<double> squared(k * lanes), hks(steps.decay.size()), spectrum(steps.fourier.size()),
      magnitude(frequency_count * lanes), values(steps.spline.size());
  for (Eigen::Index i = 0; i < k; ++i)
    for (size_t j = 0; j < lanes; ++j) {
      const double phi = basis.Phi(vertices[j < vertices.size() ? j : 0], i);
      squared.data()[i * lanes + j] = phi * phi * scale;
    }
  steps.decay.apply(squared.data(), hks.data());
  double* log_hks = hks.data();
  for (int i = 0; i < time_count * lanes; ++i) log_hks[i] = std::log(std::max(log_hks[i], 1e-300));
  for (int i = 0; i < (time_count - 1) * lanes; ++i) log_hks[i] = log_hks[i + lanes] - log_hks[i];
  steps.fourier.apply(log_hks, spectrum.data());
  for (int i = 0; i < frequency_count * lanes; ++i) {
    const double real = spectrum.data()[i], imaginary = spectrum.data()[frequency_count * lanes + i];
    magnitude.data()[i] = std::sqrt(real * real + imaginary * imaginary);
  }
  steps.spline.apply(magnitude.data(), values.data());
  for (size_t j = 0; j < vertices.size(); ++j)
    for (int i = 0; i < si_hks_dimension; ++i)
      result[j * si_hks_dimension + i] = values.data()[i * lanes + j];
}

}  // namespace

SiHksMaps si_hks_maps(const Vector& lambda, double area) {
  const double scale = area / reference_area;  // eigenvalues of the shape scaled to the reference area
  SiHksMaps maps{scale, frequency_count, RowMatrix(time_count, lambda.size()), fourier_matrix(),
                 spline_matrix()};
  for (int k = 0; k < time_count; ++k)
    maps.decay.row(k) = (-lambda.array() * scale * std::exp2(1 + 0.1 * k)).exp();
  return maps;
}

RowMatrix si_hks(const Eigenbasis& basis, double area, std::span<const int32_t> vertices,
                 const Execution& execution) {
  const SiHksMaps maps = si_hks_maps(basis.lambda, area);
  const double scale = maps.scale;
  const Steps steps{Product(maps.decay), Product(maps.fourier), Product(maps.spline)};
  RowMatrix result(vertices.size(), si_hks_dimension);
  parallel_for_ranges(execution, result.rows(), lanes, [&](int64_t begin, int64_t end) {
    describe(steps, basis, scale, vertices.subspan(begin, end - begin), &result(begin, 0));
  });
  return result;
}

DescriptorKind si_hks_descriptor() {
  return {"si-hks", si_hks_dimension,
          [](const DescribedSurface& surface, std::span<const int32_t> vertices, const Execution& execution) {
            return si_hks(surface.basis, surface.operators.area, vertices, execution);
          }};
}

}  // namespace focal
