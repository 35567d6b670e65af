// How well landmarks were found: errors, left and right swapped, absent ones, and whether confidence means
// what it says. Pure arithmetic; a figure that is not defined for the data is NaN and becomes null in JSON.
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "landmark_files.h"

namespace focal_cli {

inline constexpr double far_edges = 10;  // over_10_edges
inline constexpr double swap_edges = 8;  // nearer to the mirror's mark and farther off than this: swapped
inline constexpr double flipped_share = 0.25;  // more of a mesh's pairs swapped than this: flipped
inline constexpr double right_edges = 4;       // a landmark this near is right, when confidence is judged
inline constexpr size_t calibration_bins = 10;
inline constexpr double sure_confidence =
    0.9;  // a landmark found with this much is one a user will not check

// What the detector said about one landmark. No position: it has no place at all, an infinite error.
struct Guess {
  std::string name;
  std::optional<Position> position;
  double confidence = 0;
  bool absent = false;  // it says that the mesh lacks the landmark; its best place still counts as the guess
};

struct MeshScale {
  double mean_edge = 1;  // mean edge length
  double root_area = 1;  // sqrt(area)
};

struct Outcome {
  std::string name;
  bool marked = false;  // the mesh has this landmark; otherwise it is truly absent and has no error
  bool said_absent = false;
  double confidence = 0;
  double error_edges = 0;
  double error_root_area = 0;
  std::optional<bool> swapped;  // only where landmark and mirror are both marked
};

struct MeshOutcome {
  std::string name;
  uint64_t vertices = 0;
  double seconds = 0;
  std::vector<Outcome> outcomes;
  double category_fit = 0;  // does the mesh belong to the model's category at all, 0..1
};

// marks: where the landmarks truly are, by name; what is missing is absent. mirror: both ways.
std::vector<Outcome> judge(std::span<const Guess> guesses, const std::map<std::string, Position>& marks,
                           const std::map<std::string, std::string>& mirror, const MeshScale& scale);

double swapped_share(const MeshOutcome& mesh);            // of the landmarks with a mirror; NaN without any
std::optional<bool> is_flipped(const MeshOutcome& mesh);  // empty without any

struct CalibrationBin {
  double from = 0, to = 0;
  size_t count = 0;
  double confidence = 0;  // mean of the bin; NaN when empty
  double accuracy = 0;    // share of it that is right; NaN when empty
};

struct Calibration {
  double expected_error = 0;  // sum over bins of share x |accuracy - confidence|
  double auroc = 0;           // chance that a right one has more confidence than a wrong one, ties half
  std::vector<CalibrationBin> bins;
  size_t sure_count = 0;  // with sure_confidence or more
  double sure_right = 0;  // share of them that is right; NaN without any
};

struct Summary {
  size_t marks = 0;
  double mean_edges = 0, median_edges = 0, p95_edges = 0, mean_root_area_x100 = 0, over_10_edges = 0;
  double within_4_edges = 0;
  double swap_rate = 0;               // of all landmarks with a mirror on all meshes
  std::optional<int> flipped_meshes;  // empty for a set without pairs
  double absent_precision = 0, absent_recall = 0;
  Calibration calibration;
  double category_fit_median = 0;
  double seconds_median = 0;
};

Summary summarise(std::span<const MeshOutcome> meshes);

struct LandmarkSummary {
  std::string name;
  size_t marks = 0;
  double mean_edges = 0, median_edges = 0, p95_edges = 0, max_edges = 0;
  double within_4_edges = 0, over_10_edges = 0;
};

// One a landmark, in the order of first appearance.
std::vector<LandmarkSummary> summarise_landmarks(std::span<const MeshOutcome> meshes);

// share 0..1 with linear interpolation between neighbours; NaN when there are no values.
double quantile(std::vector<double> values, double share);
double mean(std::span<const double> values);

}  // namespace focal_cli
