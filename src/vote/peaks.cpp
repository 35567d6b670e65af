#include "vote/peaks.h"

#include <limits>

namespace focal {

std::vector<std::vector<int32_t>> find_peaks(const RowMatrixf& votes, int32_t count, double separation,
                                             double floor, const DistanceFields& fields) {
  const auto landmarks = static_cast<int32_t>(votes.cols());
  constexpr float gone = -std::numeric_limits<float>::infinity();
  RowMatrixf left = votes.transpose();  // a landmark's votes side by side, emptied round each peak found
  std::vector<std::vector<int32_t>> peaks(landmarks);
  for (int32_t round = 0; round < count; ++round) {  // one peak of every landmark a round: one blocked solve
    std::vector<int32_t> chosen, owner;
    for (int32_t l = 0; l < landmarks; ++l) {
      Eigen::Index best = 0;
      const float vote = left.row(l).maxCoeff(&best);
      if (vote == gone || (round > 0 && vote < floor * votes(peaks[l][0], l))) continue;
      peaks[l].push_back(static_cast<int32_t>(best));
      chosen.push_back(static_cast<int32_t>(best)), owner.push_back(l);
    }
    if (chosen.empty() || round + 1 == count) break;
    const RowMatrixf distance = fields(chosen);
    for (size_t c = 0; c < chosen.size(); ++c) {
      auto row = left.row(owner[c]);
      for (Eigen::Index v = 0; v < row.size(); ++v)
        if (distance(c, v) < separation) row[v] = gone;
      row[chosen[c]] = gone;
    }
  }
  return peaks;
}

}  // namespace focal
