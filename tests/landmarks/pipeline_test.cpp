// Training and detection as a whole on sample characters: right places on bodies never seen, the same bits for any
// number of threads, cancelled at once, honest about what is missing.
#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "augmentation/corruption.h"
#include "base/error.h"
#include "base/multiversion.h"
#include "landmarks/detect.h"
#include "landmarks/train.h"
#include "model/landmark_model.h"
#include "model/model_file.h"
#include "sample_humanoid.h"

using namespace focal;
using namespace focal_test;

namespace {

// Six humanoids, made once.
const TrainingSet& training_set() {
  static const TrainingSet set = [] {
    TrainingSet made;
    for (const auto& mark : humanoid(100).landmarks) made.landmark_names.push_back(mark.name);
    for (uint64_t seed = 100; seed < 106; ++seed) made.shapes.push_back(marked(humanoid(seed)));
    return made;
  }();
  return set;
}

#ifdef FOCAL_SANITIZED  // many times slower: the same code, on less
constexpr bool is_sanitized = true;
#else
constexpr bool is_sanitized = false;
#endif

// Small enough for a sanitizer, large enough to find every landmark.
TrainParams small_params(Preset preset = Preset::default_preset) {
  TrainParams params = TrainParams::from_preset(preset);
  params.eigenpair_count = 100;
  params.sampling_rate = 0.5;
  if (preset == Preset::default_preset) params.proxy_vertices = 1500;
  params.tree_count = 10;
  params.augmented_copies = 2;
  if (is_sanitized) params.sampling_rate = 0.25;
  if (is_sanitized && preset == Preset::default_preset) params.proxy_vertices = 1000;
  return params;
}

Execution threads(int count) { return {.thread_count = count, .task = nullptr, .host_parallel_for = {}}; }

std::shared_ptr<const LandmarkModel> shared_model(const TrainingSet& set, const TrainParams& params,
                                                  int thread_count) {
  return std::make_shared<LandmarkModel>(train(set, params, threads(thread_count)));
}

const std::shared_ptr<const LandmarkModel>& small_model() {
  static const auto model = shared_model(training_set(), small_params(), 2);
  return model;
}

std::vector<double> errors_in_edges(const Detection& detection, const MarkedShape& shape) {
  const double edge = mean_edge_length(detection.mesh->source);
  std::vector<double> errors;
  for (size_t l = 0; l < shape.marks.size(); ++l) {
    const Vector3 truth = position_of(detection.mesh->source, to_source(*shape.mesh, *shape.marks[l]));
    errors.push_back((detection.landmarks[l].position - truth).norm() / edge);
  }
  return errors;
}

bool same(const Detection& a, const Detection& b) {
  for (size_t l = 0; l < a.landmarks.size(); ++l)
    if (a.landmarks[l].position != b.landmarks[l].position ||
        a.landmarks[l].confidence != b.landmarks[l].confidence)
      return false;
  return a.votes == b.votes && a.category_fit == b.category_fit;
}

}  // namespace

TEST_CASE("landmarks are found on a body never seen") {
  const MarkedShape unseen = marked(humanoid(200));
  const Detection detection = detect(small_model(), unseen.mesh, {}, threads(2));
  REQUIRE(detection.landmarks.size() == unseen.marks.size());
  double sum = 0;
  for (const double error : errors_in_edges(detection, unseen)) {
    CHECK(error < 10);  // a flip or a wrong limb is further
    sum += error;
  }
  CHECK(sum / static_cast<double>(unseen.marks.size()) < 3);
  CHECK(detection.category_fit > 0.5);
  CHECK(detection.votes.rows() == static_cast<Eigen::Index>(unseen.marks.size()));
  CHECK(detection.votes.rowwise().maxCoeff().isOnes());
  for (const auto& landmark : detection.landmarks) {
    CHECK(landmark.confidence >= 0);
    CHECK(landmark.confidence <= 1);
    CHECK(landmark.expected_error > 0);
    const Vector3 on_triangle = position_of(unseen.mesh->source, landmark.source_point);
    CHECK((on_triangle - landmark.position).norm() < 1e-9);
  }
}

