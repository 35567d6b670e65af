// What came out of one case over all judged shapes.
#pragma once
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cases.h"
#include "landmarks/detect.h"

namespace focal_robustness {

struct CaseResult {
  std::string name, wanted;
  std::vector<double> errors;  // of the marks that remain, in mean edges of the clean mesh
  double deviation = 0;        // of similarities: largest, from the clean answer, in the same unit
  int said_absent = 0, truly_absent = 0, both_absent = 0, lost_in_holes = 0, failed = 0;
  // What could tell the absent ones: their confidence, and how near they were put to a border of the surface.
  std::vector<double> confidence_here, confidence_gone, border_here, border_gone;  // the latter in mean edges
  // Of every mark that was not lost in a hole: confidence, and error, null where its place is gone.
  nlohmann::json outcomes = nlohmann::json::array();
  bool missing = false, similarity = false;
  double seconds = 0;

  double mean() const;
  double median() const;
  double share_over(double limit) const;
  // Probability that an absent landmark gets the lower value of a random pair with one that is here; NaN without any.
  static double separation(const std::vector<double>& here, const std::vector<double>& gone);
};

// The answers of the clean shapes, positions by landmark, or none; one for each judged shape.
using CleanAnswers = std::vector<std::vector<focal::DetectedLandmark>>;

CaseResult run_case(const Case& which, const Shapes& shapes,
                    const std::shared_ptr<const focal::LandmarkModel>& model, uint64_t seed,
                    CleanAnswers& clean);

void print_table(const std::vector<CaseResult>& results);
nlohmann::json json_of(const std::vector<CaseResult>& results);

}  // namespace focal_robustness
