// Maps between poses of one body, whose vertices are known to correspond.
#include "correspondence/dense_map.h"

#include <doctest/doctest.h>

#include "base/error.h"
#include "skeleton/small_rig.h"

using namespace focal;
using namespace focal_test;

namespace {

struct Pair {
  creatures::Character body = humanoid(21);
  std::shared_ptr<const PreparedMesh> rest = mesh_of(body.rest.positions, body),
                                      posed = mesh_of(body.posed, body);
  Detection at_rest = detect(rig_model(), rest, {}, execution),
            in_pose = detect(rig_model(), posed, {}, execution);
};

const Pair& pair() {
  static const Pair one;
  return one;
}

// Mean over the vertices, of sqrt(area).
double mean_error(const DenseMap& map, const PreparedMesh& to) {
  double sum = 0;
  for (size_t v = 0; v < map.point.size(); ++v)
    sum += (position_of(to.source, map.point[v]) -
            to.source.positions.row(static_cast<Eigen::Index>(v)).transpose())
               .norm();
  return sum / static_cast<double>(map.point.size()) / to.scale;
}

}  // namespace

TEST_CASE("a mesh maps to itself, and to another pose of its body") {
  CHECK(mean_error(dense_map(pair().at_rest, pair().at_rest, execution), *pair().rest) < 0.005);
  const DenseMap map = dense_map(pair().at_rest, pair().in_pose, execution);
  CHECK(mean_error(map, *pair().posed) < 0.04);  // the mean distance of two random points is about 1
  for (const SurfacePoint& point : map.point) {
    CHECK(point.triangle >= 0);
    CHECK(point.barycentric.minCoeff() >= -1e-9);
    CHECK(point.barycentric.sum() == doctest::Approx(1));
  }
}

TEST_CASE("values are carried over along the map") {
  const DenseMap map = dense_map(pair().at_rest, pair().in_pose, execution);
  const Eigen::Index n = pair().posed->source.vertex_count();
  RowMatrixf values(n, 2);
  values.col(0).setConstant(3);
  values.col(1) = pair().rest->source.positions.col(1).cast<float>();  // height at rest, of the same vertices
  const RowMatrixf carried = pulled_back(map, *pair().posed, values);
  CHECK((carried.col(0).array() - 3).abs().maxCoeff() < 1e-4);
  const float off = (carried.col(1) - values.col(1)).cwiseAbs().mean();
  CHECK(off < 0.05 * (values.col(1).maxCoeff() - values.col(1).minCoeff()));
}

TEST_CASE("the same bits for one thread and two") {
  Execution one;
  one.thread_count = 1;
  const DenseMap a = dense_map(pair().at_rest, pair().in_pose, one),
                 b = dense_map(pair().at_rest, pair().in_pose, execution);
  bool same = true;
  for (size_t v = 0; v < a.point.size(); ++v)
    same = same && a.point[v].triangle == b.point[v].triangle &&
           a.point[v].barycentric == b.point[v].barycentric;
  CHECK(same);
}

TEST_CASE("detections that no map can start from are refused") {
  Detection bare = pair().at_rest;
  bare.analysis = nullptr;
  CHECK_THROWS_AS(dense_map(bare, pair().in_pose, execution), Error);
  Detection lost = pair().at_rest;
  for (SurfacePoint& place : lost.places) place.triangle = -1;
  CHECK_THROWS_AS(dense_map(lost, pair().in_pose, execution), Error);
  Detection other = pair().at_rest;
  other.model = std::make_shared<const LandmarkModel>(*other.model);
  CHECK_THROWS_AS(dense_map(other, pair().in_pose, execution), Error);
}
