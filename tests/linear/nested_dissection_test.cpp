// The order must be one, and fill no more than minimum degree does on surfaces as large as it is used for.
#include "linear/nested_dissection.h"

#include <doctest/doctest.h>

#include <algorithm>

#include "linear/sparse_cholesky.h"
#include "linear/symbolic_factor.h"
#include "operators/operators.h"
#include "surfaces.h"

using namespace focal;
using namespace focal_test;

namespace {

int64_t panel_entries(const SymbolicFactor& factor) { return factor.value_start.back(); }

}  // namespace

TEST_CASE("every vertex gets one number, on a surface and on too few vertices to cut") {
  for (const TriangleMesh& mesh : {sphere(4), square(3), square(40, 0.2)}) {
    auto order = nested_dissection(make_operators(mesh).L, mesh.positions);
    std::sort(order.begin(), order.end());
    for (int32_t i = 0; i < mesh.vertex_count(); ++i) REQUIRE(order[i] == i);
  }
}

TEST_CASE("vertices that all lie on one point are numbered too") {
  const TriangleMesh mesh = sphere(4);
  auto order = nested_dissection(make_operators(mesh).L, MatrixX3::Zero(mesh.vertex_count(), 3));
  std::sort(order.begin(), order.end());
  CHECK(std::adjacent_find(order.begin(), order.end()) == order.end());
}

TEST_CASE("a factor in this order solves, and holds at most a tenth more than by minimum degree") {
  for (const TriangleMesh& mesh : {sphere(5), square(60, 0.2)}) {
    const Operators operators = make_operators(mesh);
    SparseMatrix A = operators.L;
    for (int32_t i = 0; i < A.rows(); ++i) A.coeffRef(i, i) += operators.mass[i];
    const auto cut =
        std::make_shared<const SymbolicFactor>(analyse_pattern(A, nested_dissection(A, mesh.positions)));
    CHECK(static_cast<double>(panel_entries(*cut)) <
          1.1 * static_cast<double>(panel_entries(analyse_pattern(A))));
    const Vector b = Vector::LinSpaced(A.rows(), -1, 1);
    CHECK((A * SparseCholesky(A, cut).solve(b) - b).norm() < 1e-10 * b.norm());
  }
}
