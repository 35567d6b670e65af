// Weights by bone heat on a bent tube, whose two arms nearly touch: what lies across the gap is another limb.
#include "skeleton/bone_heat.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "base/error.h"
#include "surfaces.h"

using namespace focal;
using namespace focal_test;

namespace {

constexpr double half_length = 6,
                 radius_of_bend = 1.15;  // of a tube of radius 1: a gap of 0.3 between its arms

// A point at x along the straight tube goes round a half circle in the middle.
Vector3 bent(const Vector3& p) {
  const double arc = std::numbers::pi * radius_of_bend / 2;  // of each half of the bend
  const double along = std::clamp(p.x(), -arc, arc), angle = along / radius_of_bend;
  const Vector3 out(std::sin(angle), std::cos(angle), 0), onward(std::cos(angle), -std::sin(angle), 0);
  return (radius_of_bend + p.y()) * out + (p.x() - along) * onward + Vector3(0, 0, p.z());
}

SurfaceAnalysis horseshoe() {
  TriangleMesh mesh = sphere(5);
  for (Eigen::Index v = 0; v < mesh.vertex_count(); ++v) {
    Vector3 p = mesh.positions.row(v);
    p.x() *= half_length;  // a long tube with round ends
    const double round = std::sqrt(std::max(1e-9, 1 - std::pow(std::abs(p.x()) / half_length, 6.0)));
    const double now = std::hypot(p.y(), p.z());
    if (now > 1e-9) p.y() *= round / now, p.z() *= round / now;
    mesh.positions.row(v) = bent(p);
  }
  return analyse_surface(std::make_shared<const PreparedMesh>(prepare(std::move(mesh))),
                         {.eigenpair_count = 16, .sampling_rate = 0.01}, {});
}

}  // namespace

TEST_CASE("heat of a bone stays on its own limb, weights sum to one and change smoothly") {
  const SurfaceAnalysis analysis = horseshoe();
  const TriangleMesh& mesh = analysis.surface();
  const PreparedMesh& prepared = *analysis.proxy.full;
  const auto surface = [&](const Vector3& p) {
    return Vector3((bent(p) - prepared.centre) / prepared.scale);
  };
  // A bone for each straight arm, and two for the bend.
  const double arc = std::numbers::pi * radius_of_bend / 2;
  const std::vector<Vector3> knots = {surface({-half_length + 0.5, 0, 0}), surface({-arc, 0, 0}),
                                      surface({0, 0, 0}), surface({arc, 0, 0}),
                                      surface({half_length - 0.5, 0, 0})};
  std::vector<Bone> bones;
  for (int32_t j = 0; j < 4; ++j) bones.push_back({j, knots[j], knots[j + 1]});
  const RowMatrixf weights = bone_heat_weights(analysis, RayCaster(mesh), bones, 4, {});
  REQUIRE(weights.rows() == mesh.vertex_count());
  CHECK((weights.rowwise().sum().array() - 1).abs().maxCoeff() < 1e-5);
  CHECK(weights.minCoeff() >= 0);
  double across = 0, largest_step = 0;
  int inner = 0;
  for (Eigen::Index v = 0; v < mesh.vertex_count(); ++v) {
    const Vector3 p = prepared.scale * Vector3(mesh.positions.row(v)) + prepared.centre;
    // On the inner side of an arm the other arm's skin is nearer than the own bone.
    if (p.y() > -1.5 || std::abs(p.x()) > 0.6) continue;
    ++inner;
    across = std::max<double>(across, p.x() < 0 ? weights(v, 3) : weights(v, 0));
    // Along a tube of radius 1 heat falls with exp(-x) from the half that both bones have where they meet, at y = 0.
    CHECK((p.x() < 0 ? weights(v, 0) : weights(v, 3)) > 1 - std::exp(p.y()));
  }
  CHECK(inner > 50);
  CHECK(across < 0.05);  // by distance through space it would be about a half
  for (Eigen::Index t = 0; t < mesh.triangles.rows(); ++t)
    for (int k = 0; k < 3; ++k) {
      const auto a = mesh.triangles(t, k), b = mesh.triangles(t, (k + 1) % 3);
      const double length = (mesh.positions.row(a) - mesh.positions.row(b)).norm() * prepared.scale;
      largest_step =
          std::max(largest_step,
                   static_cast<double>((weights.row(a) - weights.row(b)).cwiseAbs().maxCoeff()) / length);
    }
  CHECK(largest_step < 1.5);  // a weight falls from 1 to 0 over no less than two thirds of the tube's radius
}

TEST_CASE("one bone moves everything, none is refused") {
  const SurfaceAnalysis analysis = analyse_surface(std::make_shared<const PreparedMesh>(prepare(sphere(3))),
                                                   {.eigenpair_count = 16, .sampling_rate = 0.1}, {});
  const RayCaster rays(analysis.surface());
  const RowMatrixf weights =
      bone_heat_weights(analysis, rays, {{0, Vector3::Zero(), Vector3(0.1, 0, 0)}}, 1, {});
  CHECK((weights.array() - 1).abs().maxCoeff() < 1e-5);
  CHECK_THROWS_AS(bone_heat_weights(analysis, rays, {}, 1, {}), Error);
}
