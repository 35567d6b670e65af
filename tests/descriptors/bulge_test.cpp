// How a surface bulges: by hand on a sphere and a plane, and the same however a body stands.
#include "descriptors/bulge.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "operators/operators.h"
#include "surfaces.h"

using namespace focal;
using namespace focal_test;

namespace {

TriangleMesh of_area_one(TriangleMesh mesh) {
  mesh.positions /= std::sqrt(surface_area(mesh));
  return mesh;
}

RowMatrixf bulge_of(const TriangleMesh& mesh, const Execution& execution = {}) {
  return bulge(mesh, area_normals(mesh).rowwise().normalized(), make_operators(mesh).mass, execution);
}

}  // namespace

TEST_CASE("bulge: of a sphere -r / 4R at every point, of its inside the opposite") {
  // By Archimedes the area of a cap is even in height: x within r of p lies on average r^2 / 4R below the tangent plane.
  TriangleMesh mesh = of_area_one(sphere(5));
  const double sphere_radius = 1 / std::sqrt(4 * std::numbers::pi);
  const RowMatrixf outside = bulge_of(mesh);
  mesh.triangles.col(1).swap(mesh.triangles.col(2));
  const RowMatrixf inside = bulge_of(mesh);
  for (size_t r = 0; r < bulge_radii.size(); ++r) {
    const double truth = -bulge_radii[r] / (4 * sphere_radius);
    const Eigen::VectorXf column = outside.col(static_cast<Eigen::Index>(r));
    CAPTURE(bulge_radii[r]);
    CHECK(column.mean() == doctest::Approx(truth).epsilon(0.02));
    const double scatter = r == 0 ? 0.4 : 0.2;  // a dozen points lie within the least radius
    CHECK((column.array() - static_cast<float>(truth)).abs().maxCoeff() < scatter * std::abs(truth));
    CHECK(column.isApprox(-inside.col(static_cast<Eigen::Index>(r)), 1e-5F));
  }
}

TEST_CASE("bulge: of a plane 0, and of the far side of a thin plate too") {
  const TriangleMesh flat = of_area_one(square(30, 0.3));
  CHECK(bulge_of(flat).cwiseAbs().maxCoeff() < 1e-6F);
  // Two sheets back to back, 0.02 apart: those on the other side face away and do not count.
  TriangleMesh plate = square(20);
  const int32_t n = plate.vertex_count(), m = plate.triangle_count();
  plate.positions.conservativeResize(2 * n, 3), plate.triangles.conservativeResize(2 * m, 3);
  plate.positions.bottomRows(n) = plate.positions.topRows(n).rowwise() - Eigen::RowVector3d(0, 0, 0.02);
  plate.triangles.bottomRows(m) = plate.triangles.topRows(m).array() + n;
  plate.triangles.bottomRows(m).col(1).swap(plate.triangles.bottomRows(m).col(2));
  CHECK(bulge_of(of_area_one(plate)).cwiseAbs().maxCoeff() < 1e-6F);
}

TEST_CASE("bulge: the same for a body that is turned, moved or mirrored, and different from point to point") {
  TriangleMesh mesh = of_area_one(with_radius(sphere(4), lump));
  const RowMatrixf before = bulge_of(mesh);
  CHECK(before.cwiseAbs().maxCoeff() < 1);
  for (Eigen::Index r = 0; r < before.cols(); ++r)
    CHECK(before.col(r).maxCoeff() - before.col(r).minCoeff() > 0.05F);
  // A point at a radius may fall on its other side by a rounding: hardly any do.
  const auto check_same = [&](const RowMatrixf& other) {
    const auto off = (before - other).cwiseAbs().rowwise().maxCoeff().eval();
    CHECK((off.array() > 1e-4F).count() < 0.01 * static_cast<double>(off.size()));
  };
  TriangleMesh mirrored = mesh;
  mirrored.positions.col(0) *= -1;
  mirrored.triangles.col(1).swap(mirrored.triangles.col(2));
  check_same(bulge_of(mirrored));
  Random random(5);
  mesh.positions =
      ((mesh.positions * random_rotation(random)).rowwise() + Eigen::RowVector3d(3, -8, 1)).eval();
  check_same(bulge_of(mesh));
}

TEST_CASE("bulge: a finer mesh of the same shape says nearly the same, by every few of its vertices") {
  const TriangleMesh coarse = of_area_one(with_radius(sphere(4), lump)),
                     fine = of_area_one(with_radius(sphere(6), lump));
  const RowMatrixf few = bulge_of(coarse),
                   many = bulge_of(fine);  // the vertices of sphere(4) come first in sphere(6)
  for (Eigen::Index r = 1; r < few.cols(); ++r) {
    const Eigen::VectorXf a = few.col(r).array() - few.col(r).mean();
    const Eigen::VectorXf b = many.col(r).head(few.rows()).array() - many.col(r).head(few.rows()).mean();
    CHECK(a.dot(b) / (a.norm() * b.norm()) > 0.95F);
  }
}

TEST_CASE("bulge: the same bits for any number of threads") {
  const TriangleMesh mesh = of_area_one(with_radius(sphere(5), lump));
  Execution four;
  four.thread_count = 4;
  CHECK(bulge_of(mesh) == bulge_of(mesh, four));
}
