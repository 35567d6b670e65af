// SI-HKS against its definition and its invariances.
#include "descriptors/si_hks.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>

#include "operators/operators.h"
#include "surfaces.h"

using namespace focal;
using namespace focal_test;

namespace {

std::vector<int32_t> all_vertices(Eigen::Index n) {
  std::vector<int32_t> all(n);
  std::iota(all.begin(), all.end(), 0);
  return all;
}

RowMatrix describe(const TriangleMesh& mesh) {
  const Operators operators = make_operators(mesh);
  const Eigenbasis basis = eigenbasis(operators.L, operators.mass, {.count = 60}, {});
  return si_hks(basis, operators.area, all_vertices(mesh.vertex_count()));
}

// Largest difference, relative to the largest entry.
double difference(const RowMatrix& a, const RowMatrix& b) {
  return (a - b).cwiseAbs().maxCoeff() / a.cwiseAbs().maxCoeff();
}

// The definition, in complex numbers and without any cleverness: |DFT| of the steps of log HKS over tau.
std::vector<double> spectrum_by_definition(const Eigenbasis& basis, double area, int32_t vertex) {
  const double scale = area / 2e4;
  std::vector<double> log_hks;
  for (int i = 0; i <= 240; ++i) {
    const double t = std::pow(2.0, 1 + 0.1 * i);
    double heat = 0;
    for (Eigen::Index k = 0; k < basis.lambda.size(); ++k)
      heat += std::pow(basis.Phi(vertex, k), 2) * scale * std::exp(-basis.lambda[k] * scale * t);
    log_hks.push_back(std::log(heat));
  }
  std::vector<double> result;
  for (int f = 0; f < 20; ++f) {
    std::complex<double> sum = 0;
    for (int i = 0; i < 240; ++i)
      sum += (log_hks[i + 1] - log_hks[i]) * std::polar(1.0, -2 * std::numbers::pi * f * i / 240);
    result.push_back(std::abs(sum));
  }
  return result;
}

}  // namespace

TEST_CASE("every fifth component is a Fourier magnitude by definition: the spline passes through its knots") {
  Eigenbasis basis;
  basis.lambda.resize(4), basis.Phi.resize(3, 4);
  basis.lambda << 0, 3, 7.5, 20;
  basis.Phi << 0.6, 0.1, -0.8, 1.1, 0.6, -1.2, 0.3, 0.2, 0.6, 0.05, 0.02, 2;
  const double area = 2.7;
  const std::vector<int32_t> vertices = {2, 0};
  const RowMatrix signature = si_hks(basis, area, vertices);
  REQUIRE(signature.rows() == 2);
  REQUIRE(signature.cols() == si_hks_dimension);
  for (int row = 0; row < 2; ++row) {
    const auto expected = spectrum_by_definition(basis, area, vertices[row]);
    for (int f = 0; f < 20; ++f) CHECK(signature(row, 5 * f) == doctest::Approx(expected[f]).epsilon(1e-9));
  }
}

TEST_CASE("SI-HKS does not change with position and size") {
  TriangleMesh mesh = with_radius(sphere(4), lump);
  const RowMatrix before = describe(mesh);
  Random random(9);
  mesh.positions =
      ((250 * mesh.positions * random_rotation(random)).rowwise() + Eigen::RowVector3d(9, 8, 7)).eval();
  CHECK(difference(before, describe(mesh)) < 1e-5);
}

TEST_CASE("SI-HKS is equal at mirror points, which is why left and right need other means") {
  const TriangleMesh mesh = with_radius(sphere(4), mirror_lump);  // its triangulation is symmetric too
  const RowMatrix signature = describe(mesh);
  double largest = 0;
  for (int32_t v = 0; v < mesh.vertex_count(); ++v) {
    const Eigen::RowVector3d image = mesh.positions.row(v).cwiseProduct(Eigen::RowVector3d(-1, 1, 1));
    Eigen::Index twin = 0;
    REQUIRE((mesh.positions.rowwise() - image).rowwise().squaredNorm().minCoeff(&twin) < 1e-20);
    largest = std::max(largest, (signature.row(v) - signature.row(twin)).cwiseAbs().maxCoeff());
  }
  CHECK(largest < 1e-5 * signature.maxCoeff());
}

TEST_CASE("SI-HKS distinguishes the points of a lump, but not those of a sphere") {
  const auto spread = [](const RowMatrix& signature) {
    return (signature.rowwise() - signature.colwise().mean()).rowwise().norm().mean() /
           signature.rowwise().norm().mean();
  };
  CHECK(spread(describe(sphere(4))) < 0.1);
  CHECK(spread(describe(with_radius(sphere(4), lump))) > 2 * spread(describe(sphere(4))));
}
