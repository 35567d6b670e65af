// Finds the training shapes most similar to a new one by the forest alone: before any map is computed, and
// independent of proportions.
#pragma once
#include <span>
#include <vector>

#include "model/landmark_model.h"

namespace focal {

// Exemplars for which maps are computed, and from which distances between landmarks are learned.
inline constexpr size_t used_exemplars = 10;

// Numbers of the exemplars' shapes, most similar first, at most `most`: by how often samples share a leaf
// with theirs (the proximity of L. Breiman, "Random Forests", 2001). features: rows of features_of; a few
// hundred are enough.
std::vector<int32_t> most_alike(const LandmarkModel& model, const Eigen::Ref<const RowMatrixf>& features,
                                size_t most);

// Statistics of the landmarks of these shapes; of the whole model where it has no statistics per shape.
ConstellationStatistics statistics_of(const LandmarkModel& model, std::span<const int32_t> exemplars);

// Disagreement of the trees on the distances from the samples to the landmarks, in sqrt(area): smallest where
// the features are those of the category. features: as above.
double disagreement(const LandmarkModel& model, const Eigen::Ref<const RowMatrixf>& features);

}  // namespace focal
