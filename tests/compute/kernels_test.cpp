// The bodies of the kernels against the CPU's own code, on random and on hostile numbers.
#include "device/kernels.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/leaf_votes.h"
#include "base/random.h"
#include "compute/host_queue.h"
#include "device/votes.h"
#include "model/small_model.h"
#include "operators/operators.h"
#include "vote/peaks.h"
#include "vote/vote.h"

using namespace focal;
using namespace focal_test;

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity(),
                no_number = std::numeric_limits<float>::quiet_NaN();

// A tree of any shape: nodes split or end by chance.
RegressionTree random_tree(Random& random, int32_t components) {
  RegressionTree tree;
  int32_t leaves = 0;
  for (int32_t node = 0, nodes = 1; node < nodes; ++node) {
    const bool splits = nodes < 200 && random.uniform() < 0.7;
    tree.feature.push_back(splits ? static_cast<int32_t>(random.uniform() * components) : -1);
    tree.threshold.push_back(static_cast<float>(random.normal()));
    tree.child.push_back(splits ? nodes : leaves++);
    if (splits) nodes += 2;
  }
  return tree;
}

// |difference| / size, or infinity where only one is a number.
float apart(float a, float b) {
  if (std::isnan(a) || std::isnan(b)) return std::isnan(a) && std::isnan(b) ? 0 : infinity;
  return std::abs(a - b) / std::max(1.0f, std::abs(b));
}

}  // namespace

TEST_CASE("pseudo-random numbers fill their range") {
  double least = 1, most = -1, sum = 0;
  for (uint64_t i = 0; i < 100000; ++i) {
    const double x = random_entry(i);
    least = std::min(least, x), most = std::max(most, x), sum += x;
  }
  CHECK(least >= -0.5);
  CHECK(most < 0.5);
  CHECK(least < -0.4999);
  CHECK(most > 0.4999);
  CHECK(std::abs(sum / 100000) < 0.005);
}

TEST_CASE("samples reach the leaves that they reach on the CPU, infinite and missing numbers too") {
  Random random(5);
  constexpr int32_t components = 7;
  std::vector<int32_t> node_start = {0}, feature, child;
  std::vector<float> threshold;
  std::vector<RegressionTree> trees;
  for (int t = 0; t < 20; ++t) {
    const RegressionTree& tree = trees.emplace_back(random_tree(random, components));
    feature.insert(feature.end(), tree.feature.begin(), tree.feature.end());
    child.insert(child.end(), tree.child.begin(), tree.child.end());
    threshold.insert(threshold.end(), tree.threshold.begin(), tree.threshold.end());
    node_start.push_back(static_cast<int32_t>(feature.size()));
  }
  ForestTable table{};
  table.node_start = node_start.data(), table.feature = feature.data(), table.child = child.data();
  table.threshold = threshold.data();
  for (int sample = 0; sample < 500; ++sample) {
    float descriptor[components];
    for (float& value : descriptor) {
      value = static_cast<float>(random.normal());
      const double odd = random.uniform();
      if (odd < 0.05) value = no_number;
      if (odd > 0.95) value = random.uniform() < 0.5 ? infinity : -infinity;
      if (odd > 0.5 && odd < 0.55)
        value = threshold[static_cast<size_t>(random.uniform() * 50) % threshold.size()];
    }
    for (int32_t t = 0; t < 20; ++t)
      REQUIRE(leaf_of(table, t, descriptor) == trees[static_cast<size_t>(t)].leaf_of(descriptor));
  }
}

TEST_CASE("votes at any distance are the CPU's, far beyond the table and without a number too") {
  Random random(6);
  constexpr int32_t n = 40, count = 32, rows = 23, landmarks = 3, stride = 8;
  VoteTables tables;
  tables.rows = rows, tables.landmarks = landmarks, tables.width = 0.0125;
  tables.weight.resize(count * rows * stride);
  std::vector<float> dense(count * rows * landmarks);
  for (int32_t r = 0; r < count * rows; ++r)
    for (int32_t l = 0; l < landmarks; ++l)
      dense[static_cast<size_t>(r * landmarks + l)] = tables.weight[static_cast<size_t>(r * stride + l)] =
          static_cast<float>(random.uniform());
  std::vector<uint16_t> steps(n * count);
  const double step = 1e-5;
  std::vector<float> distance;
  for (uint16_t& s : steps) {
    s = static_cast<uint16_t>(random.uniform() < 0.1 ? 65535 : random.uniform() * 30000);
    if (random.uniform() < 0.1)
      s = static_cast<uint16_t>(1250 * static_cast<int>(random.uniform() * 23));  // on a row
    distance.push_back(static_cast<float>(s * step));
  }
  RowMatrixf expected = RowMatrixf::Zero(n, stride);
  add_distribution_votes(tables, count, {steps.data(), step, n}, 0, expected, {});
  std::vector<float> votes(n * landmarks);
  const VoteEntry entry{dense.data(), distance.data(), votes.data(), 80, rows, landmarks, count, count};
  for (int64_t i = 0; i < n * landmarks; ++i) {
    entry(i);
    CHECK(votes[static_cast<size_t>(i)] ==
          doctest::Approx(expected(i / landmarks, i % landmarks)).epsilon(1e-4));
  }
  distance[0] = no_number, distance[1] = infinity;  // must stay inside the table
  entry(0);
}

