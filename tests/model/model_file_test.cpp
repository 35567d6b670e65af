// The model file: what goes in comes out, old files stay readable, and no damage gets through.
#include "model/model_file.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>

#include "base/error.h"
#include "base/random.h"
#include "base/signed_archive.h"
#include "descriptors/descriptor.h"
#include "descriptors/si_hks.h"
#include "geodesics/distance.h"
#include "landmarks/features.h"
#include "model/small_model.h"

using namespace focal;
using focal_test::number_at, focal_test::sign, focal_test::small_model, focal_test::small_model_of_exemplars,
    focal_test::small_model_of_parts;

namespace {

using Bytes = std::vector<std::byte>;

void check_equal(const RegressionTree& a, const RegressionTree& b) {
  CHECK(a.feature == b.feature);
  CHECK(a.threshold == b.threshold);
  CHECK(a.child == b.child);
  CHECK(a.leaf_start == b.leaf_start);
  CHECK(a.leaf_samples == b.leaf_samples);
  CHECK(a.leaf_mean == b.leaf_mean);
}

void check_equal(const RegressionForest& a, const RegressionForest& b) {
  REQUIRE(a.trees.size() == b.trees.size());
  for (size_t t = 0; t < a.trees.size(); ++t) check_equal(a.trees[t], b.trees[t]);
}

void check_equal(const TrainParams& a, const TrainParams& b) {
  CHECK(a.preset == b.preset);
  CHECK(a.eigenpair_count == b.eigenpair_count);
  CHECK(a.tree_count == b.tree_count);
  CHECK(a.min_leaf_samples == b.min_leaf_samples);
  CHECK(a.components_per_split == b.components_per_split);
  CHECK(a.sampling_rate == b.sampling_rate);
  CHECK(a.max_samples_per_shape == b.max_samples_per_shape);
  CHECK(a.seed == b.seed);
  CHECK(a.descriptor == b.descriptor);
  CHECK(a.distance == b.distance);
  CHECK(a.bulge == b.bulge);
  CHECK(a.oriented == b.oriented);
  CHECK(a.finds_heading == b.finds_heading);
}

void check_equal(const ConstellationSample& a, const ConstellationSample& b) {
  CHECK(a.present == b.present);
  CHECK(a.has_chirality == b.has_chirality);
  CHECK(a.distance == b.distance);
  CHECK(a.directions.x == b.directions.x);
  CHECK(a.directions.y == b.directions.y);
}

void check_equal(const LandmarkModel& a, const LandmarkModel& b) {
  CHECK(a.landmark_names == b.landmark_names);
  check_equal(a.params, b.params);
  CHECK(a.shape_count == b.shape_count);
  CHECK(a.mean_vertex_count == b.mean_vertex_count);
  REQUIRE(a.forests.size() == b.forests.size());
  for (size_t f = 0; f < a.forests.size(); ++f) check_equal(a.forests[f], b.forests[f]);
  check_equal(a.rising, b.rising);
  check_equal(a.facing, b.facing);
  CHECK(a.facing_targets == b.facing_targets);
  CHECK(a.targets == b.targets);
  CHECK(a.reach == b.reach);
  CHECK(a.sample_shape == b.sample_shape);
  REQUIRE(a.exemplars.size() == b.exemplars.size());
  for (size_t s = 0; s < a.exemplars.size(); ++s) {
    CHECK(a.exemplars[s].samples.Phi == b.exemplars[s].samples.Phi);
    CHECK(a.exemplars[s].distances == b.exemplars[s].distances);
    CHECK(a.exemplars[s].marked == b.exemplars[s].marked);
    CHECK(a.exemplars[s].bulge == b.exemplars[s].bulge);
    check_equal(a.exemplars[s].constellation, b.exemplars[s].constellation);
  }
  CHECK(a.constellation.landmarks == b.constellation.landmarks);
  CHECK(a.constellation.distance_mean == b.constellation.distance_mean);
  CHECK(a.constellation.distance_sd == b.constellation.distance_sd);
  CHECK(a.constellation.chirality_mean == b.constellation.chirality_mean);
  CHECK(a.constellation.chirality_sd == b.constellation.chirality_sd);
  CHECK(a.calibration.typical_vote == b.calibration.typical_vote);
  CHECK(std::ranges::equal(a.calibration.weight, b.calibration.weight));
  CHECK(a.calibration.near_error == b.calibration.near_error);
  CHECK(a.calibration.far_error == b.calibration.far_error);
  CHECK(a.calibration.fit_centre == b.calibration.fit_centre);
  CHECK(a.calibration.fit_scale == b.calibration.fit_scale);
  REQUIRE(a.details.size() == b.details.size());
  for (size_t d = 0; d < a.details.size(); ++d) {
    CHECK(a.details[d].joint == b.details[d].joint);
    CHECK(a.details[d].joints == b.details[d].joints);
    CHECK(a.details[d].reference == b.details[d].reference);
    CHECK(a.details[d].start == b.details[d].start);
    check_equal(*a.details[d].model, *b.details[d].model);
  }
}

Status status_of(std::span<const std::byte> file) {
  try {
    parse_model(file);
    return Status::ok;
  } catch (const Error& error) {
    return error.status();
  }
}

// Everything a detection would index by the model's own numbers.
void walk(const LandmarkModel& model) {
  Random random(1);
  std::vector<float> descriptor(feature_count(model.params));
  for (float& value : descriptor) value = static_cast<float>(random.normal());
  for (const RegressionForest& forest : model.forests)
    for (const RegressionTree& tree : forest.trees) {
      const int32_t leaf = tree.leaf_of(descriptor.data());
      if (!tree.leaf_mean.empty()) {
        REQUIRE(leaf < static_cast<int32_t>(tree.leaf_mean.size()));
        continue;
      }
      REQUIRE(tree.leaf_start.at(leaf) < tree.leaf_start.at(leaf + 1));
      for (int32_t i = tree.leaf_start[leaf]; i < tree.leaf_start[leaf + 1]; ++i)
        REQUIRE(tree.leaf_samples.at(i) < model.targets.rows());
    }
  for (const auto& [forest, features] : {std::pair(&model.rising, invariant_feature_count(model.params)),
                                         std::pair(&model.facing, upright_feature_count(model.params))}) {
    descriptor.resize(static_cast<size_t>(features));
    for (const RegressionTree& tree : forest->trees) {
      const int32_t leaf = tree.leaf_of(descriptor.data());
      for (int32_t i = tree.leaf_start.at(leaf); i < tree.leaf_start.at(leaf + 1); ++i)
        REQUIRE(tree.leaf_samples.at(i) < model.facing_targets.rows());
    }
  }
  if (model.sample_shape.empty()) return;
  REQUIRE(static_cast<Eigen::Index>(model.sample_shape.size()) == model.targets.rows());
  for (const int32_t shape : model.sample_shape) {
    const ConstellationSample& sample = model.exemplars.at(shape).constellation;
    REQUIRE(sample.present.size() == model.landmark_names.size());
    REQUIRE(sample.distance.size() == sample.directions.x.size());
    REQUIRE(sample.distance.allFinite());
  }
}

std::filesystem::path golden_path(const char* name) {
  return std::filesystem::path(FOCAL_GOLDEN_FOLDER) / name;
}
std::filesystem::path golden_path(Preset preset) {
  return golden_path(preset == Preset::paper ? "model_1_0_paper.focal" : "model_1_0_default.focal");
}

// Of format 1.1: a descriptor and a distance of its own.
LandmarkModel small_model_of_method() {
  LandmarkModel model = small_model(Preset::paper);
  model.params.descriptor = 2, model.params.distance = 3;  // wks, commute-time
  return model;
}

Bytes read_bytes(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  const std::vector<char> chars{std::istreambuf_iterator<char>(stream), {}};
  const auto bytes = std::as_bytes(std::span(chars));
  return {bytes.begin(), bytes.end()};
}

constexpr std::byte wks_name[] = {std::byte('w'), std::byte('k'), std::byte('s')};
constexpr Preset presets[] = {Preset::default_preset, Preset::paper};

std::vector<Bytes> files() {
  return {serialise(small_model(Preset::default_preset)), serialise(small_model(Preset::paper)),
          serialise(small_model_of_exemplars())};
}

}  // namespace

