// Eigenpairs and signatures on a device. As spectrum/chebyshev.cpp: subspace iteration in the shifted inverse, sharpened by
// Chebyshev polynomials, but all in double and by products with a dense matrix. The inverse is that of the heat step,
// M^-1/2 L M^-1/2 + shift I being M^-1/2 (M + t L) M^-1/2 / t at shift 1 / t, so it costs no other factor.
#pragma once
#include <cmath>
#include <limits>

#include "device/surface.h"

namespace focal {

namespace device_detail {

constexpr double pass_lift =
    1e6;  // of the first eigenvector over the last column between two orthonormalisations
constexpr int max_rounds = 20, max_passes = 8, max_degree = 30;

// T_degree(2 nu / cut - 1), nu = 1 / (lambda + shift); see Filter in spectrum/chebyshev_filter.h.
struct DeviceFilter {
  double last, shift;
  double rate(double lambda) const {
    return std::acosh(std::max(2 * (last + shift) / (lambda + shift) - 1, 1.0001));
  }
  int degree_of_pass() const {
    return std::clamp(static_cast<int>(std::acosh(pass_lift) / rate(0)), 2, max_degree);
  }
  // So that what is left of a wanted column falls by `growth`.
  int passes_for(double growth, double lambda) const {
    const double degree = std::acosh(std::max(growth, 1.0)) / rate(lambda);
    return std::clamp(static_cast<int>(std::ceil(degree / degree_of_pass())), 1, max_passes);
  }
};

template <class Queue>
class SubspaceIteration {
 public:
  SubspaceIteration(DeviceSurface<Queue>& surface, int32_t count)
      : surface_(surface),
        queue_(surface.queue),
        n_(surface.n),
        count_(count),
        m_(std::min((count + count / 5 + 16 + 31) / 32 * 32, surface.n)),
        S_(queue_, int64_t{n_} * n_),
        X_(queue_, int64_t{n_} * m_),
        Y_(queue_, int64_t{n_} * m_),
        G_(queue_, int64_t{m_} * m_),
        lambda_on_device_(queue_, m_),
        lambda_(static_cast<size_t>(m_)) {}

  void run(double tolerance) {
    const double shift = 1 / surface_.heat_time, per_wanted = static_cast<double>(m_) / count_;
    DeviceFilter filter{4 * 3.14159265358979324 * m_ / surface_.area, shift};  // Weyl's law
    queue_.launch(int64_t{n_} * m_, RandomColumns{X_.data()});
    int passes = 2;
    for (int round = 0; round < max_rounds; ++round) {
      double residual = 0;
      surface_.clock.time("spectrum filter", passes * filter.degree_of_pass() * 2.0 * n_ * n_ * m_,
                          passes * filter.degree_of_pass() * (8.0 * n_ * n_ + 24.0 * n_ * m_),
                          [&] { filter_columns(filter, passes); });
      surface_.clock.time("spectrum Ritz", 4.0 * n_ * m_ * m_ * 2 + 9.0 * m_ * m_ * m_, 64.0 * n_ * m_,
                          [&] { residual = rayleigh_ritz(tolerance); });
      if (residual <= tolerance) return;
      if (std::isnan(residual)) break;
      const double wanted = lambda_[static_cast<size_t>(count_) - 1];
      filter.last = std::max(std::min(lambda_.back(), 1.05 * per_wanted * wanted), 0.01 * shift);
      passes = filter.passes_for(5 * residual / tolerance, wanted);
    }
    throw DeviceFailure{false, "the eigenvalues of the surface did not converge on the GPU"};
  }

  void finish(double* lambda, double* phi) {
    for (int32_t j = 0; j < count_; ++j) lambda[j] = std::max(lambda_[static_cast<size_t>(j)], 0.0);
    surface_.phi = {queue_, int64_t{n_} * count_};
    surface_.eigenpairs = count_;
    queue_.launch(int64_t{n_} * count_,
                  EigenvectorEntry{X_.data(), surface_.mass.data(), surface_.phi.data(), m_, count_});
    surface_.phi.download(phi, surface_.phi.size());
  }

 private:
  using Array = DeviceArray<double, Queue>;

  void filter_columns(const DeviceFilter& filter, int passes) {
    const double factor = 4 * (filter.last + filter.shift) * surface_.heat_time;
    queue_.launch(int64_t{n_} * n_,
                  FilterMatrix{surface_.heat_inverse.data(), surface_.mass.data(), S_.data(), factor, n_});
    for (int pass = 0; pass < passes; ++pass) {
      apply_filter(0.5, 0);  // T_1 = S / 2, then T_k+1 = S T_k - T_k-1
      for (int k = 1; k < filter.degree_of_pass(); ++k) apply_filter(1, -1);
      orthonormalise(1e-13);
      orthonormalise(0);
    }
  }

  // X <- alpha X S + beta Y, Y <- X.
  void apply_filter(double alpha, double beta) {
    queue_.multiply('N', 'N', m_, n_, n_, alpha, X_.data(), m_, S_.data(), n_, beta, Y_.data(), m_);
    std::swap(X_, Y_);
  }

  // By the Cholesky factor of the Gram matrix, twice: the first time a raised diagonal keeps it definite (T. Fukaya et al.,
  // "Shifted Cholesky QR for Computing the QR Factorization of Ill-Conditioned Matrices", 2020).
  void orthonormalise(double raise) {
    queue_.multiply('N', 'T', m_, m_, n_, 1.0, X_.data(), m_, X_.data(), m_, 0.0, G_.data(), m_);
    if (raise > 0) queue_.launch(1, RaiseDiagonal{G_.data(), raise, m_});
    queue_.cholesky(G_.data(), m_);
    queue_.solve_lower(G_.data(), m_, X_.data(), n_);
  }

