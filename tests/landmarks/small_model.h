// A small model written out by hand, of numbers that are the same on every machine: what the golden files
// hold. Never change it: older files are read for ever. A new format version gets new golden files beside the
// old ones.
#pragma once
#include "landmarks/model_parts.h"

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
                  .seed = 0x1234567890ABCDEF};
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
    constellation.handedness_mean.push_back(static_cast<float>(i - 13) / 16);
    constellation.handedness_sd.push_back(0.25F);
  }
  for (int32_t shape = 0; shape < 2; ++shape) {
    focal::AtlasShape atlas;
    atlas.step = 0.0625F;
    atlas.samples.Phi.resize(5 + L, 4);
    for (int32_t i = 0; i < atlas.samples.Phi.size(); ++i)
      atlas.samples.Phi.data()[i] = static_cast<float>((i * 7 + shape) % 19 - 9) * atlas.step;
    atlas.samples.weight = Eigen::VectorXf::Constant(5 + L, 0.2F);
    atlas.samples.weight.tail(L).setZero();
    atlas.distances.resize(5, L);
    for (int32_t i = 0; i < 5 * L; ++i) atlas.distances.data()[i] = static_cast<uint16_t>(i * 4000 + shape);
    atlas.marked = {1, 1, static_cast<char>(shape)};
    model.atlas.push_back(std::move(atlas));
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

}  // namespace focal_test