TEST_CASE("tables of votes are the CPU's, by all leaves of a model with missing marks") {
  const LandmarkModel model = small_model(Preset::default_preset);
  const auto& trees = model.forests[0].trees;
  RowMatrixf rows = RowMatrixf::Zero(13, 96);
  for (int i = 0; i < 13; ++i)
    rows(i, 3) = 0.3F * static_cast<float>(i % 7), rows(i, 95) = i % 2 ? -3.0F : 1.0F;
  rows(12, 3) = no_number, rows(11, 95) = infinity;
  const VoteTables expected = LeafVotes(model, rows, {}).tables(0, 13, {});
  const LeafVoteShape shape = leaf_vote_shape(model);
  std::vector<int32_t> leaf_start_start = {0}, leaf_sample_start = {0}, leaf_start, leaf_sample, leaf;
  for (const RegressionTree& tree : trees) {
    leaf_start.insert(leaf_start.end(), tree.leaf_start.begin(), tree.leaf_start.end());
    leaf_sample.insert(leaf_sample.end(), tree.leaf_samples.begin(), tree.leaf_samples.end());
    leaf_start_start.push_back(static_cast<int32_t>(leaf_start.size()));
    leaf_sample_start.push_back(static_cast<int32_t>(leaf_sample.size()));
  }
  for (int s = 0; s < 13; ++s)
    for (const RegressionTree& tree : trees) leaf.push_back(tree.leaf_of(rows.row(s).data()));
  std::vector<uint16_t> bin(static_cast<size_t>(model.targets.size()));
  const TargetBin to_bin{model.targets.data(), bin.data(), shape.target_to_bin, shape.bins};
  for (int64_t i = 0; i < model.targets.size(); ++i) to_bin(i);
  ForestTable table{};
  table.leaf_start_start = leaf_start_start.data(), table.leaf_sample_start = leaf_sample_start.data();
  table.leaf_start = leaf_start.data(), table.leaf_sample = leaf_sample.data(), table.target_bin = bin.data();
  table.trees = static_cast<int32_t>(trees.size()), table.landmarks = 3, table.bins = shape.bins;
  table.half = static_cast<int32_t>(shape.kernel.size());
  table.kernel = shape.kernel.data(), table.decay = shape.decay.data();
  std::vector<float> histogram(static_cast<size_t>(13 * 3 * (shape.bins + 1 + 2 * table.half)), no_number);
  std::vector<float> made(static_cast<size_t>(13 * 3 * (shape.bins + 1)), no_number);
  for (int64_t i = 0; i < 13 * 3; ++i) HistogramColumn{table, leaf.data(), histogram.data()}(i);
  for (int64_t i = 0; i < static_cast<int64_t>(made.size()); ++i)
    TableEntry{table, histogram.data(), made.data()}(i);
  float worst = 0;
  for (int64_t s = 0; s < 13; ++s)
    for (int32_t r = 0; r < expected.rows; ++r)
      for (int32_t l = 0; l < 3; ++l)
        worst = std::max(worst, apart(made[static_cast<size_t>((s * expected.rows + r) * 3 + l)],
                                      expected.of(s)[r * expected.stride() + l]));
  CHECK(worst <= 1e-6F);
}

TEST_CASE("a face gives nothing without heat, and finite numbers at any heat") {
  const float coefficient[4] = {0.3F, 0.4F, 0.2F, 1e-4F};
  const double heats[] = {0, 1e-300, -1e-300, 1e-200, -1e-12, 1, 1e300};
  for (const double a : heats)
    for (const double b : heats)
      for (const double c : heats)
        for (const bool negative : {false, true}) {
          const double u[3] = {a, b, c};
          float sum = 0;
          for (int at = 0; at < 3; ++at) {
            const float flow = face_flow(coefficient, u, at, negative);
            CHECK(std::isfinite(flow));
            if (std::max({std::abs(a), std::abs(b), std::abs(c)}) < 1e-290) CHECK(flow == 0);
            sum += flow;
          }
          CHECK(std::abs(sum) < 1e-3F);  // what flows in flows out; a flow is about the root of an area
        }
}

TEST_CASE("memory of a device comes back on every way") {
  const int64_t before = host_faults.live;
  {
    HostQueue queue(0);
    DeviceArray<double, HostQueue> a(queue, 10), b(queue, 5);
    b = std::move(a);
    CHECK(b.size() == 10);
    host_faults.allocation = 1;
    CHECK_NOTHROW((DeviceArray<float, HostQueue>(queue, 3)));
    CHECK_THROWS_AS((DeviceArray<float, HostQueue>(queue, 3)), DeviceFailure);
    CHECK_NOTHROW((DeviceArray<float, HostQueue>(queue, 3)));
  }
  CHECK(host_faults.live == before);
}

