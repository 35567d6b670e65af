#include "vote/peaks.h"

#include <limits>

namespace focal {

std::vector<std::vector<int32_t>> find_peaks(const RowMatrixf& votes, int32_t landmarks, int32_t count,
                                             double floor, const Surroundings& surroundings,
                                             const Execution& execution) {
  constexpr float gone = -std::numeric_limits<float>::infinity();
  std::vector<std::vector<int32_t>> peaks(landmarks);
  parallel_for(execution, landmarks, [&](int64_t l) {
    Eigen::VectorXf left = votes.col(l);  // set to zero around each peak found
    while (static_cast<int32_t>(peaks[l].size()) < count) {
      Eigen::Index best = 0;
      const float vote = left.maxCoeff(&best);
      if (vote == gone || (!peaks[l].empty() && vote < floor * votes(peaks[l][0], l))) break;
      peaks[l].push_back(static_cast<int32_t>(best));
      left[best] = gone;
      for (const int32_t v : surroundings(static_cast<int32_t>(best))) left[v] = gone;
    }
  });
  return peaks;
}

}  // namespace focal