  void rotate(Array& columns) {
    Array turned(queue_, columns.size());
    queue_.multiply('T', 'N', m_, n_, m_, 1.0, G_.data(), m_, columns.data(), m_, 0.0, turned.data(), m_);
    columns = std::move(turned);
  }

  // Returns the largest relative residual of the wanted pairs.
  double rayleigh_ritz(double tolerance) {
    queue_.launch(int64_t{n_} * m_,
                  ApplyLaplacian{surface_.laplacian(), surface_.mass.data(), X_.data(), Y_.data(), m_});
    queue_.multiply('N', 'T', m_, m_, n_, 1.0, X_.data(), m_, Y_.data(), m_, 0.0, G_.data(), m_);
    queue_.symmetric_eigen(G_.data(), m_, lambda_on_device_.data());
    rotate(X_), rotate(Y_);
    const int32_t chunks = (n_ + ResidualChunk::rows - 1) / ResidualChunk::rows;
    const Array partial(queue_, int64_t{chunks} * m_);
    queue_.launch(partial.size(),
                  ResidualChunk{X_.data(), Y_.data(), lambda_on_device_.data(), partial.data(), n_, m_});
    std::vector<double> squares(static_cast<size_t>(partial.size()));
    partial.download(squares.data(), partial.size());
    lambda_on_device_.download(lambda_.data(), m_);
    const double rounding = 30 * std::numeric_limits<double>::epsilon() * surface_.norm_bound;
    double largest = 0;
    for (int32_t j = 0; j < count_; ++j) {
      double sum = 0;
      for (int32_t c = 0; c < chunks; ++c) sum += squares[static_cast<size_t>(c) * m_ + j];
      const double size = std::max(lambda_[static_cast<size_t>(j)], 1e-3 / surface_.heat_time);
      const double residual = std::sqrt(sum) / (size + rounding / tolerance);
      if (!(residual <= largest)) largest = residual;  // NaN stays
    }
    return largest;
  }

  DeviceSurface<Queue>& surface_;
  Queue& queue_;
  int32_t n_, count_, m_;
  Array S_, X_, Y_, G_, lambda_on_device_;
  std::vector<double> lambda_;
};

}  // namespace device_detail

template <class Queue>
void spectrum(DeviceSurface<Queue>& surface, int32_t count, double tolerance, double* lambda, double* phi) {
  if (count < 1 || count > surface.n) throw DeviceFailure{false, "there are not so many eigenpairs"};
  device_detail::SubspaceIteration<Queue> iteration(surface, count);
  iteration.run(tolerance);
  iteration.finish(lambda, phi);
}

// Signatures of some vertices; see descriptors/si_hks.cpp and the other spectral ones.
template <class Queue>
void signatures(DeviceSurface<Queue>& surface, const ComputeSignature& how, const int32_t* vertices,
                int32_t count, float* out) {
  using Array = DeviceArray<double, Queue>;
  Queue& queue = surface.queue;
  if (!surface.phi.data()) throw DeviceFailure{false, "signatures need a spectrum"};
  const int32_t k = surface.eigenpairs, T = how.times, F = how.frequencies, C = how.components;
  const DeviceArray<int32_t, Queue> vertex(queue, vertices, count);
  const Array decay(queue, how.decay, int64_t{T} * k), squared(queue, int64_t{count} * k),
      hks(queue, int64_t{count} * T);
  // Rows (samples) of A times the transpose of a map by rows.
  const auto apply = [&](const Array& map, int32_t to, int32_t from, const Array& A, const Array& result_of) {
    queue.multiply('T', 'N', to, count, from, 1.0, map.data(), from, A.data(), from, 0.0, result_of.data(),
                   to);
  };
  const auto map_squares = [&] {
    queue.launch(squared.size(),
                 SquaredEigenfunctions{surface.phi.data(), vertex.data(), squared.data(), how.scale, k});
    apply(decay, T, k, squared, hks);
  };
  if (F == 0) {
    const DeviceArray<float, Queue> result(queue, hks.size());
    surface.clock.time("signatures", 2.0 * count * T * k, 8.0 * count * (2 * k + 2 * T), [&] {
      map_squares();
      queue.launch(hks.size(), ToFloat{hks.data(), result.data()});
    });
    return result.download(out, result.size());
  }
  const Array fourier(queue, how.fourier, int64_t{2} * F * (T - 1)),
      spline(queue, how.spline, int64_t{C} * F);
  const Array difference(queue, int64_t{count} * (T - 1)), frequency(queue, int64_t{count} * 2 * F),
      magnitude(queue, int64_t{count} * F), values(queue, int64_t{count} * C);
  const DeviceArray<float, Queue> result(queue, values.size());
  surface.clock.time("signatures", 2.0 * count * (T * k + 2 * F * (T - 1) + C * F),
                     8.0 * count * (2 * k + 4 * T + 6 * F + 2 * C), [&] {
                       map_squares();
                       queue.launch(difference.size(), LogDifference{hks.data(), difference.data(), T});
                       apply(fourier, 2 * F, T - 1, difference, frequency);
                       queue.launch(magnitude.size(), Magnitude{frequency.data(), magnitude.data(), F});
                       apply(spline, C, F, magnitude, values);
                       queue.launch(values.size(), ToFloat{values.data(), result.data()});
                     });
  result.download(out, result.size());
}

}  // namespace focal
