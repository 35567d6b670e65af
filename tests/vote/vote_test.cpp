// Votes by formula on single samples, and their peak where exact distances say it must be.
#include "vote/vote.h"

#include <doctest/doctest.h>

#include <cmath>

#include "geodesics/heat_method.h"
#include "surfaces.h"

using namespace focal;
using namespace focal_test;

namespace {

constexpr int32_t lanes = 32;

// Euclid's distances, which on the square are the geodesic ones, in the blocks' layout: [vertex][sample].
std::vector<float> plane_distances(const TriangleMesh& mesh, std::span<const int32_t> samples) {
  std::vector<float> distances(static_cast<size_t>(mesh.vertex_count()) * lanes, 1e9F);
  for (int32_t v = 0; v < mesh.vertex_count(); ++v)
    for (size_t j = 0; j < samples.size(); ++j)
      distances[v * lanes + j] =
          static_cast<float>((mesh.positions.row(v) - mesh.positions.row(samples[j])).norm());
  return distances;
}

int32_t highest(const RowMatrixf& votes, int32_t landmark) {
  Eigen::Index best = 0;
  votes.col(landmark).maxCoeff(&best);
  return static_cast<int32_t>(best);
}

}  // namespace

TEST_CASE("an isoline votes for both ends of the edges it crosses, with weight exp(-mu d^2)") {
  // A path 0 - 1 - 2 - 3 at distances 0.1, 0.3, 0.5, 0.7 from the only sample.
  Eigen::Matrix<int32_t, Eigen::Dynamic, 2, Eigen::RowMajor> edges(3, 2);
  edges << 0, 1, 1, 2, 2, 3;
  std::vector<float> distances(4 * lanes, 0);
  for (int v = 0; v < 4; ++v) distances[v * lanes] = 0.1F + 0.2F * static_cast<float>(v);
  RowMatrixf radii(1, 2), votes = RowMatrixf::Zero(4, 2);
  radii << 0.4F, 0.8F;  // landmark 0: crosses the middle edge; landmark 1: beyond all
  add_isoline_votes(radii, distances.data(), 1, edges, 5, votes);
  const float weight = std::exp(-5 * 0.4F * 0.4F);
  CHECK(votes(0, 0) == 0);
  CHECK(votes(1, 0) == doctest::Approx(weight));
  CHECK(votes(2, 0) == doctest::Approx(weight));
  CHECK(votes(3, 0) == 0);
  CHECK(votes.col(1).isZero());
}

TEST_CASE("a distribution votes its value at each vertex' own distance") {
  VoteTables tables{.bins = 4, .landmarks = 2, .bin_width = 0.25, .weight = {}};
  for (const float bin_value : {1.0F, 3.0F, 5.0F, 7.0F}) {  // linear in the distance: 8 d, and its negative
    tables.weight.push_back(bin_value);
    tables.weight.push_back(-bin_value);
  }
  const float at[] = {0.2F, 0.5F, 0.6F, 0.875F, 3.0F, 0.0F};
  std::vector<float> distances(6 * lanes, 0);
  for (int v = 0; v < 6; ++v) distances[v * lanes] = at[v];
  RowMatrixf votes = RowMatrixf::Constant(6, 2, 10);
  add_distribution_votes(tables, distances.data(), 1, votes, {});
  for (int v = 0; v < 4; ++v) {
    CHECK(votes(v, 0) == doctest::Approx(10 + 8 * at[v]));
    CHECK(votes(v, 1) == doctest::Approx(10 - 8 * at[v]));
  }
  CHECK(votes(4, 0) == doctest::Approx(17));  // beyond the last centre and before the first: their values
  CHECK(votes(5, 0) == doctest::Approx(11));
}

TEST_CASE("with exact distances both kinds of vote peak at the true place") {
  const int half = 20;
  const TriangleMesh mesh = square(half, 0.2);
  const auto edges = edges_of(mesh);
  Random random(3);
  const auto samples = sample_without_replacement(random, mesh.vertex_count(), lanes);
  const auto distances = plane_distances(mesh, samples);
  for (const int32_t landmark : {mesh.vertex_count() / 2, 5 * 41 + 30, 33 * 41 + 7}) {
    RowMatrixf radii(lanes, 1), isoline = RowMatrixf::Zero(mesh.vertex_count(), 1), soft = isoline;
    VoteTables tables{.bins = 240, .landmarks = 1, .bin_width = 0.0125, .weight = {}};
    for (int32_t j = 0; j < lanes; ++j) {
      const float truth = radii(j, 0) = distances[landmark * lanes + j];
      for (int32_t b = 0; b < tables.bins; ++b)
        tables.weight.push_back(
            static_cast<float>(std::exp(-0.5 * std::pow(((b + 0.5) * tables.bin_width - truth) / 0.024, 2))));
    }
    add_isoline_votes(radii, distances.data(), lanes, edges, 5, isoline);
    add_distribution_votes(tables, distances.data(), lanes, soft, {});
    const auto error = [&](const RowMatrixf& votes) {
      return (mesh.positions.row(highest(votes, 0)) - mesh.positions.row(landmark)).norm();
    };
    CHECK(error(isoline) < 1.5 / half);  // isolines name edges: the place or its neighbour
    CHECK(highest(soft, 0) == landmark);
  }
}

TEST_CASE("the same votes for any number of threads") {
  const TriangleMesh mesh = square(20);
  const std::vector<int32_t> samples = {1, 50, 600, 900};
  const auto distances = plane_distances(mesh, samples);
  VoteTables tables{.bins = 100, .landmarks = 5, .bin_width = 0.03, .weight = {}};
  Random random(2);
  for (int i = 0; i < 4 * 100 * 5; ++i) tables.weight.push_back(static_cast<float>(random.uniform()));
  Execution one, two;
  one.thread_count = 1, two.thread_count = 2;
  RowMatrixf a = RowMatrixf::Zero(mesh.vertex_count(), 5), b = a;
  add_distribution_votes(tables, distances.data(), 4, a, one);
  add_distribution_votes(tables, distances.data(), 4, b, two);
  CHECK(a == b);
  CHECK(a.minCoeff() > 0);
}
