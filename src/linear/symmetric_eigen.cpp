// Householder's reduction to a tridiagonal matrix, then QL steps with implicit shifts (A. Dubrulle, R.
// Martin, J. Wilkinson, "The Implicit QL Algorithm", 1968). The steps on the tridiagonal matrix are
// sequential but cheap; all expensive work is on the rows of the eigenvector matrix, 32 of them interleaved,
// blocks of rows in parallel.
#include "linear/symmetric_eigen.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "base/aligned_array.h"
#include "base/error.h"
#include "base/multiversion.h"
#include "linear/block_kernels.h"

namespace focal {
namespace {

constexpr int lanes = 32;

struct Tridiagonal {
  std::vector<double> diagonal, beside;  // beside[i]: of rows i and i + 1
  // Q = H_0 H_1 ..., H_k = I - v v^T, v of length sqrt(2) or 0, row k, zero up to entry k.
  RowMatrix reflectors;
};

// Row i of the matrix minus v_i w + w_i v, and its product with `next`; all from entry `begin` on.
FOCAL_INLINE double update_body(double* row, const double* v, const double* w, double vi, double wi,
                                const double* next, int64_t begin, int64_t n) {
  constexpr int width = 16;  // partial sums, the same for every vector width
  double part[width] = {};
  int64_t j = begin;
  for (; j + width <= n; j += width)
    for (int k = 0; k < width; ++k) {
      row[j + k] -= vi * w[j + k] + wi * v[j + k];
      part[k] += row[j + k] * next[j + k];
    }
  for (; j < n; ++j) {
    row[j] -= vi * w[j] + wi * v[j];
    part[0] += row[j] * next[j];
  }
  double sum = 0;
  for (const double p : part) sum += p;
  return sum;
}
FOCAL_MULTIVERSION(void update_rows(double* A, int64_t stride, const double* v, const double* w,
                                    const double* next, double* product, int64_t begin, int64_t n),
                   for (int64_t i = begin; i < n; ++i)
                       product[i] = update_body(A + i * stride, v, w, v[i], w[i], next, begin, n);)

// The reflector that zeroes x except for its entry `at`, and the value of that entry. Zero where nothing
// needs to be done.
double make_reflector(const double* x, int64_t at, int64_t n, double* v) {
  std::fill_n(v, n, 0.0);
  double largest = 0, squared = 0;
  for (int64_t j = at + 1; j < n; ++j) largest = std::max(largest, std::abs(x[j]));
  if (!(largest > 0)) return x[at];
  largest = std::max(largest, std::abs(x[at]));
  for (int64_t j = at; j < n; ++j) v[j] = x[j] / largest, squared += v[j] * v[j];
  const double length = std::copysign(std::sqrt(squared), v[at]);
  const double unit = 1 / std::sqrt(squared + length * v[at]);  // |v|^2 = 2
  v[at] += length;
  for (int64_t j = at; j < n; ++j) v[j] *= unit;
  return -length * largest;
}

Tridiagonal tridiagonalise(const Matrix& given) {
  const int64_t n = given.rows();
  RowMatrix A = given.selfadjointView<Eigen::Upper>();
  Tridiagonal result{std::vector<double>(n), std::vector<double>(n, 0.0), RowMatrix::Zero(n, n)};
  Vector none = Vector::Zero(n), w = none, product = none;
  // The next step subtracts the last step's v and w from the rows when it reads them.
  const double* v = none.data();
  for (int64_t k = 0; k < n; ++k) {
    for (int64_t j = k; j < n; ++j) A(k, j) -= v[k] * w[j] + w[k] * v[j];
    result.diagonal[k] = A(k, k);
    if (k + 1 == n) break;
    double* next = &result.reflectors(k, 0);
    result.beside[k] = make_reflector(&A(k, 0), k + 1, n, next);
    update_rows(A.data(), n, v, w.data(), next, product.data(), k + 1, n);
    double half = 0;
    for (int64_t j = k + 1; j < n; ++j) half += product[j] * next[j] / 2;
    for (int64_t j = k + 1; j < n; ++j) w[j] = product[j] - half * next[j];
    v = next;
  }
  return result;
}

struct Rotation {
  int32_t column;  // with the one after it
  double c, s;
};

// QL steps on the tridiagonal matrix until its diagonal contains the eigenvalues; returns the rotations.
std::vector<Rotation> diagonalise(std::vector<double>& d, std::vector<double>& e) {
  const auto n = static_cast<int32_t>(d.size());
  std::vector<Rotation> rotations;
  for (int32_t l = 0; l < n; ++l)
    for (int step = 0;; ++step) {
      int32_t m = l;
      while (m + 1 < n &&
             std::abs(e[m]) > std::numeric_limits<double>::epsilon() * (std::abs(d[m]) + std::abs(d[m + 1])))
        ++m;
      if (m == l) break;
      if (step == 60)
        throw Error(Status::not_converged, "the eigenvalues of a dense matrix did not converge",
                    "report this");
      const double half = (d[l + 1] - d[l]) / (2 * e[l]);
      double g =
          d[m] - d[l] + e[l] / (half + std::copysign(std::hypot(half, 1.0), half));  // Wilkinson's shift
      double s = 1, c = 1, shifted = 0;
      int32_t i = m - 1;
      for (; i >= l; --i) {
        const double f = s * e[i], b = c * e[i], r = std::sqrt(f * f + g * g);
        e[i + 1] = r;
        if (r == 0) {  // split earlier than expected
          d[i + 1] -= shifted;
          break;
        }
        s = f / r, c = g / r;
        const double below = d[i + 1] - shifted, mixed = (d[i] - below) * s + 2 * c * b;
        shifted = s * mixed;
        d[i + 1] = below + shifted;
        g = c * mixed - b;
        rotations.push_back({i, c, s});
      }
      e[m] = 0;
      if (i >= l) continue;
      d[l] -= shifted, e[l] = g;
    }
  return rotations;
}

// 32 rows of Q, V[j * 32 + lane], times the reflectors, then times the rotations.
template <int vector_bytes>
FOCAL_INLINE void transform_rows(const RowMatrix& reflectors, const std::vector<Rotation>& rotations,
                                 double* V) {
  typedef double Lane __attribute__((vector_size(vector_bytes), may_alias));
  constexpr int vectors = 4, width = vectors * vector_bytes / int{sizeof(double)};
  const int64_t n = reflectors.rows();
  for (int lane = 0; lane < lanes; lane += width) {
    const auto at = [&](int64_t column) { return reinterpret_cast<Lane*>(V + column * lanes + lane); };
    for (int64_t k = 0; k + 1 < n; ++k) {
      const double* v = reflectors.data() + k * n;
      Lane sum[vectors] = {};
      for (int64_t j = k + 1; j < n; ++j)
        for (int i = 0; i < vectors; ++i) sum[i] += v[j] * at(j)[i];
      for (int64_t j = k + 1; j < n; ++j)
        for (int i = 0; i < vectors; ++i) at(j)[i] -= v[j] * sum[i];
    }
    // Rotations of one step go from column to column: the column shared with the next one stays in registers.
    int32_t column = rotations.empty() ? 0 : rotations[0].column + 1;
    Lane carried[vectors];
    for (int i = 0; i < vectors; ++i) carried[i] = at(column)[i];
    for (const Rotation& r : rotations) {
      if (r.column + 1 != column) {
        for (int i = 0; i < vectors; ++i) at(column)[i] = carried[i], carried[i] = at(r.column + 1)[i];
      }
      for (int i = 0; i < vectors; ++i) {
        const Lane a = at(r.column)[i], b = carried[i];
        carried[i] = r.c * a - r.s * b, at(r.column + 1)[i] = r.s * a + r.c * b;
      }
      column = r.column;
    }
    for (int i = 0; i < vectors; ++i) at(column)[i] = carried[i];
  }
}
FOCAL_MULTIVERSION(void transform(const RowMatrix& reflectors, const std::vector<Rotation>& rotations,
                                  double* V),
                   transform_rows<vector_bytes>(reflectors, rotations, V);)

}  // namespace

SymmetricEigen symmetric_eigen(const Matrix& A, const Execution& execution) {
  const int64_t n = A.rows();
  if (!A.allFinite())
    throw Error(Status::not_converged, "the eigenvalues of the surface did not converge",
                "the mesh may hold non-finite positions or degenerate triangles; repair it first");
  const Matrix upper = A.triangularView<Eigen::Upper>();
  const double scale = std::max(upper.cwiseAbs().maxCoeff(), std::numeric_limits<double>::min());
  Tridiagonal tridiagonal = tridiagonalise(upper / scale);  // keeps squares in range
  auto& values = tridiagonal.diagonal;
  const auto rotations = diagonalise(values, tridiagonal.beside);
  std::vector<int32_t> order(n);
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int32_t a, int32_t b) { return values[a] < values[b]; });
  SymmetricEigen result{Vector(n), Matrix(n, n)};
  for (int64_t j = 0; j < n; ++j) result.values[j] = scale * values[order[j]];
  parallel_for_ranges(execution, n, lanes, [&](int64_t begin, int64_t end) {
    const AlignedArray<double> V(n * lanes);
    std::fill_n(V.data(), V.size(), 0.0);
    for (int64_t i = begin; i < end; ++i) V.data()[i * lanes + i - begin] = 1;
    transform(tridiagonal.reflectors, rotations, V.data());
    for (int64_t j = 0; j < n; ++j)
      for (int64_t i = begin; i < end; ++i) result.vectors(i, j) = V.data()[order[j] * lanes + i - begin];
  });
  return result;
}