TEST_CASE("landmarks whose places are known stay there, and do not mislead the others") {
  const MarkedShape unseen = marked(humanoid(200));
  DetectParams params;
  params.fixed.resize(unseen.marks.size());
  for (const size_t l : {size_t{0}, size_t{3}, size_t{7}}) params.fixed[l] = unseen.marks[l];
  const Detection free = detect(small_model(), unseen.mesh, {}, threads(2)),
                  tied = detect(small_model(), unseen.mesh, params, threads(2));
  const auto before = errors_in_edges(free, unseen), after = errors_in_edges(tied, unseen);
  double sum_before = 0, sum_after = 0;
  for (size_t l = 0; l < after.size(); ++l) {
    if (params.fixed[l]) {
      CHECK(after[l] < 1e-6);
      CHECK(tied.landmarks[l].confidence == 1);
      CHECK(tied.landmarks[l].status == LandmarkStatus::found);
      continue;
    }
    CHECK(after[l] < 10);
    sum_before += before[l], sum_after += after[l];
  }
  CHECK(sum_after < 1.1 * sum_before);
  params.fixed.pop_back();
  CHECK_THROWS_AS(detect(small_model(), unseen.mesh, params, threads(2)), Error);
}

TEST_CASE(
    "a body that lost an arm keeps the landmarks that it has, and is surer of them than of the lost ones" *
    doctest::skip(is_sanitized)) {  // how sure a model is needs one of full size
  const creatures::Character whole = humanoid(200);
  std::vector<std::optional<SurfacePoint>> marks;
  int32_t hand = -1;
  for (const auto& mark : whole.landmarks) {
    if (mark.name == "handTip.L") hand = static_cast<int32_t>(marks.size());
    marks.push_back(SurfacePoint{mark.triangle, mark.barycentric});
  }
  REQUIRE(hand >= 0);
  const double radius = 0.25 * std::sqrt(surface_area(posed_mesh(whole)));  // hand and forearm
  const CorruptedMesh cut = cut_ball(intact(posed_mesh(whole), marks), *marks[hand], radius, CutEnd::open);
  const auto mesh = std::make_shared<const PreparedMesh>(prepare(cut.mesh));
  const Detection detection = detect(small_model(), mesh, {}, threads(2));
  const double edge = mean_edge_length(posed_mesh(whole));
  double sum = 0, kept = 0, sure_of_kept = 0, lost = 0, sure_of_lost = 0;
  for (size_t l = 0; l < marks.size(); ++l) {
    const auto& landmark = detection.landmarks[l];
    if (!cut.marks[l]) {
      ++lost, sure_of_lost += landmark.confidence;
      continue;
    }
    ++kept, sure_of_kept += landmark.confidence;
    sum += (landmark.position - position_of(cut.mesh, *cut.marks[l])).norm() / edge;
  }
  REQUIRE(lost >= 1);
  CHECK(sum / kept < 4);
  CHECK(sure_of_lost / lost < sure_of_kept / kept / 2);
}

TEST_CASE("preset paper trains and votes on every landmark") {
  const auto model = shared_model(training_set(), small_params(Preset::paper), 2);
  CHECK(model->forests.size() == training_set().landmark_names.size());
  const MarkedShape& seen = training_set().shapes[0];
  const auto errors = errors_in_edges(detect(model, seen.mesh, {}, threads(2)), seen);
  std::vector<double> sorted = errors;
  std::nth_element(sorted.begin(), sorted.begin() + sorted.size() / 2, sorted.end());
  CHECK(sorted[sorted.size() / 2] < 15);  // the paper's own method: right region, on a shape it has learned
}

TEST_CASE("the same bits for one, two and four threads, and from run to run" * doctest::skip(is_sanitized)) {
  const auto one = shared_model(training_set(), small_params(), 1);
  CHECK(serialise(*one) == serialise(*small_model()));
  const auto mesh = std::make_shared<PreparedMesh>(prepare(posed_mesh(humanoid(201))));
  const Detection reference = detect(one, mesh, {}, threads(1));
  CHECK(same(reference, detect(one, mesh, {}, threads(2))));
  CHECK(same(reference, detect(one, mesh, {}, threads(4))));
  CHECK(same(reference, detect(small_model(), mesh, {}, threads(1))));
}

// A spectrum is cut somewhere, and rounding turns twin eigenfunctions of the two sides there; decimation takes edges in an
// order. So places sway where the mesh is moved; see continuity_test for what does not move them.
DetectParams with_quality(Quality quality) {
  DetectParams params;
  params.quality = quality;
  return params;
}

