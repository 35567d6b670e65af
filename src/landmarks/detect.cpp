#include "landmarks/detect.h"

#include <algorithm>

#include "base/error.h"
#include "base/stopwatch.h"
#include "landmarks/confidence.h"
#include "landmarks/model_parts.h"
#include "landmarks/paper.h"
#include "landmarks/placement.h"
#include "landmarks/surface_analysis.h"

namespace focal {
namespace {

DetectedPoint point_at(const PreparedMesh& mesh, int32_t surface_vertex, double confidence) {
  DetectedPoint point;
  point.source_point = to_source(mesh, at_vertex(mesh.surface, surface_vertex));
  point.source_vertex = mesh.source_vertex[surface_vertex];
  point.position = mesh.source.positions.row(point.source_vertex);
  point.confidence = confidence;
  return point;
}

LandmarkStatus status_of(double confidence, const DetectParams& params) {
  if (confidence >= params.found_confidence) return LandmarkStatus::found;
  return confidence >= params.absent_confidence ? LandmarkStatus::uncertain : LandmarkStatus::absent;
}

DetectedLandmark landmark_at(const LandmarkModel& model, const PreparedMesh& mesh, const Placement& placement,
                             int32_t l, const DetectParams& params) {
  DetectedLandmark landmark;
  if (placement.vertex[l] < 0) return landmark;             // no vote at all: absent
  const bool paper = model.params.preset == Preset::paper;  // the paper gives no confidence: its vote stands
  const double confidence = paper ? 1 : confidence_of(model.calibration, l, placement.evidence[l]);
  static_cast<DetectedPoint&>(landmark) = point_at(mesh, placement.vertex[l], confidence);
  landmark.status = status_of(confidence, params);
  landmark.expected_error = mesh.scale * expected_error_of(model.calibration, confidence);
  if (placement.rival[l] >= 0) {
    const float rival = placement.evidence[l].rival;  // shares what the winner leaves, by its votes
    landmark.runner_up =
        point_at(mesh, placement.rival[l], (1 - confidence) * std::min(1.0f, rival / (1 + rival)));
  }
  return landmark;
}

}  // namespace

Detection detect(std::shared_ptr<const LandmarkModel> model, std::shared_ptr<const PreparedMesh> mesh,
                 const DetectParams& params, const Execution& execution) {
  if (!(params.sampling_rate > 0 && params.sampling_rate <= 1) || params.max_samples < 1 ||
      params.peaks_per_landmark < 1)
    throw Error(Status::invalid_argument, "a detection parameter is out of its range",
                "start from the defaults");
  Stopwatch whole;
  Detection result;
  const bool paper = model->params.preset == Preset::paper;
  execution.begin_stage("analysis", 0, 0.4);
  const SurfaceAnalysis analysis = analyse_surface(*mesh,
                                                   {.eigenpair_count = model->params.eigenpair_count,
                                                    .sampling_rate = params.sampling_rate,
                                                    .max_samples = params.max_samples,
                                                    .seed = params.seed,
                                                    .stream = 0,
                                                    .keep_negative_heat = paper},
                                                   execution);
  result.seconds.spectrum = analysis.spectrum_seconds;
  result.seconds.descriptors = analysis.descriptor_seconds;
  result.seconds.geodesics = analysis.geodesic_seconds;
  execution.begin_stage("votes", 0.4, 0.9);
  const Placement placement =
      paper ? place_landmarks_paper(*model, *mesh, analysis, params, execution, result.seconds)
            : place_landmarks(*model, *mesh, analysis, params.max_samples, params, execution, result.seconds);
  for (int32_t l = 0; l < static_cast<int32_t>(model->landmark_names.size()); ++l)
    result.landmarks.push_back(landmark_at(*model, *mesh, placement, l, params));
  result.category_fit = paper ? 1 : category_fit_of(model->calibration, placement.evidence);
  if (analysis.heat.time_was_raised())
    result.warnings.push_back("the mesh is so fine that the time step of the heat method was raised");
  if (params.keep_votes) {
    result.votes = placement.votes.transpose();
    for (Eigen::Index l = 0; l < result.votes.rows(); ++l)
      result.votes.row(l) /= std::max(result.votes.row(l).maxCoeff(), 1e-30f);
  }
  result.model = std::move(model);
  result.mesh = std::move(mesh);
  result.seconds.total = whole.lap();
  execution.begin_stage("done", 1, 1);
  return result;
}

}  // namespace focal
