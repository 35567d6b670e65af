// Whole detections by a backend beside the CPU's; and, where the module can be told to fail, every way of failing.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdio>

#include "compute/backend_under_test.h"
#include "landmarks/detect.h"
#include "landmarks/train.h"
#include "model/landmark_model.h"
#include "sample_humanoid.h"

using namespace focal;
using namespace focal_test;

namespace {

// Preset paper analyses a surface as it is, so it is given small ones.
std::shared_ptr<const PreparedMesh> coarse(const std::shared_ptr<const PreparedMesh>& mesh) {
  return make_proxy(mesh, 1000).coarse;
}
MarkedShape coarse(const MarkedShape& shape) {
  const Proxy proxy = make_proxy(shape.mesh, 1000);
  MarkedShape result{proxy.coarse, {}};
  for (const auto& mark : shape.marks) result.marks.push_back(to_coarse(proxy, std::span(&*mark, 1))[0]);
  return result;
}

std::shared_ptr<const LandmarkModel> trained(Preset preset) {
  TrainingSet set;
  for (const auto& mark : humanoid(100).landmarks) set.landmark_names.push_back(mark.name);
  for (uint64_t seed = 100; seed < (sanitized ? 104 : 106); ++seed) {
    MarkedShape shape = marked(humanoid(seed));
    if (preset == Preset::paper) shape = coarse(shape);
    set.shapes.push_back(std::move(shape));
  }
  TrainParams params = TrainParams::from_preset(preset);
  params.eigenpair_count = 100, params.sampling_rate = 0.3, params.tree_count = 10,
  params.augmented_copies = 0;
  params.learns_confidence = false;
  if (preset == Preset::default_preset) params.proxy_vertices = sanitized ? 600 : 900;
  return std::make_shared<LandmarkModel>(train(set, params, {}));
}

const std::shared_ptr<const LandmarkModel>& model() {
  static const auto made = trained(Preset::default_preset);
  return made;
}

std::shared_ptr<const PreparedMesh> unseen(uint64_t seed) {
  return std::make_shared<PreparedMesh>(prepare(posed_mesh(humanoid(seed))));
}

Execution on(const Backend* where) {
  Execution execution;
  execution.thread_count = 2, execution.backend = where;
  return execution;
}

void check_same_bits(const Detection& a, const Detection& b) {
  REQUIRE(a.landmarks.size() == b.landmarks.size());
  for (size_t l = 0; l < a.landmarks.size(); ++l) {
    CHECK(a.landmarks[l].position == b.landmarks[l].position);
    CHECK(a.landmarks[l].confidence == b.landmarks[l].confidence);
  }
  CHECK(a.votes == b.votes);
}

void check_agrees(const std::shared_ptr<const LandmarkModel>& model_of) {
  double worst = 0;
  const bool paper = model_of->params.preset == Preset::paper;
  for (uint64_t seed = 200; seed < 203; ++seed) {
    const auto mesh = paper ? coarse(unseen(seed)) : unseen(seed);
    const Detection ours = detect(model_of, mesh, {}, on(backend.get())),
                    theirs = detect(model_of, mesh, {}, on(nullptr));
    CHECK(ours.by_backend);
    CHECK_FALSE(theirs.by_backend);
    const double edge = make_operators(theirs.proxy.coarse->surface).mean_edge * theirs.proxy.scale();
    for (size_t l = 0; l < ours.landmarks.size(); ++l) {
      CHECK(ours.landmarks[l].status == theirs.landmarks[l].status);
      worst = std::max(worst, (ours.landmarks[l].position - theirs.landmarks[l].position).norm() / edge);
    }
  }
  std::printf("landmarks at most %.4f edges apart, 0.1 allowed\n", worst);
  CHECK(worst <= 0.1);
}

}  // namespace

TEST_CASE("landmarks are the same within a tenth of an edge, preset default" * doctest::skip(sanitized)) {
  check_agrees(model());
}

TEST_CASE("landmarks are the same within a tenth of an edge, preset paper" * doctest::skip(sanitized)) {
  check_agrees(trained(Preset::paper));
}

TEST_CASE("the device gives the same bits each time, and by any number of threads") {
  const auto mesh = unseen(200);
  Execution one = on(backend.get());
  one.thread_count = 1;
  check_same_bits(detect(model(), mesh, {}, one), detect(model(), mesh, {}, on(backend.get())));
}