TEST_CASE("a model comes back from its bytes as it was") {
  for (const Preset preset : presets)
    check_equal(parse_model(serialise(small_model(preset))), small_model(preset));
}

TEST_CASE("golden models of format 1.0 are still read, and read the same") {
  for (const Preset preset : presets) {
    const Bytes file = read_bytes(golden_path(preset));
    REQUIRE(file.size() > 0);
    check_equal(parse_model(file), small_model(preset));
  }
}

TEST_CASE("a model keeps its descriptor and distance, by name; what this library does not have is refused") {
  check_equal(parse_model(serialise(small_model_of_method())), small_model_of_method());
  const Bytes golden = read_bytes(golden_path("model_1_1_method.focal"));
  REQUIRE(golden.size() > 0);
  check_equal(parse_model(golden), small_model_of_method());
  Bytes file = serialise(small_model_of_method());
  const auto wks = std::search(file.begin(), file.end(), std::begin(wks_name), std::end(wks_name));
  REQUIRE(wks != file.end());
  *wks = std::byte('x');
  sign(file);
  CHECK(status_of(file) == Status::unsupported_version);
  for (size_t d = 0; d < descriptor_kinds().size(); ++d) {
    LandmarkModel model = small_model(Preset::default_preset);
    model.params.descriptor = static_cast<int32_t>(d);
    CHECK(parse_model(serialise(model)).params.descriptor == static_cast<int32_t>(d));
    for (auto& tree : model.forests[0].trees)
      tree.feature[0] = descriptor_kinds()[d].dimension;  // one too far
    CHECK(status_of(serialise(model)) == Status::invalid_file);
  }
}

