// Landmarks found on a mesh.
#include <algorithm>
#include <limits>
#include <utility>

#include "analysis/analysis_file.h"
#include "arguments.h"
#include "base/atomic_file.h"
#include "boundary.h"
#include "objects.h"
#include "structs.h"

using namespace focal;

namespace {

// The fields that both sides call alike, either way.
template <class To, class From>
void copy_detect_fields(const From& from, To& to) {
  to.sampling_rate = from.sampling_rate;
  to.max_samples = from.max_samples;
  to.peaks_per_landmark = from.peaks_per_landmark;
  to.found_confidence = from.found_confidence;
  to.absent_confidence = from.absent_confidence;
  to.keep_votes = from.keep_votes;
  to.seed = from.seed;
}

focal_detect_params default_detect_params() {
  const DetectParams params;
  focal_detect_params result{};
  copy_detect_fields(params, result);
  result.quality = static_cast<focal_quality>(params.quality);
  return result;
}

}  // namespace

FOCAL_STRUCT_WITH_DEFAULTS(focal_detect_params, 56, default_detect_params);
static_assert(sizeof(void*) != 8 ||
              (sizeof(focal_detect_params) == 72 && offsetof(focal_detect_params, fixed_points) == 56));
FOCAL_STRUCT(focal_landmark, sizeof(focal_landmark));
static_assert(sizeof(void*) != 8 || (sizeof(focal_landmark) == 112 && offsetof(focal_landmark, point) == 40));
FOCAL_STRUCT(focal_detection_info, 48);
static_assert(sizeof(focal_detection_info) == 48 && offsetof(focal_detection_info, backend) == 40);
FOCAL_STRUCT(focal_stage_seconds, 96);
static_assert(sizeof(focal_stage_seconds) == 96 && offsetof(focal_stage_seconds, total) == 88);

namespace {

DetectParams checked(const focal_detect_params* given) {
  const focal_detect_params params = read_struct(given);
  constexpr double most = std::numeric_limits<int32_t>::max();
  check_range("focal_detect_params.quality", params.quality, FOCAL_QUALITY_BEST, FOCAL_QUALITY_INTERACTIVE);
  check_range("focal_detect_params.sampling_rate", params.sampling_rate, 0, 1);
  check_range("focal_detect_params.max_samples", params.max_samples, 1, most);
  check_range("focal_detect_params.peaks_per_landmark", params.peaks_per_landmark, 1, 64);
  check_range("focal_detect_params.found_confidence", params.found_confidence, 0, 1);
  check_range("focal_detect_params.absent_confidence", params.absent_confidence, 0, params.found_confidence);
  check_flag("focal_detect_params.keep_votes", params.keep_votes);
  check_range("focal_detect_params.orientation", params.orientation, FOCAL_ORIENTATION_UPRIGHT,
              FOCAL_ORIENTATION_ANY);
  DetectParams result;
  copy_detect_fields(params, result);
  result.quality = static_cast<Quality>(params.quality);
  result.orientation = static_cast<DetectParams::Orientation>(params.orientation);
  return result;
}

// On the mesh's surface.
std::vector<std::optional<SurfacePoint>> fixed_places(const focal_detect_params& params,
                                                      const ModelInfo& model, const PreparedMesh& mesh) {
  std::vector<std::optional<SurfacePoint>> places;
  if (!params.fixed_points && params.fixed_point_count == 0) return places;
  require(params.fixed_points, "focal_detect_params.fixed_points");
  check_count("focal_detect_params.fixed_point_count", params.fixed_point_count, model.landmark_names.size(),
              "the model", "landmarks",
              "give a point, or one with FOCAL_NO_TRIANGLE, for each landmark of the model");
  for (size_t l = 0; l < model.landmark_names.size(); ++l) {
    places.emplace_back();
    if (params.fixed_points[l].triangle != FOCAL_NO_TRIANGLE)
      places.back() =
          point_in(mesh, params.fixed_points[l], "fixed landmark '" + model.landmark_names[l] + "'");
  }
  return places;
}

uint32_t vertex_out(int32_t vertex) { return vertex < 0 ? FOCAL_NO_VERTEX : static_cast<uint32_t>(vertex); }

focal_landmark to_abi(const DetectedLandmark& from, const std::string& name) {
  focal_landmark to{};
  to.status = static_cast<focal_landmark_status>(from.status);
  to.name = name.c_str();
  to.confidence = from.confidence;
  to.expected_error = from.expected_error;
  to.point = point_out(from.source_point);
  position_out(from.position, to.position);
  to.vertex = vertex_out(from.source_vertex);
  const DetectedPoint second = from.runner_up.value_or(DetectedPoint{});
  to.has_runner_up = from.runner_up.has_value();
  to.runner_up_confidence = second.confidence;
  to.runner_up_point = point_out(second.source_point);
  position_out(second.position, to.runner_up_position);
  to.runner_up_vertex = vertex_out(second.source_vertex);
  return to;
}

// What the caller asked for, ready to run.
struct Call {
  std::shared_ptr<ModelObject> model;
  DetectParams params;
  TaskLease lease;
  Execution execution;

