// Training shapes laid over a body: each covers itself best, puts its marks where they are, and lies farther off when turned round.
#include "landmarks/shape_starts.h"

#include <doctest/doctest.h>

#include "skeleton/small_rig.h"

using namespace focal;
using namespace focal_test;

namespace {

// On the surface that the proxy stands for, whose area is 1 too.
Vector3 on_full(const Proxy& proxy, const SurfacePoint& point) {
  return proxy.coarse->centre + proxy.coarse->scale * position_of(proxy.coarse->surface, point);
}

Matrix3 half_turn() { return Vector3(-1, 1, -1).asDiagonal(); }

}  // namespace

TEST_CASE("a training shape covers itself best and puts its marks where they are") {
  const auto model = rig_model();
  REQUIRE(can_be_laid_over(*model));
  const TrainingSet set = training_set_of({rigged(humanoid(1))}, {.shapes = 8, .landmarks = 40});
  for (const size_t shape : {0, 3}) {
    const auto& mesh = set.shapes[shape].mesh;
    const SurfaceAnalysis analysis = analyse_surface(mesh, analysis_params_of(model->params), execution);
    const ShapeStarts over = lay_shapes_over(*model, analysis, Matrix3::Identity(), 8, 1, execution);
    REQUIRE(over.exemplars.size() == 8);
    REQUIRE(over.places.size() == 1);
    CHECK(over.exemplars[0] == static_cast<int32_t>(shape));
    CHECK(over.apart < 0.06);  // of sqrt(area): points of either lie this far from those of the other
    double away = 0;
    for (size_t l = 0; l < set.landmark_names.size(); ++l)
      away += (on_full(analysis.proxy, over.places[0][l]) -
               position_of(mesh->surface, *set.shapes[shape].marks[l]))
                  .norm();
    CHECK(away / static_cast<double>(set.landmark_names.size()) < 0.04);
  }
}

TEST_CASE("a shape lies nearer the right way round, wherever the body faces") {
  const auto model = rig_model();
  creatures::Character body = humanoid(11);
  const auto apart = [&](const Matrix3& frame) {
    const SurfaceAnalysis analysis =
        analyse_surface(mesh_of(body.rest.positions, body), analysis_params_of(model->params), execution);
    return lay_shapes_over(*model, analysis, frame, 1, 1, execution).apart;
  };
  const double right = apart(Matrix3::Identity());
  CHECK(apart(half_turn()) > 1.02 * right);
  for (creatures::Vec3& position : body.rest.positions) position = half_turn() * position;
  CHECK(apart(half_turn()) == doctest::Approx(right).epsilon(0.05));
}