TEST_CASE("a model keeps its features and its training shapes one by one") {
  check_equal(parse_model(serialise(small_model_of_exemplars())), small_model_of_exemplars());
  const Bytes golden = read_bytes(golden_path("model_1_2_exemplars.focal"));
  REQUIRE(golden.size() > 0);
  check_equal(parse_model(golden), small_model_of_exemplars());
  for (const bool bulge : {false, true}) {  // each feature by itself
    LandmarkModel model = small_model(Preset::default_preset);
    if (!bulge)
      model = small_model_of_exemplars(), model.forests = small_model(Preset::default_preset).forests;
    model.params.bulge = bulge, model.params.oriented = !bulge;
    check_equal(parse_model(serialise(model)), model);
  }
}

TEST_CASE("a model keeps the parts that are analysed once more, each with its own model") {
  check_equal(parse_model(serialise(small_model_of_parts())), small_model_of_parts());
  const Bytes golden = read_bytes(golden_path("model_1_3_parts.focal"));
  REQUIRE(golden.size() > 0);
  check_equal(parse_model(golden), small_model_of_parts());
  LandmarkModel model = small_model_of_parts();  // parts have no parts
  auto part = std::make_shared<LandmarkModel>(*model.details[0].model);
  part->details = model.details, model.details[0].model = part;
  CHECK(status_of(serialise(model)) == Status::invalid_file);
}

TEST_CASE("a model of a version before 1.2 has signatures only, and does not know whose its samples are") {
  for (const Preset preset : presets) {
    const LandmarkModel old = parse_model(read_bytes(golden_path(preset)));
    CHECK_FALSE(old.params.bulge);
    CHECK_FALSE(old.params.oriented);
    CHECK(old.sample_shape.empty());
    for (const Exemplar& shape : old.exemplars) {
      CHECK(shape.bulge.size() == 0);
      CHECK(shape.constellation.present.empty());
    }
    const Bytes again = serialise(old);  // and is written as it was
    CHECK(std::ranges::equal(again, serialise(small_model(preset))));
  }
}

// focal_tests --no-skip --test-case="write the golden models" makes them; only ever for a new format version.
TEST_CASE("write the golden models" * doctest::skip()) {
  const Bytes file = serialise(small_model_of_parts());
  std::ofstream(golden_path("model_1_3_parts.focal"), std::ios::binary)
      .write(reinterpret_cast<const char*>(file.data()), static_cast<std::streamsize>(file.size()));
}

TEST_CASE("every flipped bit and every truncation of a model is noticed") {
  for (const Bytes& file : files()) {
    int32_t unnoticed = 0;
    for (size_t i = 0; i < file.size(); ++i)
      for (int bit = 0; bit < 8; ++bit) {
        Bytes damaged = file;
        damaged[i] ^= std::byte(1 << bit);
        unnoticed += status_of(damaged) == Status::ok;
      }
    for (size_t size = 0; size < file.size(); ++size)
      unnoticed += status_of(std::span(file).first(size)) != Status::invalid_file;
    CHECK(unnoticed == 0);
    std::cout << "model file: " << 8 * file.size() << " flipped bits and " << file.size() << " truncations, "
              << unnoticed << " unnoticed\n";
  }
}

TEST_CASE("damage behind right checksums is refused or harmless") {
  for (const Bytes& file : files()) {
    int32_t refused = 0, harmless = 0;
    for (size_t i = 16; i < file.size(); ++i)
      for (const int value : {0x00, 0x01, 0x7F, 0x80, 0xFF}) {
        Bytes damaged = file;
        const bool in_checksum = i >= 28 && i < 32;
        if (in_checksum || damaged[i] == std::byte(value)) continue;
        damaged[i] = std::byte(value);
        if (i >= 32 + number_at(file, 24, 4) * 24)
          sign(damaged);  // the table itself stays guarded by its checksum
        try {
          walk(parse_model(damaged));
          ++harmless;
        } catch (const Error& error) {
          CHECK(error.status() == Status::invalid_file);
          ++refused;
        }
      }
    CHECK(refused > 1000);
    std::cout << "crafted model files: " << refused << " refused, " << harmless << " harmless\n";
  }
}

