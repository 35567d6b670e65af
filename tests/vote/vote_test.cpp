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

// One block of samples as 16-bit numbers; `largest` is 65535.
struct Quantised {
  std::vector<uint16_t> steps;
  QuantisedDistances view;
  Quantised(const std::vector<float>& distances, double largest) {
    for (const float d : distances)
      steps.push_back(static_cast<uint16_t>(std::lround(std::min(d / largest, 1.0) * 65535)));
    view = {steps.data(), largest / 65535, static_cast<int32_t>(distances.size()) / lanes};
  }
};

VoteTables tables_of(int32_t rows, int32_t landmarks, double width, int32_t samples) {
  VoteTables tables;
  tables.rows = rows, tables.landmarks = landmarks, tables.width = width;
  tables.weight.assign(static_cast<size_t>(samples) * rows * tables.stride(), 0);
  return tables;
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
  VoteTables tables = tables_of(4, 2, 0.25, 1);
  for (int32_t r = 0; r < 4; ++r) {  // linear in the distance: 8 d, and its negative
    tables.of(0)[r * tables.stride()] = 2 * static_cast<float>(r);
    tables.of(0)[r * tables.stride() + 1] = -2 * static_cast<float>(r);
  }
  const float at[] = {0.2F, 0.5F, 0.6F, 0.7F, 3.0F, 0.0F};
  std::vector<float> distances(6 * lanes, 0);
  for (int v = 0; v < 6; ++v) distances[v * lanes] = at[v];
  RowMatrixf votes = RowMatrixf::Constant(6, tables.stride(), 10);
  add_distribution_votes(tables, 1, Quantised(distances, 4).view, 0, votes, {});
  for (int v = 0; v < 4; ++v) {
    CHECK(votes(v, 0) == doctest::Approx(10 + 8 * at[v]).epsilon(1e-4));
    CHECK(votes(v, 1) == doctest::Approx(10 - 8 * at[v]).epsilon(1e-4));
  }
  CHECK(votes(4, 0) == doctest::Approx(16));  // beyond the last row: its value
  CHECK(votes(5, 0) == doctest::Approx(10));
  CHECK(votes.rightCols(tables.stride() - 2).isApproxToConstant(10));
}

TEST_CASE("with exact distances both kinds of vote peak at the true place") {
  const int half = 20;
  const TriangleMesh mesh = square(half, 0.2);
  const auto edges = edges_of(mesh);
  Random random(3);
  const auto samples = sample_without_replacement(random, mesh.vertex_count(), lanes);
  const auto distances = plane_distances(mesh, samples);
  for (const int32_t landmark : {mesh.vertex_count() / 2, 5 * 41 + 30, 33 * 41 + 7}) {
    VoteTables tables = tables_of(240, 1, 0.0125, lanes);
    RowMatrixf radii(lanes, 1), isoline = RowMatrixf::Zero(mesh.vertex_count(), 1),
                                soft = RowMatrixf::Zero(mesh.vertex_count(), tables.stride());
    for (int32_t j = 0; j < lanes; ++j) {
      const float truth = radii(j, 0) = distances[landmark * lanes + j];
      for (int32_t r = 0; r < tables.rows; ++r)
        tables.of(j)[r * tables.stride()] =
            static_cast<float>(std::exp(-0.5 * std::pow((r * tables.width - truth) / 0.024, 2)));
    }
    add_isoline_votes(radii, distances.data(), lanes, edges, 5, isoline);
    add_distribution_votes(tables, lanes, Quantised(distances, 4).view, 0, soft, {});
    const auto error = [&](const RowMatrixf& votes) {
      return (mesh.positions.row(highest(votes, 0)) - mesh.positions.row(landmark)).norm();
    };
    CHECK(error(isoline) < 1.5 / half);  // isolines name edges: the place or its neighbour
    CHECK(highest(soft, 0) == landmark);
  }
}

TEST_CASE("the same votes for any number of threads and any cut of the samples") {
  const TriangleMesh mesh = square(20);
  const std::vector<int32_t> samples = {1, 50, 600, 900, 3, 77, 1200, 1300, 5, 15, 25};
  const auto distances = plane_distances(mesh, samples);
  const auto count = static_cast<int32_t>(samples.size());
  VoteTables tables = tables_of(100, 45, 0.03, count);  // 48 with padding: vectors of every kind
  Random random(2);
  for (float& weight : tables.weight) weight = static_cast<float>(random.uniform());
  Execution one, two;
  one.thread_count = 1, two.thread_count = 2;
  RowMatrixf a = RowMatrixf::Zero(mesh.vertex_count(), tables.stride()), b = a, plain = a;
  const Quantised quantised(distances, 5);
  add_distribution_votes(tables, count, quantised.view, 0, a, one);
  add_distribution_votes(tables, count, quantised.view, 0, b, two);
  CHECK(a == b);
  for (int32_t v = 0; v < mesh.vertex_count(); ++v)
    for (int32_t j = 0; j < count; ++j) {
      const double at = distances[v * lanes + j] / tables.width;
      const auto row = std::min(static_cast<int32_t>(at), tables.rows - 2);
      const auto fraction = static_cast<float>(std::min(at - row, 1.0));
      for (int32_t l = 0; l < tables.stride(); ++l) {
        const float *low = tables.of(j) + row * tables.stride() + l, *high = low + tables.stride();
        plain(v, l) += *low + fraction * (*high - *low);
      }
    }
  CHECK((a - plain).cwiseAbs().maxCoeff() < 0.05F);  // eleven distances, each rounded to 1/400 of a row
}
