// The joint choice finds a planted configuration among impostors, and distinguishes it from its mirror image.
#include "constellation/constellation.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numeric>

#include "geodesics/heat_method.h"
#include "mesh/prepare.h"
#include "surfaces.h"

using namespace focal;
using namespace focal_test;

namespace {

constexpr double disc = 0.2;

// Distances between, and ways from and to, some vertices of a shape.
struct Relations {
  RowMatrixf distance;
  TangentDirections directions;
};

Relations relations_of(const TriangleMesh& mesh, const std::vector<int32_t>& vertices) {
  const RowMatrixf fields = HeatMethod(mesh, make_operators(mesh)).distances(vertices, {});
  std::vector<SurfacePoint> points;
  for (const int32_t v : vertices) points.push_back(at_vertex(mesh, v));
  Relations result{RowMatrixf(vertices.size(), vertices.size()),
                   tangent_directions(mesh, points, fields, disc, {})};
  for (size_t a = 0; a < vertices.size(); ++a)
    for (size_t b = 0; b < vertices.size(); ++b)
      result.distance(a, b) = (fields(a, vertices[b]) + fields(b, vertices[a])) / 2;
  return result;
}

// The same body with other proportions: each shape stretched a little along the axes.
TriangleMesh individual(const std::function<double(const Vector3&)>& radius, uint64_t seed) {
  Random random(seed, 3);
  TriangleMesh mesh = with_radius(sphere(4), radius);
  for (int axis = 0; axis < 3; ++axis) mesh.positions.col(axis) *= 1 + 0.06 * random.normal();
  mesh.positions /= std::sqrt(surface_area(mesh));
  return mesh;
}

ConstellationStatistics learn_from(const std::function<double(const Vector3&)>& radius,
                                   const std::vector<int32_t>& marks) {
  std::vector<ConstellationSample> samples;
  for (uint64_t seed = 1; seed <= 6; ++seed) {
    const Relations relations = relations_of(individual(radius, seed), marks);
    samples.push_back({std::vector<char>(marks.size(), 1), relations.distance, relations.directions});
  }
  return learn_constellation(samples, static_cast<int32_t>(marks.size()));
}

ConstellationCandidates candidates_on(const TriangleMesh& mesh,
                                      const std::vector<std::vector<int32_t>>& options,
                                      const std::vector<float>& unary) {
  ConstellationCandidates candidates;
  std::vector<int32_t> vertices;
  for (const auto& places : options) {
    candidates.start.push_back(static_cast<int32_t>(vertices.size()));
    vertices.insert(vertices.end(), places.begin(), places.end());
  }
  candidates.start.push_back(static_cast<int32_t>(vertices.size()));
  candidates.unary = unary;
  Relations relations = relations_of(mesh, vertices);
  candidates.distance = std::move(relations.distance);
  candidates.directions = std::move(relations.directions);
  return candidates;
}

int32_t mirror_vertex(const TriangleMesh& mesh, int32_t v) {
  const Eigen::RowVector3d image = mesh.positions.row(v).cwiseProduct(Eigen::RowVector3d(-1, 1, 1));
  Eigen::Index twin = 0;
  (mesh.positions.rowwise() - image).rowwise().squaredNorm().minCoeff(&twin);
  return static_cast<int32_t>(twin);
}

// Three marks on one side of the mirror_lump, each followed by its twin on the other.
struct MirrorPairs {
  std::vector<int32_t> marks, twins;
};
MirrorPairs mirror_pairs() {
  const TriangleMesh body = with_radius(sphere(4), mirror_lump);
  MirrorPairs pairs;
  for (int32_t v = 90; pairs.marks.size() < 6; v += 210) {
    while (body.positions(v, 0) < 0.3) ++v;
    const int32_t twin = mirror_vertex(body, v);
    pairs.marks.insert(pairs.marks.end(), {v, twin});
    pairs.twins.insert(pairs.twins.end(), {twin, v});
  }
  return pairs;
}

}  // namespace

TEST_CASE("the true configuration wins over impostors with better votes") {
  const std::vector<int32_t> marks = {10, 137, 288, 402, 555, 640, 790, 911};
  const ConstellationStatistics statistics = learn_from(lump, marks);
  const TriangleMesh unseen = individual(lump, 100);
  Random random(5);
  std::vector<std::vector<int32_t>> options;
  std::vector<float> unary;
  for (size_t l = 0; l < marks.size(); ++l) {
    options.push_back(sample_without_replacement(random, unseen.vertex_count(), 7));
    options.back().insert(options.back().begin() + 3, marks[l]);  // the fourth by its votes
    for (int k = 0; k < 8; ++k) unary.push_back(0.08F * static_cast<float>(k));
  }
  const auto candidates = candidates_on(unseen, options, unary);
  const ConstellationChoice choice = choose_constellations(statistics, candidates, {}, {}).front();
  for (size_t l = 0; l < marks.size(); ++l) {
    CHECK(choice.candidate[l] == candidates.start[l] + 3);
    CHECK(choice.residual[l] < 4);
  }
}

