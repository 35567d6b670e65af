// From the leaves that a sample reaches to its table of votes.
#pragma once
#include <cstdint>
#include <vector>

#include "model/landmark_model.h"
#include "vote/vote.h"

namespace focal {

// What tables are made with: distances are counted in bins, and the counts smoothed.
struct LeafVoteShape {
  int32_t bins;  // of a histogram of the distances to a landmark
  double bin_width;
  float target_to_bin;
  std::vector<float>
      kernel;  // entry i: at i + 1/2 bins from the centre of a bin, where the table has its rows
  std::vector<float> decay;  // exp(-mu d^2) at the rows of a table
};
LeafVoteShape leaf_vote_shape(const LandmarkModel& model);

// For each sample the distribution of the distances to every landmark that its leaves remember, smoothed, weighted by
// exp(-mu d^2). Distances in sqrt(area). What all samples share is kept, so tables can be made some samples at a time.
class LeafVotes {
 public:
  // descriptors: one row a sample. The model must outlive it.
  LeafVotes(const LandmarkModel& model, const Eigen::Ref<const RowMatrixf>& descriptors,
            const Execution& execution);
  // Of the samples [first, first + count).
  VoteTables tables(int32_t first, int32_t count, const Execution& execution) const;

 private:
  void add_histogram(int32_t sample, float* histogram) const;

  const LandmarkModel& model_;
  LeafVoteShape shape_;
  int32_t stride_;
  std::vector<uint16_t> target_bin_;  // training samples x stride_; shape_.bins where there is none
  Eigen::Matrix<int32_t, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> leaf_;  // samples x trees
};

}  // namespace focal
