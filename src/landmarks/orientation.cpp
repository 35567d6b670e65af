#include "landmarks/orientation.h"

#include <algorithm>
#include <numeric>

#include "landmarks/exemplars.h"
#include "landmarks/features.h"

namespace focal {
namespace {

constexpr int32_t looked_at = 100;        // samples
constexpr double clearly = 0.9;           // of the disagreement as the body stands
constexpr double turned_penalty = 18;    // of facing another way: what the energies of right and wrong differ by
constexpr double tilted_penalty = 24;     // of not standing upright
constexpr size_t most_headings = 4;

// The turns that map axes onto axes; the identity first, then half a turn about the y axis, then the other turns about it.
std::vector<Matrix3> right_angles() {
  std::vector<Matrix3> upright, tilted;
  for (int x = 0; x < 3; ++x)
    for (int y = 0; y < 3; ++y)
      for (int signs = 0; signs < 4 && x != y; ++signs) {
        Matrix3 turn = Matrix3::Zero();
        turn(0, x) = signs & 1 ? -1 : 1, turn(1, y) = signs & 2 ? -1 : 1;
        turn.row(2) = turn.row(0).cross(turn.row(1));
        (turn(1, 1) == 1 ? upright : tilted).push_back(turn);
      }
  std::stable_sort(upright.begin(), upright.end(), [](const Matrix3& a, const Matrix3& b) {
    return std::pair(std::abs(a(0, 0)), a(0, 0)) > std::pair(std::abs(b(0, 0)), b(0, 0));
  });
  upright.insert(upright.end(), tilted.begin(), tilted.end());
  return upright;
}

}  // namespace

std::vector<Heading> headings_to_try(const LandmarkModel& model, const SurfaceAnalysis& analysis,
                                     DetectParams::Orientation orientation, const Execution& execution) {
  if (!model.params.oriented) return {Heading{}};
  const std::vector<Matrix3> turns = right_angles();
  const auto count = std::min(looked_at, static_cast<int32_t>(analysis.samples.size()));
  std::vector<double> apart(turns.size());
  parallel_for(execution, static_cast<int64_t>(turns.size()), [&](int64_t t) {
    apart[t] = disagreement(model, features_of(analysis, count, model.params, turns[t]));
  });
  const bool any_way = orientation == DetectParams::Orientation::any_way;
  const auto penalty = [&](size_t t) {
    return any_way || t == 0 ? 0.0 : turns[t](1, 1) == 1 ? turned_penalty : tilted_penalty;
  };
  std::vector<size_t> order(turns.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return apart[a] < apart[b]; });
  std::vector<Heading> result = {{turns[0], 0}, {turns[1], penalty(1)}};
  for (const size_t t : order)
    if (t > 1 && result.size() < most_headings && (any_way || apart[t] < clearly * apart[0]))
      result.push_back({turns[t], penalty(t)});
  if (getenv("FOCAL_TRACE")) {
    fprintf(stderr, "apart I %.4f back %.4f best %.4f (%d)", apart[0], apart[1], apart[order[0]], (int)order[0]);
    fprintf(stderr, " headings %d\n", (int)result.size());
  }
  return result;
}

}  // namespace focal