TEST_CASE("of two mirror images with equal votes and distances, the right-handed one wins") {
  auto [marks, twins] = mirror_pairs();
  for (const int32_t v : {4, 5}) marks.push_back(v), twins.push_back(v);  // both poles lie on x = 0
  const ConstellationStatistics statistics = learn_from(mirror_lump, marks);
  for (const bool mirrored : {false, true}) {
    TriangleMesh unseen = individual(mirror_lump, 50);
    if (mirrored) {  // the same surface seen in a mirror: now the twins are the truth
      unseen.positions.col(0) *= -1;
      unseen.triangles.col(1).swap(unseen.triangles.col(2));
    }
    std::vector<std::vector<int32_t>> options;
    for (size_t l = 0; l < marks.size(); ++l) options.push_back({marks[l], twins[l]});
    const auto candidates = candidates_on(unseen, options, std::vector<float>(2 * marks.size(), 0));
    const ConstellationChoice choice = choose_constellations(statistics, candidates, {}, {}).front();
    for (size_t l = 0; l < 6; ++l) CHECK(choice.candidate[l] == candidates.start[l] + (mirrored ? 1 : 0));
  }
}

TEST_CASE("a landmark without a candidate is left out, and marks never seen together say nothing") {
  const std::vector<int32_t> marks = {10, 137, 288, 402};
  std::vector<ConstellationSample> samples;
  for (uint64_t seed = 1; seed <= 4; ++seed) {
    const Relations relations = relations_of(individual(lump, seed), marks);
    std::vector<char> present = {1, 1, seed % 2 == 0, seed % 2 == 1};  // 2 and 3 never on one shape
    samples.push_back({present, relations.distance, relations.directions});
  }
  const ConstellationStatistics statistics = learn_constellation(samples, 4);
  CHECK(statistics.distance_sd(0, 1) < 1);
  CHECK(statistics.distance_sd(2, 3) > 100);
  CHECK(statistics.distance_mean == statistics.distance_mean.transpose());
  const auto candidates = candidates_on(individual(lump, 9), {{10}, {}, {500, 288}, {402}}, {0, 0, 0, 0});
  const ConstellationChoice choice = choose_constellations(statistics, candidates, {}, {}).front();
  CHECK(choice.candidate == std::vector<int32_t>{0, -1, 2, 3});
}

TEST_CASE("a landmark that suits the others nowhere is left out, and does not pull them") {
  const std::vector<int32_t> marks = {10, 137, 288, 402, 555, 640};
  const ConstellationStatistics statistics = learn_from(lump, marks);
  const TriangleMesh unseen = individual(lump, 100);
  std::vector<std::vector<int32_t>> options;
  for (const int32_t mark : marks) options.push_back({mark});
  options[2] = {640, 137};  // its own place has gone
  const auto candidates = candidates_on(unseen, options, std::vector<float>(marks.size() + 1, 0));
  const ConstellationChoice choice = choose_constellations(statistics, candidates, {}, {}).front();
  CHECK(choice.left_out == std::vector<char>{0, 0, 1, 0, 0, 0});
  CHECK(choice.candidate[2] >= 0);  // the best there is
  for (const size_t l : {0, 1, 3, 4, 5}) CHECK(choice.residual[l] < 3);
}

TEST_CASE("choices that come near the best one are given too, if they are others") {
  const MirrorPairs pairs = mirror_pairs();
  const auto &marks = pairs.marks, &twins = pairs.twins;
  const ConstellationStatistics statistics = learn_from(mirror_lump, marks);
  std::vector<std::vector<int32_t>> options;
  for (size_t l = 0; l < marks.size(); ++l) options.push_back({marks[l], twins[l]});
  const auto candidates =
      candidates_on(individual(mirror_lump, 50), options, std::vector<float>(2 * marks.size(), 0));
  ConstellationParams params;
  params.chirality_weight = 0;  // nothing distinguishes the two sides now
  const auto choices = choose_constellations(statistics, candidates, params, {});
  const auto differing = [&](size_t a, size_t b) {
    size_t count = 0;
    for (size_t l = 0; l < marks.size(); ++l) count += choices[a].candidate[l] != choices[b].candidate[l];
    return count;
  };
  bool has_mirror_image = false;
  for (size_t c = 1; c < choices.size(); ++c) {
    CHECK(differing(0, c) >= 2);
    CHECK(choices[c].energy >= choices[c - 1].energy);
    has_mirror_image = has_mirror_image || differing(0, c) == marks.size();
  }
  CHECK(has_mirror_image);
  params.max_choices = 1;
  CHECK(choose_constellations(statistics, candidates, params, {}).size() == 1);
}

TEST_CASE("the same choice and energy for any number of threads") {
  const std::vector<int32_t> marks = {10, 137, 288, 402, 555};
  const ConstellationStatistics statistics = learn_from(lump, marks);
  Random random(5);
  std::vector<std::vector<int32_t>> options;
  for (size_t l = 0; l < marks.size(); ++l) options.push_back(sample_without_replacement(random, 1026, 8));
  const auto candidates = candidates_on(individual(lump, 12), options, std::vector<float>(40, 0.5F));
  Execution one, two;
  one.thread_count = 1, two.thread_count = 2;
  const auto a = choose_constellations(statistics, candidates, {}, one).front();
  const auto b = choose_constellations(statistics, candidates, {}, two).front();
  CHECK(a.candidate == b.candidate);
  CHECK(a.energy == b.energy);
}
