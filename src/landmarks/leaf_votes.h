// From the leaves that a sample reaches to its table of votes.
#pragma once
#include "landmarks/model_parts.h"
#include "vote/vote.h"

namespace focal {

// For each of the descriptors' rows: the distribution of the distances to every landmark that its leaves remember,
// smoothed, weighted by exp(-mu d^2). Distances in sqrt(area).
VoteTables leaf_vote_tables(const LandmarkModel& model, const Eigen::Ref<const RowMatrixf>& descriptors,
                            const Execution& execution);

}  // namespace focal
