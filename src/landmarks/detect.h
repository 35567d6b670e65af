// Runs the stages in order, from a prepared mesh to landmarks.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/surface_analysis.h"
#include "base/parallel.h"
#include "landmarks/exemplar_maps.h"
#include "mesh/landmark_status.h"
#include "mesh/prepare.h"
#include "model/model_info.h"
#include "model/params.h"

namespace focal {

struct DetectedPoint {
  SurfacePoint source_point;           // on mesh->source: the caller's triangle numbers
  int32_t source_vertex = -1;          // the caller's vertex nearest to it
  Vector3 position = Vector3::Zero();  // caller's coordinates
  double confidence = 0;               // 0..1: probability that the error is below 4 % of sqrt(area)
};

struct DetectedLandmark : DetectedPoint {
  LandmarkStatus status = LandmarkStatus::absent;
  double expected_error = 0;  // caller's units
  std::optional<DetectedPoint> runner_up;
};

struct Detection {
  std::shared_ptr<const LandmarkModel> model;
  std::shared_ptr<const PreparedMesh> mesh;
  std::vector<DetectedLandmark> landmarks;  // one per landmark name of the model, in its order
  Proxy proxy;                              // the surface of the votes
  // Input of maps onto this mesh: its analysis (without distances), and each landmark's place on the analysed
  // surface, triangle -1 where it is absent. No analysis where the caller provided one to detection.
  std::shared_ptr<const SurfaceAnalysis> analysis;
  std::vector<SurfacePoint> places;
  std::vector<int32_t> exemplars;               // the most similar training shapes
  std::vector<ShapeMap> maps;                   // from training shapes, with quality `best`
  float map_residual = 0, bulge_agreement = 0;  // see Placement
  double cost_margin = 0, heading_advantage = 0;
  Matrix3 frame = Matrix3::Identity();  // likewise
  bool has_fixed = false;               // known landmarks were given, so the orientation of the body is known
  RowMatrixf votes;  // landmarks x vertices of proxy.coarse->surface, each row's largest is 1; may be empty
  double category_fit = 0;            // 0..1
  std::vector<std::string> warnings;  // in addition to those of the mesh
  bool by_backend = false;            // the execution's backend ran the heavy stages
  StageSeconds seconds;
};

// Numbers of the landmarks with a place on the analysed surface, and these places.
std::vector<int32_t> placed_landmarks(const Detection& detection);
std::vector<SurfacePoint> places_of(const Detection& detection, const std::vector<int32_t>& landmarks);

// Throws invalid_argument when the detection keeps none.
const SurfaceAnalysis& analysis_of(const Detection& detection);

Detection detect(std::shared_ptr<const LandmarkModel> model, std::shared_ptr<const PreparedMesh> mesh,
                 const DetectParams& params, const Execution& execution);

// Throws invalid_argument when the parameters of the analysis differ from the model's.
void check_suits(const SurfaceAnalysis& analysis, const LandmarkModel& model);

// For several models on one mesh: run the analysis once, with parameters compatible with all of them (see
// check_suits).
SurfaceAnalysis analyse_for(const TrainParams& trained, std::shared_ptr<const PreparedMesh> mesh,
                            const DetectParams& params, const Execution& execution);
// The same with the distances of all samples, where they are small (see keep_distances), and with nothing
// left on a GPU. note: a sentence when a GPU failed, else empty.
SurfaceAnalysis analyse_to_keep(const TrainParams& trained, std::shared_ptr<const PreparedMesh> mesh,
                                const DetectParams& params, const Execution& execution, std::string& note);
Detection detect(std::shared_ptr<const LandmarkModel> model, const SurfaceAnalysis& analysis,
                 const DetectParams& params, const Execution& execution);

// On each mesh, one thread a mesh. An error names the mesh by its number.
std::vector<Detection> detect_each(const std::shared_ptr<const LandmarkModel>& model,
                                   const std::vector<std::shared_ptr<const PreparedMesh>>& meshes,
                                   const DetectParams& params, const Execution& execution);

}  // namespace focal
