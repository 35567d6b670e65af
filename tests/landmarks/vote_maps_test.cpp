// Vote maps on the full surface, and their colours.
#include "landmarks/vote_maps.h"

#include <doctest/doctest.h>

#include <memory>

#include "surfaces.h"

using namespace focal;
using namespace focal_test;

TEST_CASE("votes of a proxy are carried over to every vertex of the full surface") {
  Detection detection;
  detection.proxy = make_proxy(std::make_shared<const PreparedMesh>(prepare(sphere(5))), 600, {}, true);
  REQUIRE(!detection.proxy.is_full());
  const MatrixX3& coarse = detection.proxy.coarse->surface.positions;
  const MatrixX3& full = detection.proxy.full->surface.positions;
  // A vote that grows with the height, and its half: each landmark's largest is 1 again.
  const double coarse_radius = coarse.row(0).norm(), radius = full.row(0).norm();
  detection.votes.resize(2, coarse.rows());
  for (Eigen::Index v = 0; v < coarse.rows(); ++v) {
    detection.votes(0, v) = static_cast<float>((1 + coarse(v, 1) / coarse_radius) / 2);
    detection.votes(1, v) = detection.votes(0, v) / 2;
  }
  const RowMatrixf votes = full_votes(detection, {});
  REQUIRE(votes.cols() == full.rows());
  for (Eigen::Index l = 0; l < 2; ++l) {
    CHECK(votes.row(l).maxCoeff() == 1);
    for (Eigen::Index v = 0; v < full.rows(); ++v)
      CHECK(std::abs(votes(l, v) - (1 + full(v, 1) / radius) / 2) < 0.03);
  }
}

TEST_CASE("votes of a surface that is analysed as it is stay to the bit") {
  Detection detection;
  detection.proxy = make_proxy(std::make_shared<const PreparedMesh>(prepare(sphere(2))), 0);
  detection.votes = RowMatrixf::Random(3, detection.proxy.full->surface.vertex_count());
  CHECK(full_votes(detection, {}) == detection.votes);
}

TEST_CASE("a vertex has the hue of its strongest vote, and is grey without one") {
  RowMatrixf votes(2, 3);
  votes << 0, 1, 0.2f, 0, 0.5f, 2;
  const RowMatrixf colours = vote_colours(votes);
  CHECK(colours.row(0) == label_colour(-1));
  CHECK(colours.row(1) == label_colour(0));
  CHECK(colours.row(2) == label_colour(1));  // beyond 1 counts as 1
  CHECK(label_colour(0) == Eigen::RowVector3f(1, 0, 0));
  for (int32_t label = 0; label < 50; ++label) {
    CHECK(label_colour(label).minCoeff() == 0);
    CHECK(label_colour(label).maxCoeff() == 1);
    CHECK((label_colour(label) - label_colour(label + 1)).norm() > 0.5);
  }
}