  Call(const focal_model* handle, const focal_detect_params* given, focal_task* task)
      : model(resolve<ModelObject>(handle)),
        params(checked(given)),
        lease(task),
        execution(model->context->execution_with(lease.task())) {}
};

focal_detection* publish_detection(const Call& call, std::shared_ptr<const MeshObject> mesh,
                                   Detection detection) {
  const auto object = std::make_shared<DetectionObject>();
  object->model = call.model;
  object->mesh = std::move(mesh);
  object->detection = std::move(detection);
  call.model->context->report_warnings(object->detection.warnings);
  object->warnings = object->mesh->warnings;
  object->warnings.insert(object->warnings.end(), object->detection.warnings.begin(),
                          object->detection.warnings.end());
  return publish(object, *call.model);
}

focal_detection* publish_with_times(const Call& call, const std::shared_ptr<const MeshObject>& mesh,
                                    Detection detection) {
  detection.seconds.load = mesh->load_seconds;
  detection.seconds.repair = mesh->repair_seconds;
  detection.seconds.total += mesh->load_seconds + mesh->repair_seconds;
  return publish_detection(call, mesh, std::move(detection));
}

// Handles that are taken back unless all of them were made.
struct Handles {
  std::vector<focal_detection*> made;
  ~Handles() {
    for (focal_detection* one : made) remove_handle(one, HandleType::detection);
  }
};

}  // namespace

focal_status focal_model_detect(const focal_model* model, const focal_mesh* mesh,
                                const focal_detect_params* params, focal_task* task,
                                focal_detection** out_detection) {
  return guarded([&] {
    require(out_detection, "out_detection");
    Call call(model, params, task);
    const auto object = resolve<MeshObject>(mesh);
    call.params.fixed = fixed_places(read_struct(params), call.model->info, *object->mesh);
    *out_detection = publish_with_times(call, object,
                                        detect(call.model->model, object->mesh, call.params, call.execution));
  });
}

focal_status focal_model_detect_many(const focal_model* model, const focal_mesh* const* meshes,
                                     uint64_t mesh_count, const focal_detect_params* params, focal_task* task,
                                     focal_detection** out_detections) {
  return guarded([&] {
    require(out_detections, "out_detections");
    require(meshes, "meshes");
    const focal_detect_params given = read_struct(params);
    if (given.fixed_points || given.fixed_point_count > 0)
      throw Error(Status::invalid_argument, "focal_detect_params.fixed_points belong to one mesh",
                  "call focal_model_detect for a mesh with fixed landmarks");
    const Call call(model, params, task);
    std::vector<std::shared_ptr<const MeshObject>> objects;
    std::vector<std::shared_ptr<const PreparedMesh>> prepared;
    for (uint64_t i = 0; i < mesh_count; ++i) {
      objects.push_back(resolve<MeshObject>(meshes[i]));
      prepared.push_back(objects.back()->mesh);
    }
    std::vector<Detection> found = detect_each(call.model->model, prepared, call.params, call.execution);
    Handles handles;
    handles.made.reserve(found.size());
    for (size_t i = 0; i < found.size(); ++i)
      handles.made.push_back(publish_with_times(call, objects[i], std::move(found[i])));
    std::copy(handles.made.begin(), handles.made.end(), out_detections);
    handles.made.clear();
  });
}

focal_status focal_model_analyse(const focal_model* model, const focal_mesh* mesh,
                                 const focal_detect_params* params, focal_task* task,
                                 focal_analysis** out_analysis) {
  return guarded([&] {
    require(out_analysis, "out_analysis");
    const Call call(model, params, task);
    const auto object = std::make_shared<AnalysisObject>();
    object->mesh = resolve<MeshObject>(mesh);
    std::string note;
    object->analysis =
        analyse_to_keep(call.model->info.params, object->mesh->mesh, call.params, call.execution, note);
    if (!note.empty()) call.model->context->report(FOCAL_LOG_WARNING, note);
    *out_analysis = publish(object, *object->mesh);
  });
}