TEST_CASE("a model that contradicts itself is refused, by name") {
  const auto message_of = [](const LandmarkModel& model) -> std::string {
    try {
      parse_model(serialise(model));
      return "accepted";
    } catch (const Error& error) {
      CHECK(error.status() == Status::invalid_file);
      return error.what();
    }
  };
  const auto contains = [](const std::string& text, const char* part) {
    return text.find(part) != std::string::npos;
  };
  LandmarkModel model = small_model(Preset::default_preset);
  model.landmark_names[1] = "head";
  CHECK(contains(message_of(model), "INFO: a landmark name is there twice"));
  model.landmark_names[1] = "\xC3";
  CHECK(contains(message_of(model), "INFO: a landmark name is not proper text"));
  model = small_model(Preset::default_preset);
  model.constellation.distance_sd(1, 2) = 0;
  CHECK(contains(message_of(model), "CNST: distance deviation"));
  model = small_model(Preset::default_preset);
  model.reach = std::numeric_limits<float>::quiet_NaN();
  CHECK(contains(message_of(model), "TRGT: reach"));
  model = small_model(Preset::default_preset);
  model.forests[0].trees[1].leaf_samples[0] = 7;  // fits the bits, not the samples
  CHECK(contains(message_of(model), "FRST: leaf sample"));
  model = small_model(Preset::default_preset);
  model.calibration.typical_vote.pop_back();
  CHECK(contains(message_of(model), "CALB: landmark count"));
  model = small_model(Preset::paper);
  model.forests.pop_back();
  CHECK(contains(message_of(model), "FRST: forest count"));
}

TEST_CASE("what is not a model, and what is a newer one, are told apart") {
  CHECK(status_of({}) == Status::invalid_file);
  const Bytes noise(1000, std::byte('x'));
  CHECK(status_of(noise) == Status::invalid_file);
  Bytes file = serialise(small_model(Preset::paper));
  file[12] = std::byte(2);
  CHECK(status_of(file) == Status::unsupported_version);
}

TEST_CASE("a model of ten meshes of 12,500 vertices and 36 landmarks stays under 25 MB") {
  const int32_t L = 36, samples = 62500, leaves = samples / 5;
  LandmarkModel model = small_model(Preset::default_preset);
  model.landmark_names.clear();
  for (int32_t l = 0; l < L; ++l) model.landmark_names.push_back("landmark_" + std::to_string(l));
  model.targets = TargetMatrix::Constant(samples, L, 12345);
  RegressionTree tree;
  for (int32_t node = 0; node < 2 * leaves - 1;
       ++node) {  // a heap: inner nodes first, leaves of the smallest size
    const bool leaf = node >= leaves - 1;
    tree.feature.push_back(leaf ? -1 : node % si_hks_dimension);
    tree.threshold.push_back(leaf ? 0 : static_cast<float>(node));
    tree.child.push_back(leaf ? node - (leaves - 1) : 2 * node + 1);
  }
  for (int32_t leaf = 0; leaf <= leaves; ++leaf) tree.leaf_start.push_back(5 * leaf);
  for (int32_t s = 0; s < samples; ++s) tree.leaf_samples.push_back(samples - 1 - s);
  model.params.tree_count = 30;
  model.forests[0].trees.assign(30, tree);
  model.constellation.landmarks = L;
  model.constellation.distance_mean = model.constellation.distance_sd = RowMatrixf::Constant(L, L, 1);
  model.constellation.chirality_mean.assign(L * L * L, 0.5F);
  model.constellation.chirality_sd.assign(L * L * L, 0.5F);
  model.calibration.typical_vote.assign(L, 0.5F);
  model.shape_count = 10;
  Exemplar shape = model.exemplars[0];
  shape.samples.Phi = RowMatrixf::Constant(800 + L, 128, shape.step);
  shape.samples.weight = Eigen::VectorXf::Constant(800 + L, 0.00125F);
  shape.distances = TargetMatrix::Constant(800, L, 12345);
  shape.marked.assign(L, 1);
  model.exemplars.assign(10, shape);
  const Bytes file = serialise(model);
  MESSAGE("file size: " << static_cast<double>(file.size()) / 1e6 << " MB");
  CHECK(file.size() < 25'000'000);
  const LandmarkModel back = parse_model(file);
  CHECK(back.targets == model.targets);
  check_equal(back.forests[0].trees[29], tree);
}
