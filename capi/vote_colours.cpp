#include "vote_colours.h"

#include <algorithm>
#include <cmath>

namespace focal {
namespace {

using Colour = Eigen::RowVector3f;

// Steps of the golden ratio around the hue circle keep any number of landmarks apart.
Colour hue_of(Eigen::Index landmark) {
  const float turn = std::fmod(static_cast<float>(landmark) * 0.618034f, 1.0f) * 6;
  const auto ramp = [turn](float centre) {
    const float distance = std::min(std::abs(turn - centre), 6 - std::abs(turn - centre));
    return std::clamp(2 - distance, 0.0f, 1.0f);
  };
  return {ramp(0), ramp(2), ramp(4)};
}

}  // namespace

RowMatrixf vote_colours(const RowMatrixf& votes) {
  const Colour grey = Colour::Constant(0.5f);
  RowMatrixf colours(votes.cols(), 3);
  for (Eigen::Index v = 0; v < votes.cols(); ++v) {
    Eigen::Index strongest = 0;
    const float vote = std::clamp(votes.col(v).maxCoeff(&strongest), 0.0f, 1.0f);
    const float weight = vote * vote * vote;  // only the peaks stand out
    colours.row(v) = (1 - weight) * grey + weight * hue_of(strongest);
  }
  return colours;
}

}  // namespace focal