focal_status focal_model_detect_analysis(const focal_model* model, const focal_analysis* analysis,
                                         const focal_detect_params* params, focal_task* task,
                                         focal_detection** out_detection) {
  return guarded([&] {
    require(out_detection, "out_detection");
    Call call(model, params, task);
    const auto analysed = resolve<AnalysisObject>(analysis);
    call.params.fixed = fixed_places(read_struct(params), call.model->info, *analysed->mesh->mesh);
    Detection detection = detect(call.model->model, analysed->analysis, call.params, call.execution);
    detection.analysis = {analysed, &analysed->analysis};  // kept alive together
    *out_detection = publish_detection(call, analysed->mesh, std::move(detection));
  });
}

focal_status focal_analysis_destroy(focal_analysis* analysis) {
  return remove_handle(analysis, HandleType::analysis);
}

focal_status focal_analysis_save(const focal_analysis* analysis, const char* path) {
  return guarded(
      [&] { write_file_atomically(path_of(path), serialise(resolve<AnalysisObject>(analysis)->analysis)); });
}

focal_status focal_analysis_load(const focal_context* context, const focal_mesh* mesh, const char* path,
                                 focal_analysis** out_analysis) {
  return guarded([&] {
    require(out_analysis, "out_analysis");
    const auto running = resolve<ContextObject>(context);
    const auto object = std::make_shared<AnalysisObject>();
    object->mesh = resolve<MeshObject>(mesh);
    const auto file = path_of(path);
    naming_file(file, [&] {
      object->analysis =
          parse_analysis(read_file(file), object->mesh->mesh, running->execution_with(nullptr));
    });
    *out_analysis = publish(object, *object->mesh);
  });
}

focal_status focal_detection_destroy(focal_detection* detection) {
  return remove_handle(detection, HandleType::detection);
}

uint32_t focal_detection_landmark_count(const focal_detection* detection) {
  return guarded_value<uint32_t>(
      [&] { return resolve<DetectionObject>(detection)->detection.landmarks.size(); });
}

focal_status focal_detection_get_landmark(const focal_detection* detection, uint32_t index,
                                          focal_landmark* out_landmark) {
  return guarded([&] {
    const auto object = resolve<DetectionObject>(detection);
    const auto& landmarks = object->detection.landmarks;
    check_index(index, landmarks.size(), "the detection", "landmarks");
    write_result(out_landmark, to_abi(landmarks[index], object->model->info.landmark_names[index]));
  });
}

focal_status focal_detection_get_info(const focal_detection* detection, focal_detection_info* out_info) {
  return guarded([&] {
    const auto object = resolve<DetectionObject>(detection);
    focal_detection_info info{};
    info.landmark_count = static_cast<uint32_t>(object->detection.landmarks.size());
    info.warning_count = static_cast<uint32_t>(object->warnings.size());
    info.has_votes = object->detection.votes.size() > 0;
    info.vertex_count = static_cast<uint64_t>(object->mesh->mesh->source.vertex_count());
    info.triangle_count = static_cast<uint64_t>(object->mesh->mesh->source.triangle_count());
    info.category_fit = object->detection.category_fit;
    info.backend = object->detection.by_backend ? FOCAL_BACKEND_CUDA : FOCAL_BACKEND_CPU;
    write_result(out_info, info);
  });
}

focal_status focal_detection_get_seconds(const focal_detection* detection, focal_stage_seconds* out_seconds) {
  return guarded([&] {
    const StageSeconds from = resolve<DetectionObject>(detection)->detection.seconds;
    focal_stage_seconds to{};
    to.load = from.load, to.repair = from.repair, to.proxy = from.proxy, to.spectrum = from.spectrum;
    to.descriptors = from.descriptors, to.geodesics = from.geodesics, to.forest = from.forest;
    to.vote = from.vote, to.constellation = from.constellation, to.refine = from.refine;
    to.total = from.total;
    write_result(out_seconds, to);
  });
}

const char* focal_detection_warning(const focal_detection* detection, uint32_t index) {
  return guarded_value<const char*>([&] {
    return text_at(resolve<DetectionObject>(detection)->warnings, index, "the detection", "warnings");
  });
}
