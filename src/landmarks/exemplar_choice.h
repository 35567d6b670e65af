// Which training shapes are most like a new one, as the forest sees it: before any map is made, and whatever the proportions.
#pragma once
#include <span>
#include <vector>

#include "model/landmark_model.h"

namespace focal {

inline constexpr size_t used_exemplars =
    10;  // of which maps are made, and distances between landmarks learned

// Numbers of the exemplars' shapes, most alike first, at most `most`: by how often samples share a leaf with theirs (the proximity of
// L. Breiman, "Random Forests", 2001). features: rows of features_of; a few hundred are enough.
std::vector<int32_t> most_alike(const LandmarkModel& model, const Eigen::Ref<const RowMatrixf>& features,
                                size_t most);

// What these shapes say of the landmarks' places to each other; of the whole model where it does not keep it by shape.
ConstellationStatistics statistics_of(const LandmarkModel& model, std::span<const int32_t> exemplars);

// How far the trees disagree on the distances from the samples to the landmarks, of sqrt(area): least where the features are those
// of the category. features: as above.
double disagreement(const LandmarkModel& model, const Eigen::Ref<const RowMatrixf>& features);

}  // namespace focal
