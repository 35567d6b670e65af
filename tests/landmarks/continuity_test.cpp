// Landmarks move as little as the mesh does: what a rounding changes, of positions or of a processor's sums, must not decide
// between two places that lie part of an edge apart.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdio>

#include "base/multiversion.h"
#include "base/random.h"
#include "landmarks/detect.h"
#include "landmarks/train.h"
#include "model/landmark_model.h"
#include "sample_humanoid.h"

using namespace focal;
using namespace focal_test;

namespace {

#ifdef FOCAL_SANITIZED  // many times slower: the same code, on less
constexpr bool sanitized = true;
#else
constexpr bool sanitized = false;
#endif

constexpr int32_t proxy_vertices = 900;

const std::shared_ptr<const LandmarkModel>& model() {
  static const std::shared_ptr<const LandmarkModel> made = [] {
    TrainingSet set;
    for (const auto& mark : humanoid(100).landmarks) set.landmark_names.push_back(mark.name);
    for (uint64_t seed = 100; seed < (sanitized ? 104 : 112); ++seed)
      set.shapes.push_back(marked(humanoid(seed)));
    TrainParams params = TrainParams::from_preset(Preset::default_preset);
    params.eigenpair_count = 100, params.sampling_rate = 0.3, params.tree_count = 10;
    params.augmented_copies = 0, params.learns_confidence = false, params.proxy_vertices = proxy_vertices;
    return std::make_shared<LandmarkModel>(train(set, params, {}));
  }();
  return made;
}

// Small enough to be analysed as it is: decimation takes edges in an order, and there is no half of an edge to take.
TriangleMesh unseen(uint64_t seed) {
  return make_proxy(marked(humanoid(seed)).mesh, proxy_vertices).coarse->surface;
}

TriangleMesh rounded_elsewhere(TriangleMesh mesh, double size, uint64_t seed) {
  Random random(seed);
  for (double& x : mesh.positions.reshaped()) x += size * random.normal();
  return mesh;
}

Detection detected(const TriangleMesh& mesh, Quality quality) {
  DetectParams params;
  params.quality = quality;
  return detect(model(), std::make_shared<PreparedMesh>(prepare(mesh)), params, {});
}

double edges_apart(const Detection& a, const Detection& b) {
  const double edge = mean_edge_length(a.mesh->source);
  double most = 0;
  for (size_t l = 0; l < a.landmarks.size(); ++l) {
    CHECK(a.landmarks[l].status == b.landmarks[l].status);
    most = std::max(most, (a.landmarks[l].position - b.landmarks[l].position).norm() / edge);
  }
  return most;
}

struct EverySet {  // calls once for each instruction set of this processor
  template <class Body>
  void operator()(const Body& body) const {
    for (const auto set : {InstructionSet::baseline, InstructionSet::avx2, InstructionSet::avx512}) {
      limit_instruction_set(set);
      if (instruction_set() == set) body();
    }
  }
  ~EverySet() { limit_instruction_set(InstructionSet::avx512); }
};

// Measured here 0.004; images of maps at whole vertices gave 0.19, and 1.2 with quality interactive.
constexpr double allowed = 0.02;

}  // namespace

TEST_CASE("landmarks stay where they are when positions are rounded elsewhere") {
  constexpr double rounding = 1e-7;  // of sqrt(area): about what floats round to
  for (const Quality quality : {Quality::best, Quality::interactive}) {
    double most = 0;
    for (const uint64_t seed : {203, 206, 209, 210}) {
      const TriangleMesh mesh = unseen(seed);
      EverySet()([&] {
        const Detection before = detected(mesh, quality);
        for (uint64_t other = 0; other < (sanitized ? 1 : 2); ++other)
          most = std::max(most,
                          edges_apart(before, detected(rounded_elsewhere(mesh, rounding, other), quality)));
      });
      if (sanitized) break;
    }
    std::printf("landmarks moved at most %.4f edges, %.4f allowed\n", most, allowed);
    CHECK(most < allowed);
  }
}

TEST_CASE("landmarks are the same by every instruction set") {
  for (const Quality quality : {Quality::best, Quality::interactive}) {
    double most = 0;
    for (const uint64_t seed : {203, 206, 209, 210}) {
      const TriangleMesh mesh = unseen(seed);
      Detection first;
      EverySet()([&] {
        if (first.landmarks.empty())
          first = detected(mesh, quality);
        else
          most = std::max(most, edges_apart(first, detected(mesh, quality)));
      });
      if (sanitized) break;
    }
    std::printf("by other instructions at most %.4f edges apart, %.4f allowed\n", most, allowed);
    CHECK(most < allowed);
  }
}
