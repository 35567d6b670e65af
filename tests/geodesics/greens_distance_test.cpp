// Biharmonic and commute-time distance against dense pseudo-inverses, and what every distance of the list must be.
#include <doctest/doctest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <set>

#include "geodesics/make_distance.h"
#include "surfaces.h"

using namespace focal;
using namespace focal_test;

namespace {

Matrix pseudo_inverse(const Matrix& A) {
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(A);
  Vector inverse = eigen.eigenvalues();
  for (double& value : inverse) value = value > 1e-9 * eigen.eigenvalues().maxCoeff() ? 1 / value : 0;
  return eigen.eigenvectors() * inverse.asDiagonal() * eigen.eigenvectors().transpose();
}

TriangleMesh small_lump() { return with_radius(sphere(2), lump); }

}  // namespace

TEST_CASE("biharmonic and commute-time distances are those of the dense pseudo-inverse") {
  for (const TriangleMesh& mesh : {small_lump(), square(5, 0.3)}) {
    const Operators operators = make_operators(mesh);
    const Matrix L = operators.L;
    const Matrix bilaplacian = L * operators.mass.cwiseInverse().asDiagonal() * L;
    for (const bool biharmonic : {false, true}) {
      const Matrix G = pseudo_inverse(biharmonic ? bilaplacian : L);
      std::vector<int32_t> all;
      for (int32_t v = 0; v < mesh.vertex_count(); ++v) all.push_back(v);
      const RowMatrixf d =
          distance_named(biharmonic ? "biharmonic" : "commute-time", mesh)->distances(all, {});
      double largest = 0;
      for (int32_t x = 0; x < mesh.vertex_count(); ++x)
        for (int32_t y = 0; y < mesh.vertex_count(); ++y)
          largest = std::max(largest,
                             std::abs(d(x, y) - std::sqrt(std::max(G(x, x) + G(y, y) - 2 * G(x, y), 0.0))));
      CHECK(largest < 1e-4 * d.maxCoeff());
    }
  }
}

TEST_CASE("a source between vertices lies between them in the space of the Green's function") {
  const TriangleMesh mesh = small_lump();
  const Matrix G = pseudo_inverse(Matrix(make_operators(mesh).L));
  const std::vector<SurfacePoint> source = {{12, {0.2, 0.3, 0.5}}};
  const RowMatrixf d = distance_named("commute-time", mesh)->distances(source, {});
  Vector weight = Vector::Zero(mesh.vertex_count());
  for (int i = 0; i < 3; ++i) weight[mesh.triangles(12, i)] = source[0].barycentric[i];
  for (int32_t v = 0; v < mesh.vertex_count(); ++v) {
    Vector difference = -weight;
    difference[v] += 1;
    CHECK(d(0, v) == doctest::Approx(std::sqrt(difference.dot(G * difference))).epsilon(1e-3));
  }
}

TEST_CASE("sizes: a biharmonic distance grows with the mesh, a commute time does not") {
  TriangleMesh mesh = small_lump();
  const std::vector<int32_t> source = {3};
  const RowMatrixf b = distance_named("biharmonic", mesh)->distances(source, {}),
                   c = distance_named("commute-time", mesh)->distances(source, {});
  mesh.positions *= 10;
  CHECK(distance_named("biharmonic", mesh)->distances(source, {}).isApprox(10 * b, 1e-3f));
  CHECK(distance_named("commute-time", mesh)->distances(source, {}).isApprox(c, 1e-3f));
}

TEST_CASE("every distance of the list: 0 at its source, never negative, within its bound; names differ") {
  const TriangleMesh mesh = with_radius(sphere(3), lump);
  const std::vector<int32_t> sources = {0, 40, 200};
  std::set<std::string_view> names;
  for (const DistanceKind& kind : distance_kinds()) {
    CAPTURE(kind.name);
    CHECK(names.insert(kind.name).second);
    const auto distance = distance_named(kind.name, mesh);
    CHECK(distance->vertex_count() == mesh.vertex_count());
    const RowMatrixf d = distance->distances(sources, {});
    CHECK(d.minCoeff() >= 0);
    CHECK(d.maxCoeff() <= distance->distance_bound());
    CHECK(d.maxCoeff() > 0.2 * distance->distance_bound());
    for (size_t s = 0; s < sources.size(); ++s) CHECK(d(s, sources[s]) < 0.02 * d.maxCoeff());
  }
}