namespace {

// Any symmetric graph, as a sparse matrix.
SparseMatrix random_graph(Random& random, int32_t n) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int32_t v = 0; v < n; ++v) entries.emplace_back(v, v, 1);
  for (int32_t e = 0; e < 2 * n; ++e) {
    const auto a = static_cast<int32_t>(random.uniform() * n), b = static_cast<int32_t>(random.uniform() * n);
    entries.emplace_back(a, b, 1), entries.emplace_back(b, a, 1);
  }
  SparseMatrix graph(n, n);
  graph.setFromTriplets(entries.begin(), entries.end());
  return graph;
}

}  // namespace

TEST_CASE("peaks are those of the CPU, where many votes are equal and where nothing is left") {
  constexpr int32_t n = 150, landmarks = 3, count = 40;
  Random random(8);
  for (const double radius : {0.0, 0.4, 3.0}) {
    const SparseMatrix graph = random_graph(random, n);
    MatrixX3 positions(n, 3);
    RowMatrixf votes(n, landmarks);
    for (Eigen::Index i = 0; i < positions.size(); ++i) positions.data()[i] = random.uniform();
    for (Eigen::Index i = 0; i < votes.size(); ++i)
      votes.data()[i] = static_cast<float>(std::floor(4 * random.uniform()));
    votes(5, 1) = infinity;
    const auto theirs =
        find_peaks(votes, landmarks, count, 0,
                   [&](int32_t v) { return connected_ball(graph, positions, v, radius); }, {});
    constexpr int32_t chunks = (n + BestInChunk::length - 1) / BestInChunk::length;
    RowMatrixf left = votes;
    std::vector<float> best(chunks * landmarks);
    std::vector<int32_t> vertex(best.size()), mark(n * landmarks), open(n * landmarks),
        peak(landmarks * count);
    for (int32_t number = 0; number < count; ++number) {
      const BestInChunk look{left.data(), best.data(), vertex.data(), n, landmarks};
      for (int64_t at = 0; at < chunks * landmarks; ++at) look(at);
      const TakePeak take{best.data(),
                          vertex.data(),
                          {graph.outerIndexPtr(), graph.innerIndexPtr(), nullptr},
                          positions.data(),
                          left.data(),
                          mark.data(),
                          open.data(),
                          peak.data(),
                          radius,
                          n,
                          landmarks,
                          chunks,
                          count,
                          number};
      for (int64_t l = 0; l < landmarks; ++l) take(l);
    }
    for (int32_t l = 0; l < landmarks; ++l) {
      std::vector<int32_t> ours(&peak[l * count], &peak[l * count] + count);
      std::erase(ours, -1);
      CHECK(ours == theirs[l]);
    }
  }
}

TEST_CASE("isolines are those of the CPU, at radii that are none too") {
  constexpr int32_t n = 40, samples = 32, columns = 4;
  Random random(9);
  Edges edges(100, 2);
  for (Eigen::Index i = 0; i < edges.size(); ++i)
    edges.data()[i] = static_cast<int32_t>(random.uniform() * n);
  std::vector<int32_t> start = {0}, neighbour;
  for (int32_t v = 0; v < n; ++v) {
    for (Eigen::Index e = 0; e < edges.rows(); ++e)
      for (int side = 0; side < 2; ++side)
        if (edges(e, side) == v) neighbour.push_back(edges(e, 1 - side));
    start.push_back(static_cast<int32_t>(neighbour.size()));
  }
  RowMatrixf share(n, samples), radii(samples, columns), theirs = RowMatrixf::Zero(n, columns), ours = theirs;
  for (Eigen::Index i = 0; i < share.size(); ++i)
    share.data()[i] = static_cast<float>(std::floor(10 * random.uniform()) / 10);
  for (Eigen::Index i = 0; i < radii.size(); ++i)  // as often as not at a vertex
    radii.data()[i] = static_cast<float>(std::floor(20 * random.uniform()) / 20);
  radii(3, 0) = infinity, radii(4, 1) = -infinity;
  add_isoline_votes(radii, share.data(), samples, edges, 5, theirs);
  const RowMatrixf weight = (-5.0F * radii.array().square()).exp();
  const IsolineEntry entry{share.data(),  start.data(), neighbour.data(), radii.data(),
                           weight.data(), ours.data(),  columns,          samples};
  for (int64_t at = 0; at < n * columns; ++at) entry(at);
  CHECK((ours - theirs).cwiseAbs().maxCoeff() < 1e-4);
  std::vector<float> largest(samples);
  for (int64_t j = 0; j < samples; ++j) LargestDistance{share.data(), largest.data(), n, samples}(j);
  CHECK(Eigen::Map<Eigen::RowVectorXf>(largest.data(), samples) == share.colwise().maxCoeff());
}
