// What eval and cross-validate say: one mesh judged, and all of them as JSON and as tables.
#pragma once
#include <set>
#include <span>
#include <string>

#include "evaluation/accuracy.h"
#include "marked_mesh.h"
#include "output.h"

namespace focal_cli {

std::vector<std::string> landmark_names_of(const focal_model* model);

struct TimedDetection {
  Detection detection;
  double seconds = 0;
};

TimedDetection detect_on(const focal_model* model, const MarkedMesh& mesh, const focal_detect_params& params,
                         focal_task* task);

// What was found against the mesh's marks. counted: the landmarks that count.
MeshOutcome outcome_of(const TimedDetection& found, const MarkedMesh& mesh, const SetFolder& set,
                       const std::set<std::string>& counted);

// Both of the above.
MeshOutcome evaluate_mesh(const focal_model* model, const MarkedMesh& mesh, const SetFolder& set,
                          const std::set<std::string>& counted, const focal_detect_params& params,
                          focal_task* task);

// The landmarks to count: those of --subset, or all. Throws when the set has none of that name.
std::set<std::string> counted_landmarks(const SetFolder& set, const std::vector<std::string>& subset);

Json mesh_json(const MeshOutcome& mesh);
Json landmarks_json(std::span<const MeshOutcome> meshes);
void add_summary(Json& document, const Summary& summary);

// As tables: the landmarks, the meshes, all together.
void print_outcomes(std::ostream& out, std::span<const MeshOutcome> meshes, const Summary& summary);

}  // namespace focal_cli
