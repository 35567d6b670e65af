// Linear blend skinning and the choice of the heaviest influences.
#include "mesh/rig.h"

#include <doctest/doctest.h>

#include <Eigen/Geometry>

using namespace focal;

TEST_CASE("the heaviest four influences stay, of one joint added up, and sum to 1") {
  const std::vector<Influence> many = {{5, 0.1F}, {2, 0.2F},  {5, 0.25F}, {1, 0.05F},
                                       {7, 0.3F}, {8, 0.06F}, {9, -1}};
  const VertexInfluences kept = heaviest(many);
  CHECK(kept[0].joint == 5);
  CHECK(kept[1].joint == 7);
  CHECK(kept[2].joint == 2);
  CHECK(kept[3].joint == 8);
  CHECK(kept[0].weight + kept[1].weight + kept[2].weight + kept[3].weight == doctest::Approx(1));
  CHECK(kept[0].weight / kept[1].weight == doctest::Approx(0.35 / 0.3));
  CHECK(heaviest({})[0].weight == 0);
}

TEST_CASE("one rigid motion for all joints moves a mesh rigidly, whatever the weights") {
  MatrixX3 positions(3, 3);
  positions << 1, 2, 3, -1, 0.5, 2, 0, 0, 1;
  Matrix4 motion = Matrix4::Identity();
  motion.topLeftCorner<3, 3>() = Eigen::AngleAxisd(0.7, Vector3(1, 1, 0).normalized()).toRotationMatrix();
  motion.topRightCorner<3, 1>() << 4, 5, 6;
  const std::vector<VertexInfluences> influences = {{{{0, 1}}}, {{{0, 0.5F}, {1, 0.5F}}}, {}};
  const MatrixX3 moved = skinned(positions, influences, {motion, motion});
  for (int v = 0; v < 2; ++v)
    CHECK(
        (moved.row(v).transpose() - (motion * positions.row(v).transpose().homogeneous()).head<3>()).norm() <
        1e-12);
  CHECK(moved.row(2) == positions.row(2));  // no joint moves it
}

TEST_CASE("a vertex between two joints lies between where each takes it") {
  Matrix4 up = Matrix4::Identity();
  up(1, 3) = 2;
  const MatrixX3 moved =
      skinned(MatrixX3::Zero(1, 3), {{{{0, 0.75F}, {1, 0.25F}}}}, {Matrix4::Identity(), up});
  CHECK((moved.row(0) - Eigen::RowVector3d(0, 0.5, 0)).norm() < 1e-12);
}
