#include "landmarks/vote_maps.h"

#include <algorithm>
#include <cmath>

namespace focal {

RowMatrixf full_votes(const Detection& detection, const Execution& execution) {
  const Proxy& proxy = detection.proxy;
  if (proxy.is_full()) return detection.votes;
  const auto places = coarse_place_of_vertices(proxy, execution);
  RowMatrixf result = RowMatrixf::Zero(detection.votes.rows(), static_cast<Eigen::Index>(places.size()));
  for (size_t v = 0; v < places.size(); ++v)
    for (int i = 0; i < 3; ++i)
      result.col(v) += static_cast<float>(places[v].barycentric[i]) *
                       detection.votes.col(proxy.coarse->surface.triangles(places[v].triangle, i));
  for (Eigen::Index l = 0; l < result.rows(); ++l)
    result.row(l) /= std::max(result.row(l).maxCoeff(), 1e-30f);
  return result;
}

// Steps of the golden ratio around the hue circle keep any number of landmarks apart.
Eigen::RowVector3f label_colour(int32_t label) {
  if (label < 0) return Eigen::RowVector3f::Constant(0.5f);
  const float turn = std::fmod(static_cast<float>(label) * 0.618034f, 1.0f) * 6;
  const auto ramp = [turn](float centre) {
    const float distance = std::min(std::abs(turn - centre), 6 - std::abs(turn - centre));
    return std::clamp(2 - distance, 0.0f, 1.0f);
  };
  return {ramp(0), ramp(2), ramp(4)};
}

RowMatrixf vote_colours(const RowMatrixf& votes) {
  const Eigen::RowVector3f grey = label_colour(-1);
  RowMatrixf colours(votes.cols(), 3);
  for (Eigen::Index v = 0; v < votes.cols(); ++v) {
    Eigen::Index strongest = 0;
    const float vote = std::clamp(votes.col(v).maxCoeff(&strongest), 0.0f, 1.0f);
    const float weight = vote * vote * vote;  // only the peaks stand out
    colours.row(v) = (1 - weight) * grey + weight * label_colour(static_cast<int32_t>(strongest));
  }
  return colours;
}

}  // namespace focal
