// The paper's three kinds of point, by name, for each set (its Table 2): tips of the shape, flat places, and what
// lies between.
#pragma once
#include <string>
#include <vector>

namespace paper {

struct Kinds {
  std::vector<std::string> tips, between, flat;
  std::vector<std::string> all() const;
  // One of each kind where there is one, pairs by their left: what single pictures ask for.
  std::vector<std::string> examples() const;
};

// By the name of a set; of a set that is not listed every point counts as one between.
Kinds kinds_of(const std::string& set, const std::vector<std::string>& landmarks);

struct PaperErrors {
  double tips, between, flat, mean;  // Table 2; negative: not given
};
const PaperErrors* paper_errors_of(const std::string& set);

struct PaperSeconds {                      // Table 1
  double descriptors, geodesics, forests;  // of training; the first two a shape
  double descriptors_of_test, geodesics_of_test, forest_of_test, voting;
};
const PaperSeconds* paper_seconds_of(const std::string& set);

}  // namespace paper