TEST_CASE("an analysis that is kept needs no device any more" * doctest::skip(sanitized)) {
  std::string note;
  const auto mesh = unseen(201);
  detect(model(), mesh, {}, on(backend.get()));
  const int64_t live = faults() ? faults()->live.load() : 0;  // the model's forest stays
  const SurfaceAnalysis kept = analyse_to_keep(model()->params, mesh, {}, on(backend.get()), note);
  CHECK(note.empty());
  CHECK_FALSE(kept.engine->is_device());
  CHECK_FALSE(kept.distances.steps.empty());
  const Detection detection = detect(model(), kept, {}, on(backend.get()));
  CHECK_FALSE(detection.by_backend);
  const Detection theirs = detect(model(), mesh, {}, on(nullptr));
  const double edge = kept.operators.mean_edge * kept.proxy.scale();
  for (size_t l = 0; l < theirs.landmarks.size(); ++l)
    CHECK((detection.landmarks[l].position - theirs.landmarks[l].position).norm() <= 0.1 * edge);
  if (faults()) CHECK(faults()->live == live);
}

TEST_CASE("wherever a device fails, the CPU does the whole mesh") {
  if (!faults()) return;
  const auto mesh = unseen(202);
  const Detection theirs = detect(model(), mesh, {}, on(nullptr));
  faults()->allocations = 0, faults()->launches = 0, faults()->downloads = 0;
  CHECK(detect(model(), mesh, {}, on(backend.get())).by_backend);
  const int64_t allocations = faults()->allocations, launches = faults()->launches,
                downloads = faults()->downloads;
  REQUIRE(allocations > 40);
  REQUIRE(launches > 20);
  const auto check_fails = [&](std::atomic<int64_t>& counter, int64_t at, const char* why) {
    counter = at;
    const Detection ours = detect(model(), mesh, {}, on(backend.get()));
    counter = -1;
    CHECK_FALSE(ours.by_backend);
    REQUIRE(!ours.warnings.empty());
    CHECK(ours.warnings.back() == std::string("the GPU failed (") + why + "), so the CPU did this mesh");
    check_same_bits(ours, theirs);
    CHECK(backend->works());
  };
  for (int i = 0; i < (sanitized ? 2 : 3); ++i) {
    check_fails(faults()->allocation, i * (allocations - 1) / 2, "out of device memory");
    check_fails(faults()->download, i * (downloads - 1) / 2,
                i == 0 ? "the eigenvalues of the surface did not converge on the GPU"
                       : "the device returned invalid results");
    check_fails(faults()->launch, i * (launches - 1) / 2, "a launch failed");
  }
  std::string note;
  faults()->launch = 9;  // of the many in the spectrum
  analyse_to_keep(model()->params, mesh, {}, on(backend.get()), note);
  CHECK(note.find("a launch failed") != std::string::npos);
  faults()->launch = -1;
}

TEST_CASE("after a lasting failure the device is asked no more") {
  if (!faults()) return;
  const auto mesh = unseen(202);
  const auto other = load_backend(files, 0).backend;
  REQUIRE(other);
  faults()->lasting = true, faults()->launch = 7;
  CHECK_FALSE(detect(model(), mesh, {}, on(other.get())).by_backend);
  faults()->launch = -1, faults()->lasting = false;
  CHECK_FALSE(other->works());
  CHECK(std::string(other->reason()).find("a launch failed") != std::string::npos);
  faults()->allocations = 0;
  const Detection next = detect(model(), mesh, {}, on(other.get()));
  CHECK(next.warnings.empty());
  CHECK(faults()->allocations == 0);
}

TEST_CASE("many meshes at once, one queue each") {
  std::vector<std::shared_ptr<const PreparedMesh>> meshes;
  for (uint64_t seed = 200; seed < 203; ++seed) meshes.push_back(unseen(seed));
  std::vector<Detection> together(meshes.size());
  Execution four;
  four.thread_count = 4;
  parallel_for(four, static_cast<int64_t>(meshes.size()), [&](int64_t i) {
    Execution inner = four.inner();
    inner.backend = backend.get();
    together[static_cast<size_t>(i)] = detect(model(), meshes[static_cast<size_t>(i)], {}, inner);
  });
  for (size_t i = 0; i < meshes.size(); ++i) {
    CHECK(together[i].by_backend);
    check_same_bits(together[i], detect(model(), meshes[i], {}, on(backend.get())));
  }
}
