// Fitted rotations and similarities are the true ones.
#include "mesh/similarity.h"

#include <doctest/doctest.h>

#include "base/random.h"
#include "surfaces.h"

using namespace focal;
using focal_test::random_rotation;

namespace {

MatrixX3 random_points(int count, Random& random) {
  MatrixX3 points(count, 3);
  for (double& x : points.reshaped()) x = random.normal();
  return points;
}

}  // namespace

TEST_CASE("a similarity is found again, and points of weight 0 have no say") {
  Random random(3);
  for (int trial = 0; trial < 20; ++trial) {
    const MatrixX3 from = random_points(12, random);
    const Matrix3 rotation = random_rotation(random);
    const double scale = 0.1 + random.uniform();
    const Vector3 offset(random.normal(), 5, -2);
    MatrixX3 to = (scale * from * rotation.transpose()).rowwise() + offset.transpose();
    to.row(11).setConstant(100);
    Vector weight = Vector::Ones(12);
    weight[11] = 0, weight[3] = 7;
    const Similarity fit = fit_similarity(from, to, weight);
    CHECK(fit.scale == doctest::Approx(scale));
    CHECK((fit.rotation - rotation).norm() < 1e-9);
    CHECK((fit.offset - offset).norm() < 1e-9);
    CHECK(fit.residual < 1e-9);
    CHECK((fit(from.row(2).transpose()) - to.row(2).transpose()).norm() < 1e-9);
  }
}

TEST_CASE("a mirror image is never fitted by a mirror") {
  Random random(4);
  const MatrixX3 from = random_points(30, random);
  MatrixX3 to = from;
  to.col(0) *= -1;
  const Similarity fit = fit_similarity(from, to, Vector::Ones(30));
  CHECK(fit.rotation.determinant() == doctest::Approx(1));
  CHECK(fit.residual > 0.1);
}

TEST_CASE("the nearest rotation of a scaled one is itself; of nothing, none") {
  Random random(5);
  const Matrix3 rotation = random_rotation(random);
  CHECK((nearest_rotation(3.5 * rotation) - rotation).norm() < 1e-12);
  CHECK(nearest_rotation(Matrix3::Zero()) == Matrix3::Identity());
  CHECK(nearest_rotation(Matrix3::Constant(NAN)) == Matrix3::Identity());
}