TEST_CASE("every instruction set of this processor finds the same places" * doctest::skip(is_sanitized)) {
  const auto mesh = std::make_shared<PreparedMesh>(prepare(posed_mesh(humanoid(204))));
  const double edge = mean_edge_length(mesh->source);
  for (const Quality quality : {Quality::best, Quality::interactive}) {
    limit_instruction_set(InstructionSet::baseline);
    const Detection reference = detect(small_model(), mesh, with_quality(quality), threads(2));
    for (const auto set : {InstructionSet::avx2, InstructionSet::avx512}) {
      limit_instruction_set(set);
      if (instruction_set() != set) continue;  // not on this machine
      const Detection other = detect(small_model(), mesh, with_quality(quality), threads(2));
      for (size_t l = 0; l < reference.landmarks.size(); ++l) {
        CHECK((reference.landmarks[l].position - other.landmarks[l].position).norm() <
              (quality == Quality::best ? 0.1 : 0.01) * edge);
        CHECK(reference.landmarks[l].status == other.landmarks[l].status);
      }
    }
  }
  limit_instruction_set(InstructionSet::avx512);
}

TEST_CASE("a model from its file detects like the one that was saved") {
  const auto mesh = std::make_shared<PreparedMesh>(prepare(posed_mesh(humanoid(202))));
  const auto loaded = std::make_shared<LandmarkModel>(parse_model(serialise(*small_model())));
  CHECK(same(detect(small_model(), mesh, {}, threads(2)), detect(loaded, mesh, {}, threads(2))));
}

TEST_CASE("scale and rigid motion change nothing but the coordinates" * doctest::skip(is_sanitized)) {
  TriangleMesh moved = posed_mesh(humanoid(203));
  const auto original = std::make_shared<PreparedMesh>(prepare(moved));
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(1.1, Vector3(1, 2, 3).normalized()).toRotationMatrix();
  for (Eigen::Index v = 0; v < moved.positions.rows(); ++v)
    moved.positions.row(v) =
        (1e6 * turn * moved.positions.row(v).transpose() + Vector3(3e5, 0, -1e5)).transpose();
  const auto other = std::make_shared<PreparedMesh>(prepare(std::move(moved)));
  const double edge = mean_edge_length(original->source);
  for (const Quality quality : {Quality::best, Quality::interactive}) {
    const Detection a = detect(small_model(), original, with_quality(quality), threads(2)),
                    b = detect(small_model(), other, with_quality(quality), threads(2));
    for (size_t l = 0; l < a.landmarks.size(); ++l) {
      const Vector3 there = (1e6 * turn * a.landmarks[l].position + Vector3(3e5, 0, -1e5));
      CHECK((there - b.landmarks[l].position).norm() < (quality == Quality::best ? 1 : 1e-3) * 1e6 * edge);
    }
  }
}

TEST_CASE("a landmark may be absent on some shapes, not on all but one") {
  TrainingSet set = training_set();
  set.shapes[0].marks[1].reset();
  set.shapes[1].marks[0].reset();
  CHECK_NOTHROW(train(set, small_params(), threads(2)));
  for (size_t s = 0; s + 1 < set.shapes.size(); ++s) set.shapes[s].marks[2].reset();
  CHECK_THROWS_WITH(train(set, small_params(), threads(2)),
                    doctest::Contains((set.landmark_names[2] + "' is marked on 1 mesh").c_str()));
  set.shapes.resize(1);
  try {
    train(set, small_params(), threads(2));
    FAIL("one mesh is too few");
  } catch (const Error& error) {
    CHECK(error.status() == Status::too_few_shapes);
    CHECK(!error.hint().empty());
  }
}

TEST_CASE("a cancelled training stops") {
  for (const int milliseconds : {0, 100, 700}) {
    Task task;
    Execution execution = threads(2);
    execution.task = &task;
    std::thread canceller([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
      task.cancel();
    });
    try {
      train(training_set(), small_params(), execution);
      CHECK(milliseconds > 0);  // may be done by then on a very fast machine
    } catch (const Error& error) {
      CHECK(error.status() == Status::cancelled);
    }
    canceller.join();
  }
}
