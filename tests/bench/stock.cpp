#include "stock.h"

#include <Spectra/SymEigsShiftSolver.h>

#include <Eigen/SparseCholesky>
#include <atomic>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <thread>

#include "analysis/leaf_votes.h"
#include "base/random.h"
#include "base/stopwatch.h"
#include "descriptors/si_hks.h"
#include "placing.h"

namespace focal_bench {
namespace {

using namespace focal;
using Ldlt = Eigen::SimplicialLDLT<SparseMatrix>;

constexpr int32_t krylov_space = 300;
constexpr double tolerance = 1e-6;
// Surfaces have area 1, their 200th eigenvalue is about 2500. Shifts from -1 to -1000 all took the same time.
constexpr double shift = -10;

void on_threads(int count, const std::function<void(int)>& body) {
  std::vector<std::thread> threads;
  for (int i = 1; i < count; ++i) threads.emplace_back(body, i);
  body(0);
  for (auto& thread : threads) thread.join();
}

SparseMatrix plus_diagonal(SparseMatrix A, const Vector& diagonal) {
  for (int32_t i = 0; i < A.rows(); ++i) A.coeffRef(i, i) += diagonal[i];
  return A;
}

// (A - sigma I)^-1 in the interface that Spectra asks for. Its own class takes an LU factor, which is slower.
class ShiftedInverse {
 public:
  using Scalar = double;
  explicit ShiftedInverse(const SparseMatrix& A) : A_(A) {}
  Eigen::Index rows() const { return A_.rows(); }
  Eigen::Index cols() const { return A_.cols(); }
  void set_shift(double sigma) {
    ldlt_.compute(plus_diagonal(A_, Vector::Constant(A_.rows(), -sigma)));
    if (ldlt_.info() != Eigen::Success) throw std::runtime_error("stock: the shifted matrix has no factor");
  }
  void perform_op(const double* x, double* y) const {
    Eigen::Map<Vector>(y, rows()) = ldlt_.solve(Eigen::Map<const Vector>(x, rows()));
  }

