// focal eval --report: one HTML page that holds all it needs. Its sources lie in report/ and are compiled in.
#pragma once
#include <set>
#include <string>
#include <vector>

#include "evaluation/outcomes.h"

namespace focal_cli {

// Gathers what the page shows, mesh by mesh, so that no detection has to be kept.
class ReportPage {
 public:
  ReportPage(const std::set<std::string>& counted, size_t meshes);

  void add(const MarkedMesh& mesh, const TimedDetection& found, const MeshOutcome& outcome);

  // report: the JSON of eval; what the page says is the same.
  std::string html(Json report) const;

 private:
  const std::set<std::string>& counted_;
  const size_t most_vertices_;
  std::vector<Json> meshes_;  // as shown, in the order of add
};

}  // namespace focal_cli
