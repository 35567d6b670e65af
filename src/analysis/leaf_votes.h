// Converts the leaves that a sample reaches into its table of votes.
#pragma once
#include <cstdint>
#include <vector>

#include "model/landmark_model.h"
#include "vote/vote.h"

namespace focal {

// How tables are computed: distances are counted in bins, and the counts smoothed.
struct LeafVoteShape {
  int32_t bins;  // of a histogram of the distances to a landmark
  double bin_width;
  float target_to_bin;
  // Entry i: at i + 1/2 bins from the centre of a bin; the rows of a table are at the edges of bins.
  std::vector<float> kernel;
  std::vector<float> decay;  // exp(-mu d^2) at the rows of a table
};
LeafVoteShape leaf_vote_shape(const LandmarkModel& model);

// For each sample the distribution of the distances to every landmark that is stored in its leaves, smoothed
// and weighted by exp(-mu d^2). Distances in sqrt(area). Data shared by all samples is kept, so tables can be
// computed for a few samples at a time.
class LeafVotes {
 public:
  // descriptors: one row per sample. The model must outlive this object.
  LeafVotes(const LandmarkModel& model, const Eigen::Ref<const RowMatrixf>& descriptors,
            const Execution& execution);
  // Tables of the samples [first, first + count).
  VoteTables tables(int32_t first, int32_t count, const Execution& execution) const;

 private:
  void add_histogram(int32_t sample, float* histogram) const;

  const LandmarkModel& model_;
  LeafVoteShape shape_;
  int32_t stride_;
  std::vector<uint16_t> target_bin_;  // training samples x stride_; shape_.bins where the target is missing
  Eigen::Matrix<int32_t, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> leaf_;  // samples x trees
};

}  // namespace focal