 private:
  const SparseMatrix& A_;
  Ldlt ldlt_;
};

}  // namespace

Eigenbasis stock_eigenpairs(const Operators& operators, int32_t count) {
  const Vector inverse_root_mass = operators.mass.cwiseSqrt().cwiseInverse();
  const SparseMatrix A = inverse_root_mass.asDiagonal() * operators.L * inverse_root_mass.asDiagonal();
  ShiftedInverse inverse(A);
  const auto space = std::min<int32_t>(krylov_space, static_cast<int32_t>(A.rows()));
  Spectra::SymEigsShiftSolver<ShiftedInverse> solver(inverse, count, space, shift);
  solver.init();
  solver.compute(Spectra::SortRule::LargestMagn, 1000, tolerance, Spectra::SortRule::SmallestAlge);
  if (solver.info() != Spectra::CompInfo::Successful)
    throw std::runtime_error("stock: Spectra did not converge");
  return {solver.eigenvalues().cwiseMax(0), inverse_root_mass.asDiagonal() * solver.eigenvectors()};
}

// For each face the gradients of its three corners' hat functions, one a row, and the area.
struct StockHeat::Parts {
  struct Face {
    Eigen::Matrix3d gradient;
    double area;
  };
  Ldlt heat, poisson;
  MatrixX3i triangles;
  std::vector<Face> faces;
};

StockHeat::~StockHeat() = default;
StockHeat::StockHeat(const TriangleMesh& mesh, const Operators& operators)
    : parts_(std::make_unique<Parts>()) {
  const double time = operators.mean_edge * operators.mean_edge;
  parts_->heat.compute(plus_diagonal(time * operators.L, operators.mass));
  parts_->poisson.compute(plus_diagonal(operators.L, 1e-8 * operators.mass));
  if (parts_->heat.info() != Eigen::Success || parts_->poisson.info() != Eigen::Success)
    throw std::runtime_error("stock: the heat method has no factor");
  parts_->triangles = mesh.triangles;
  parts_->faces.resize(mesh.triangle_count());
  for (int32_t t = 0; t < mesh.triangle_count(); ++t) {
    Vector3 corner[3];
    for (int i = 0; i < 3; ++i) corner[i] = mesh.positions.row(mesh.triangles(t, i));
    const Vector3 normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
    auto& face = parts_->faces[t];
    face.area = normal.norm() / 2;
    for (int i = 0; i < 3; ++i)
      face.gradient.row(i) =
          normal.cross(corner[(i + 2) % 3] - corner[(i + 1) % 3]) / std::max(normal.squaredNorm(), 1e-30);
  }
}

void StockHeat::distance(int32_t source, Vector& heat, Vector& right_side, double* out) const {
  right_side.setZero();
  right_side[source] = 1;
  heat = parts_->heat.solve(right_side);
  right_side.setZero();
  for (Eigen::Index t = 0; t < parts_->triangles.rows(); ++t) {
    const auto corner = parts_->triangles.row(t);
    const auto& face = parts_->faces[t];
    const Vector3 flow =
        face.gradient.transpose() * Vector3(heat[corner[0]], heat[corner[1]], heat[corner[2]]);
    const double length = flow.norm();
    if (!(length > 1e-300)) continue;
    const Vector3 divergence = face.gradient * flow * (-face.area / length);
    for (int i = 0; i < 3; ++i) right_side[corner[i]] += divergence[i];
  }
  Eigen::Map<Vector> distances(out, heat.size());
  distances = parts_->poisson.solve(right_side);
  distances = (distances.array() - out[source]).cwiseMax(0).eval();
}

RowMatrix StockHeat::distances(std::span<const int32_t> sources, int threads) const {
  const auto n = static_cast<Eigen::Index>(parts_->heat.rows());
  RowMatrix result(sources.size(), n);
  std::atomic<size_t> next{0};
  on_threads(threads, [&](int) {
    Vector heat(n), right_side(n);
    for (size_t s = next++; s < sources.size(); s = next++)
      distance(sources[s], heat, right_side, &result(s, 0));
  });
  return result;
}

RowMatrixf stock_votes(const VoteTables& tables, const RowMatrix& distances, int threads) {
  const Eigen::Index n = distances.cols();
  RowMatrixf votes = RowMatrixf::Zero(n, tables.landmarks);
  on_threads(threads, [&](int thread) {
    for (Eigen::Index s = 0; s < distances.rows(); ++s)
      for (Eigen::Index v = n * thread / threads; v < n * (thread + 1) / threads; ++v) {
        const double at = std::min(distances(s, v) / tables.width, tables.rows - 1.0);
        const int32_t row = std::min(static_cast<int32_t>(at), tables.rows - 2);
        const auto fraction = static_cast<float>(at - row);
        const float *low = tables.of(s) + static_cast<int64_t>(row) * tables.stride(),
                    *high = low + tables.stride();
        for (int32_t l = 0; l < tables.landmarks; ++l) votes(v, l) += low[l] + fraction * (high[l] - low[l]);
      }
  });
  return votes;
}

StockDetection stock_detect(const LandmarkModel& model, TriangleMesh source, int threads) {
  StockDetection result;
  Stopwatch whole, watch;
  const PreparedMesh mesh = prepare(std::move(source));
  const Operators operators = make_operators(mesh.surface, bridges_of(mesh));
  watch.lap();
  const Eigenbasis basis = stock_eigenpairs(operators, model.params.eigenpair_count);
  result.eigenpairs = watch.lap();
  const std::vector<int32_t> samples = drawn_samples(mesh.surface.vertex_count());
  const RowMatrixf descriptors = si_hks(basis, operators.area, samples).cast<float>();
  watch.lap();
  const StockHeat heat(mesh.surface, operators);
  const RowMatrix distances = heat.distances(samples, threads);
  result.distances = watch.lap();
  const VoteTables tables = LeafVotes(model, descriptors, threads_of(threads))
                                .tables(0, static_cast<int32_t>(samples.size()), threads_of(threads));
  const RowMatrixf votes = stock_votes(tables, distances, threads);
  result.votes = watch.lap();
  const DistanceFields fields = [&](std::span<const int32_t> from) -> RowMatrixf {
    return heat.distances(from, threads).cast<float>();
  };
  const auto peaks = peaks_of(votes, tables.landmarks, mesh.surface, operators, threads_of(threads));
  result.vertex = choose_among(peaks, votes, model, mesh, fields, threads_of(threads));
  result.total = whole.lap();
  return result;
}

}  // namespace focal_bench