Matrix dense_product(const Matrix& A, const Matrix& B, const Execution& execution) {
  const int64_t rows = (A.rows() + 3) / 4 * 4, inner = A.cols();
  const AlignedArray<double> padded(rows * inner);
  for (int64_t k = 0; k < inner; ++k) {
    std::fill_n(std::copy_n(A.data() + k * A.rows(), A.rows(), padded.data() + k * rows), rows - A.rows(),
                0.0);
  }
  Matrix C(A.rows(), B.cols());
  parallel_for_ranges(execution, B.cols(), lanes, [&](int64_t begin, int64_t end) {
    const AlignedArray<double> b(inner * lanes), c(rows * lanes);
    std::fill_n(b.data(), b.size(), 0.0), std::fill_n(c.data(), c.size(), 0.0);
    for (int64_t k = 0; k < inner; ++k)
      for (int64_t j = begin; j < end; ++j) b.data()[k * lanes + j - begin] = B(k, j);
    multiply_add(StridedView<double>{padded.data(), 1, rows}, rows, inner, b.data(), c.data());
    for (int64_t i = 0; i < A.rows(); ++i)
      for (int64_t j = begin; j < end; ++j) C(i, j) = c.data()[i * lanes + j - begin];
  });
  return C;
}

}  // namespace focal
