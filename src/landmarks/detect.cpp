#include "landmarks/detect.h"

#include <algorithm>
#include <mutex>

#include "analysis/device_engine.h"
#include "analysis/surface_analysis.h"
#include "base/error.h"
#include "base/stopwatch.h"
#include "compute/module_loader.h"
#include "landmarks/confidence.h"
#include "landmarks/placement.h"
#include "model/landmark_model.h"
#include "paper/paper.h"

namespace focal {
namespace {

// A few hundred samples decide the heading of some characters by the seed; a proxy has fewer vertices than this.
constexpr int32_t described_for_heading = 4000;

DetectedPoint point_at(const PreparedMesh& mesh, const SurfacePoint& surface_point, double confidence) {
  DetectedPoint point;
  point.source_point = to_source(mesh, surface_point);
  point.source_vertex = nearest_corner(mesh.source, point.source_point);
  point.position = position_of(mesh.source, point.source_point);
  point.confidence = confidence;
  return point;
}

LandmarkStatus status_of(double confidence, double absent, const DetectParams& params) {
  if (confidence >= params.found_confidence) return LandmarkStatus::found;
  if (absent > 0.5) return LandmarkStatus::absent;
  return confidence >= params.absent_confidence ? LandmarkStatus::uncertain : LandmarkStatus::absent;
}

// place, runner_up: on the full surface.
DetectedLandmark landmark_at(const LandmarkModel& model, const Proxy& proxy, const Placement& placement,
                             const ConfidenceEstimate& estimate, int32_t l, const SurfacePoint& place,
                             const SurfacePoint& rival_place, const DetectParams& params) {
  DetectedLandmark landmark;
  if (placement.vertex[l] < 0) return landmark;             // no votes: absent
  const bool paper = model.params.preset == Preset::paper;  // the paper has no confidence: use the vote
  const double confidence = paper ? 1 : estimate.confidence[l];
  static_cast<DetectedPoint&>(landmark) = point_at(*proxy.full, place, confidence);
  landmark.status = status_of(confidence, paper ? 0 : estimate.absent[l], params);
  landmark.expected_error = proxy.scale() * expected_error_of(model.calibration, confidence);
  if (placement.runner_up[l] >= 0) {
    // Gets a share of the remaining probability, by its votes.
    const float runner_up = placement.features[l].runner_up;
    landmark.runner_up =
        point_at(*proxy.full, rival_place, (1 - confidence) * std::min(1.0f, runner_up / (1 + runner_up)));
  }
  return landmark;
}

DetectedLandmark known_landmark(const PreparedMesh& mesh, const SurfacePoint& place) {
  DetectedLandmark landmark;
  static_cast<DetectedPoint&>(landmark) = point_at(mesh, place, 1);
  landmark.status = LandmarkStatus::found;
  return landmark;
}

std::vector<DetectedLandmark> landmarks_at(const LandmarkModel& model, const SurfaceAnalysis& analysis,
                                           const Placement& placement, const ConfidenceEstimate& estimate,
                                           const DetectParams& params, const Execution& execution) {
  const auto L = placement.vertex.size();
  std::vector<int32_t> runners_up;
  for (const int32_t runner_up : placement.runner_up) runners_up.push_back(std::max(runner_up, 0));
  std::vector<SurfacePoint> places = placement.point;
  // Triangle 0 is a placeholder where a landmark has no place.
  for (size_t l = 0; l < L; ++l)
    if (placement.vertex[l] < 0) places[l].triangle = 0;
  const auto runner_up_places = points_at(analysis.surface(), runners_up);
  places.insert(places.end(), runner_up_places.begin(), runner_up_places.end());
  const auto full = to_full(analysis.proxy, places, execution);
  std::vector<DetectedLandmark> result;
  for (size_t l = 0; l < L; ++l)
    result.push_back(placement.is_fixed(l)
                         ? known_landmark(*analysis.proxy.full, *params.fixed[l])
                         : landmark_at(model, analysis.proxy, placement, estimate, static_cast<int32_t>(l),
                                       full[l], full[L + l], params));
  return result;
}

void validate(const DetectParams& params) {
  if (!(params.sampling_rate >= 0 && params.sampling_rate <= 1) || params.max_samples < 1 ||
      params.peaks_per_landmark < 1)
    throw Error(Status::invalid_argument, "a detection parameter is out of its range",
                "start from the defaults");
}

void check_fixed(const DetectParams& params, const LandmarkModel& model) {
  if (params.fixed.empty()) return;
  if (model.params.preset == Preset::paper)
    throw Error(Status::unsupported, "preset paper finds each landmark on its own: known ones do not help",
                "train with the default preset");
  if (params.fixed.size() != model.landmark_names.size())
    throw Error(Status::invalid_argument,
                "there are " + std::to_string(params.fixed.size()) + " known places for " +
                    std::to_string(model.landmark_names.size()) + " landmarks",
                "pass one for each landmark of the model");
}

bool suits(const AnalysisParams& made, const AnalysisParams& wanted) {
  return made.proxy_vertices == wanted.proxy_vertices && made.eigenpair_count == wanted.eigenpair_count &&
         made.paper_exact == wanted.paper_exact && made.descriptor == wanted.descriptor &&
         made.distance == wanted.distance;
}

// A correction does not remove landmarks: one that is absent only with the fixed ones is reported as
// uncertain.
void keep_present(const std::shared_ptr<const LandmarkModel>& model, const SurfaceAnalysis& analysis,
                  const Placement& placement, const DetectParams& params, const Execution& execution,
                  std::vector<DetectedLandmark>& landmarks) {
  const auto is_absent = [](const DetectedLandmark& one) { return one.status == LandmarkStatus::absent; };
  if (params.fixed.empty() || std::none_of(landmarks.begin(), landmarks.end(), is_absent)) return;
  DetectParams alone = params;
  alone.fixed.clear(), alone.keep_votes = false;
  const Detection before = detect(model, analysis, alone, execution);
  for (size_t l = 0; l < landmarks.size(); ++l)
    if (is_absent(landmarks[l]) && placement.vertex[l] >= 0 && !is_absent(before.landmarks[l]))
      landmarks[l].status = LandmarkStatus::uncertain;
}

Detection detect_afresh(const std::shared_ptr<const LandmarkModel>& model,
                        const std::shared_ptr<const PreparedMesh>& mesh, const DetectParams& params,
                        const Execution& execution) {
  execution.begin_stage("analysis", 0, 0.4);
  auto analysis = std::make_shared<SurfaceAnalysis>(analyse_for(model->params, mesh, params, execution));
  // They are used once per heading.
  if (model->params.oriented && !analysis->engine->is_device()) keep_distances(*analysis, execution);
  Detection result = detect(model, *analysis, params, execution);
  result.seconds.proxy = analysis->proxy_seconds;
  result.seconds.spectrum = analysis->spectrum_seconds;
  result.seconds.descriptors += analysis->descriptor_seconds;
  result.seconds.geodesics += analysis->geodesic_seconds;
  result.by_backend = analysis->engine->is_device();
  leave_device(*analysis);
  analysis->distances = {};
  result.analysis = std::move(analysis);
  return result;
}

}  // namespace

const SurfaceAnalysis& analysis_of(const Detection& detection) {
  if (!detection.analysis)
    throw Error(Status::invalid_argument, "the detection keeps no analysis of the mesh",
                "detect on the mesh itself");
  return *detection.analysis;
}

void check_suits(const SurfaceAnalysis& analysis, const LandmarkModel& model) {
  if (!suits(analysis.params, analysis_params_of(model.params)))
    throw Error(Status::invalid_argument, "the analysis was made with other parameters than this model's",
                "analyse the mesh again with the parameters of this model");
}

std::vector<int32_t> placed_landmarks(const Detection& detection) {
  std::vector<int32_t> placed;
  for (size_t l = 0; l < detection.places.size(); ++l)
    if (detection.places[l].triangle >= 0) placed.push_back(static_cast<int32_t>(l));
  return placed;
}

std::vector<SurfacePoint> places_of(const Detection& detection, const std::vector<int32_t>& landmarks) {
  std::vector<SurfacePoint> places;
  for (const int32_t l : landmarks) places.push_back(detection.places[l]);
  return places;
}

SurfaceAnalysis analyse_for(const TrainParams& trained, std::shared_ptr<const PreparedMesh> mesh,
                            const DetectParams& params, const Execution& execution) {
  validate(params);
  AnalysisParams how = analysis_params_of(trained);
  how.sampling_rate = sampling_rate_of(params, trained), how.max_samples = params.max_samples;
  how.max_described = trained.oriented && trained.finds_heading ? described_for_heading : 0;
  how.seed = params.seed;
  return analyse_surface(std::move(mesh), how, execution);
}

SurfaceAnalysis analyse_to_keep(const TrainParams& trained, std::shared_ptr<const PreparedMesh> mesh,
                                const DetectParams& params, const Execution& execution, std::string& note) {
  SurfaceAnalysis result;
  note = with_fallback(execution, [&](const Execution& how) {
    how.begin_stage("analysis", 0, 0.8);
    result = analyse_for(trained, mesh, params, how);
    how.begin_stage("distances", 0.8, 1);
    keep_distances(result, how);
  });
  leave_device(result);
  return result;
}

Detection detect(std::shared_ptr<const LandmarkModel> model, std::shared_ptr<const PreparedMesh> mesh,
                 const DetectParams& params, const Execution& execution) {
  Stopwatch whole;
  Detection result;
  const std::string note = with_fallback(
      execution, [&](const Execution& how) { result = detect_afresh(model, mesh, params, how); });
  if (!note.empty()) result.warnings.push_back(note);
  result.seconds.total = whole.lap();
  return result;
}

Detection detect(std::shared_ptr<const LandmarkModel> model, const SurfaceAnalysis& analysis,
                 const DetectParams& params, const Execution& execution) {
  validate(params);
  check_fixed(params, *model);
  check_suits(analysis, *model);
  Stopwatch whole;
  Detection result;
  const bool paper = model->params.preset == Preset::paper;
  execution.begin_stage("votes", 0.4, 0.9);
  Placement placement =
      paper ? place_landmarks_paper(*model, analysis, params, execution, result.seconds)
            : place_landmarks(*model, analysis, params.max_samples, params, execution, result.seconds);
  execution.begin_stage("landmarks", 0.9, 1);
  Stopwatch mapping;
  const ConfidenceEstimate estimate =
      paper ? ConfidenceEstimate{}
            : estimate_confidence(model->calibration, placement.features, placement.map_residual);
  result.landmarks = landmarks_at(*model, analysis, placement, estimate, params, execution);
  keep_present(model, analysis, placement, params, execution, result.landmarks);
  result.places = placement.point;
  for (size_t l = 0; l < result.landmarks.size(); ++l)
    if (placement.vertex[l] < 0 || result.landmarks[l].status == LandmarkStatus::absent)
      result.places[l].triangle = -1;
  result.seconds.refine += mapping.lap();
  result.exemplars = placement.exemplars;
  result.maps = std::move(placement.maps), result.map_residual = placement.map_residual;
  result.bulge_agreement = placement.bulge_agreement, result.cost_margin = placement.cost_margin;
  result.heading_advantage = placement.heading_advantage, result.frame = placement.frame;
  result.has_fixed =
      std::any_of(params.fixed.begin(), params.fixed.end(), [](const auto& one) { return one.has_value(); });
  result.category_fit = estimate.category_fit;
  if (const char* warning = analysis.metric->warning()) result.warnings.emplace_back(warning);
  if (!paper && !analysis.proxy.full->is_oriented)
    result.warnings.push_back("left and right were distinguished by distances alone, not by chirality");
  if (const int32_t holes = analysis.proxy.filled_holes)
    result.warnings.push_back(std::to_string(holes) + (holes == 1 ? " hole was" : " holes were") +
                              " closed for the analysis");
  if (params.keep_votes) {
    result.votes = placement.votes.transpose();
    for (Eigen::Index l = 0; l < result.votes.rows(); ++l)
      result.votes.row(l) /= std::max(result.votes.row(l).maxCoeff(), 1e-30f);
  }
  result.model = std::move(model);
  result.proxy = analysis.proxy;
  result.mesh = analysis.proxy.full;
  result.seconds.total = whole.lap();
  return result;
}

std::vector<Detection> detect_each(const std::shared_ptr<const LandmarkModel>& model,
                                   const std::vector<std::shared_ptr<const PreparedMesh>>& meshes,
                                   const DetectParams& params, const Execution& execution) {
  std::vector<Detection> found(meshes.size());
  std::mutex reporting;
  size_t done = 0;
  execution.begin_stage("detections", 0, 1);
  parallel_for(execution, static_cast<int64_t>(meshes.size()), [&](int64_t i) {
    Execution inner = execution.inner();
    inner.backend = execution.backend;
    try {
      found[i] = detect(model, meshes[i], params, inner);
    } catch (const Error& error) {
      throw Error(error.status(), "mesh " + std::to_string(i) + ": " + error.what(), error.hint());
    }
    const std::scoped_lock lock(reporting);
    execution.report(static_cast<double>(++done) / static_cast<double>(meshes.size()));
  });
  return found;
}

}  // namespace focal
