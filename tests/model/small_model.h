// A small model written out by hand, of numbers that are the same on every machine: what the golden files
// hold. Never change it: older files are read for ever. A new format version gets new golden files beside the
// old ones.
#pragma once
#include "model/landmark_model.h"

namespace focal_test {

// Five nodes, breadth first: 0 tests component 3; 1 is a leaf; 2 tests component 95; 3 and 4 are leaves.
inline focal::RegressionTree small_tree(bool with_samples, int32_t variant) {
  focal::RegressionTree tree;
  tree.feature = {3, -1, 95, -1, -1};
  tree.threshold = {0.25F + static_cast<float>(variant), 0, -1.5F, 0, 0};
  tree.child = {1, 0, 3, 1, 2};
  if (with_samples) {
    tree.leaf_start = {0, 2, 3, 6};
    tree.leaf_samples = {0, 4, 2, 1, 3, variant};
  } else {
    tree.leaf_mean = {0.5F, 0.125F * static_cast<float>(variant), 1};
  }
  return tree;
}

inline focal::LandmarkModel small_model(focal::Preset preset) {
  const bool paper = preset == focal::Preset::paper;
  const int32_t L = 3, samples = 6;
  focal::LandmarkModel model;
  model.landmark_names = {"head", "hand.L", "\xC3\xA9paule.R"};
  model.params = {.preset = preset,
                  .eigenpair_count = 120,
                  .tree_count = 2,
                  .min_leaf_samples = 4,
                  .components_per_split = 6,
                  .sampling_rate = 0.75,
                  .max_samples_per_shape = 1000,
                  .seed = 0x1234567890ABCDEF,
                  .bulge = false,  // format 1.0 has signatures only
                  .oriented = false};
  model.shape_count = 7, model.mean_vertex_count = 2502;
  for (int32_t f = 0; f < (paper ? L : 1); ++f)
    model.forests.push_back({{small_tree(!paper, f), small_tree(!paper, f + 1)}});
  model.reach = paper ? 1.0F : 2.5F;
  if (paper) return model;
  model.targets.resize(samples, L);
  for (int32_t i = 0; i < samples * L; ++i) model.targets.data()[i] = static_cast<uint16_t>(i * 3000);
  model.targets(4, 2) = focal::target_missing;
  auto& constellation = model.constellation;
  constellation.landmarks = L;
  constellation.distance_mean = focal::RowMatrixf::Constant(L, L, 0.75F);
  constellation.distance_mean(0, 1) = constellation.distance_mean(1, 0) = 1.5F;
  constellation.distance_sd = focal::RowMatrixf::Constant(L, L, 0.0625F);
  for (int32_t i = 0; i < L * L * L; ++i) {
    constellation.chirality_mean.push_back(static_cast<float>(i - 13) / 16);
    constellation.chirality_sd.push_back(0.25F);
  }
  for (int32_t shape = 0; shape < 2; ++shape) {
    focal::Exemplar exemplars;
    exemplars.step = 0.0625F;
    exemplars.samples.Phi.resize(5 + L, 4);
    for (int32_t i = 0; i < exemplars.samples.Phi.size(); ++i)
      exemplars.samples.Phi.data()[i] = static_cast<float>((i * 7 + shape) % 19 - 9) * exemplars.step;
    exemplars.samples.weight = Eigen::VectorXf::Constant(5 + L, 0.2F);
    exemplars.samples.weight.tail(L).setZero();
    exemplars.distances.resize(5, L);
    for (int32_t i = 0; i < 5 * L; ++i)
      exemplars.distances.data()[i] = static_cast<uint16_t>(i * 4000 + shape);
    exemplars.marked = {1, 1, static_cast<char>(shape)};
    model.exemplars.push_back(std::move(exemplars));
  }
  model.calibration.typical_vote = {0.5F, 0, 0.25F};
  for (int32_t i = 0; i <= focal::Calibration::feature_count; ++i)
    model.calibration.weight[i] = static_cast<float>(i) - 1.5F,
    model.calibration.absent_weight[i] = 2.5F - static_cast<float>(i);
  model.calibration.typical_length[0] = -3, model.calibration.typical_length[1] = -3.5F;
  model.calibration.typical_residual = 0.25F;
  model.calibration.near_error = 0.03125F, model.calibration.far_error = 0.375F;
  model.calibration.fit_centre = -0.5F, model.calibration.fit_scale = 2;
  return model;
}

// What format 1.2 added to it: features, and the training shapes one by one.
inline focal::LandmarkModel small_model_of_exemplars() {
  focal::LandmarkModel model = small_model(focal::Preset::default_preset);
  const int32_t L = 3;
  model.params.bulge = model.params.oriented = true;
  model.forests[0].trees[0].feature[2] =
      121;  // the last: 96 of the signature, 2 x 4 of bulges, 3 x 6 of the frame
  for (int32_t t = 0; t < 2; ++t) {
    model.rising.trees.push_back(small_tree(true, t));
    model.facing.trees.push_back(small_tree(true, 2 - t));
    model.rising.trees[t].feature[2] = 103;  // the last: 96 of the signature, 2 x 4 of bulges
    model.facing.trees[t].feature[2] = 115;  // and 3 x 4 of the height
  }
  model.facing_targets.resize(7, 6);
  for (int32_t i = 0; i < 42; ++i) model.facing_targets.data()[i] = 0.125F * static_cast<float>(i - 20);
  model.sample_shape = {0, 0, 1, 1, 0, 1};
  for (int32_t s = 0; s < 2; ++s) {
    focal::Exemplar& shape = model.exemplars[s];
    shape.bulge.resize(5, 4);
    for (int32_t i = 0; i < 20; ++i) shape.bulge.data()[i] = static_cast<float>(i * 1600 - 32000 + s) / 32767;
    auto& sample = shape.constellation;
    sample.present = shape.marked, sample.has_chirality = s == 0;
    sample.distance = sample.directions.x = sample.directions.y = focal::RowMatrixf::Zero(L, L);
    for (int32_t i = 0; i < L * L; ++i) {
      sample.distance.data()[i] = 0.125F * static_cast<float>(i + s);
      sample.directions.x.data()[i] = static_cast<float>(15 * i - 60 + s) / 127 * 2;
      sample.directions.y.data()[i] = static_cast<float>(60 - 15 * i - s) / 127 * 2;
    }
  }
  return model;
}

// Of a body with one part that is analysed once more by itself.
inline focal::LandmarkModel small_model_of_parts() {
  focal::LandmarkModel model = small_model(focal::Preset::default_preset);
  model.skeleton = {{"arm", -1}, {"hand", 0}};
  const auto part = std::make_shared<focal::LandmarkModel>(small_model_of_exemplars());
  part->skeleton = model.skeleton;
  part->params.finds_heading = false;
  part->rising = part->facing = {}, part->facing_targets.resize(0, 6);
  model.details.push_back({1, {0, 1}, {{0.5, -1, 0.25}, {0, 0.125, 0}}, -0.25, part});
  return model;
}

}  // namespace focal_test
