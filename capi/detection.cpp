#include "detection.h"

#include <algorithm>
#include <limits>
#include <mutex>
#include <utility>

#include "analysis.h"
#include "analysis/analysis_file.h"
#include "arguments.h"
#include "base/atomic_file.h"
#include "base/error.h"
#include "boundary.h"
#include "structs.h"
#include "surface_points.h"
#include "task.h"

namespace focal {

template <>
struct StructTraits<focal_detect_params> {
  static constexpr const char* name = "focal_detect_params";
  static constexpr size_t first_size = 56;
  static focal_detect_params defaults();
};
static_assert(sizeof(void*) != 8 ||
              (sizeof(focal_detect_params) == 72 && offsetof(focal_detect_params, fixed_points) == 56));

template <>
struct StructTraits<focal_landmark> {
  static constexpr const char* name = "focal_landmark";
  static constexpr size_t first_size = sizeof(focal_landmark);
  static focal_landmark defaults() { return {}; }
};
static_assert(sizeof(void*) != 8 || (sizeof(focal_landmark) == 112 && offsetof(focal_landmark, point) == 40));

template <>
struct StructTraits<focal_detection_info> {
  static constexpr const char* name = "focal_detection_info";
  static constexpr size_t first_size = 48;
  static focal_detection_info defaults() { return {}; }
};
static_assert(sizeof(focal_detection_info) == 48 && offsetof(focal_detection_info, backend) == 40);

template <>
struct StructTraits<focal_stage_seconds> {
  static constexpr const char* name = "focal_stage_seconds";
  static constexpr size_t first_size = 96;
  static focal_stage_seconds defaults() { return {}; }
};
static_assert(sizeof(focal_stage_seconds) == 96 && offsetof(focal_stage_seconds, total) == 88);

focal_detect_params StructTraits<focal_detect_params>::defaults() {
  const DetectParams params;
  focal_detect_params result{};
  result.quality = static_cast<focal_quality>(params.quality);
  result.sampling_rate = params.sampling_rate;
  result.max_samples = params.max_samples;
  result.peaks_per_landmark = params.peaks_per_landmark;
  result.found_confidence = params.found_confidence;
  result.absent_confidence = params.absent_confidence;
  result.keep_votes = params.keep_votes;
  result.seed = params.seed;
  return result;
}

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
  check_reserved("focal_detect_params", params.reserved);
  DetectParams result;
  result.quality = static_cast<Quality>(params.quality);
  result.sampling_rate = params.sampling_rate;
  result.max_samples = params.max_samples;
  result.peaks_per_landmark = params.peaks_per_landmark;
  result.found_confidence = params.found_confidence;
  result.absent_confidence = params.absent_confidence;
  result.keep_votes = params.keep_votes != 0;
  result.seed = params.seed;
  return result;
}

// On the mesh's surface.
std::vector<std::optional<SurfacePoint>> fixed_places(const focal_detect_params& params,
                                                      const ModelInfo& model, const PreparedMesh& mesh) {
  std::vector<std::optional<SurfacePoint>> places;
  if (!params.fixed_points && params.fixed_point_count == 0) return places;
  require(params.fixed_points, "focal_detect_params.fixed_points");
  if (params.fixed_point_count != model.landmark_names.size())
    throw Error(Status::invalid_argument,
                "focal_detect_params.fixed_point_count is " + std::to_string(params.fixed_point_count) +
                    ", the model has " + std::to_string(model.landmark_names.size()) + " landmarks",
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
        execution(model->context->execution_with(lease.task())) {
    execution.check_cancelled();
  }
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
  return publish(object);
}

focal_detection* publish_with_times(const Call& call, const std::shared_ptr<const MeshObject>& mesh,
                                    Detection detection) {
  detection.seconds.load = mesh->load_seconds;
  detection.seconds.repair = mesh->repair_seconds;
  detection.seconds.total += mesh->load_seconds + mesh->repair_seconds;
  return publish_detection(call, mesh, std::move(detection));
}

// One thread a mesh. An error names the mesh.
std::vector<Detection> detect_each(const Call& call,
                                   const std::vector<std::shared_ptr<const MeshObject>>& meshes) {
  std::vector<Detection> found(meshes.size());
  std::mutex telling;
  size_t done = 0;
  call.execution.begin_stage("detections", 0, 1);
  parallel_for(call.execution, static_cast<int64_t>(meshes.size()), [&](int64_t i) {
    Execution inner = call.execution.inner();
    inner.backend = call.execution.backend;
    try {
      found[i] = detect(call.model->model, meshes[i]->mesh, call.params, inner);
    } catch (const Error& error) {
      throw Error(error.status(), "mesh " + std::to_string(i) + ": " + error.what(), error.hint());
    }
    const std::scoped_lock lock(telling);
    call.execution.report(static_cast<double>(++done) / static_cast<double>(meshes.size()));
  });
  return found;
}

// Handles that are taken back unless all of them were made.
class Handles {
 public:
  ~Handles() {
    for (focal_detection* one : made_) remove_handle(one, HandleType::detection);
  }
  void reserve(size_t count) { made_.reserve(count); }
  void add(focal_detection* one) { made_.push_back(one); }
  void give(focal_detection** out) { std::copy(made_.begin(), made_.end(), out), made_.clear(); }

 private:
  std::vector<focal_detection*> made_;
};

}  // namespace
}  // namespace focal

using namespace focal;

focal_status focal_detect_params_init(focal_detect_params* params, size_t struct_size) {
  return guarded([&] { init_struct(params, struct_size); });
}

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
    for (uint64_t i = 0; i < mesh_count; ++i) objects.push_back(resolve<MeshObject>(meshes[i]));
    std::vector<Detection> found = detect_each(call, objects);
    Handles handles;
    handles.reserve(found.size());
    for (size_t i = 0; i < found.size(); ++i)
      handles.add(publish_with_times(call, objects[i], std::move(found[i])));
    handles.give(out_detections);
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
    *out_analysis = publish(object);
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
    *out_analysis = publish(object);
  });
}

focal_status focal_detection_destroy(focal_detection* detection) {
  return remove_handle(detection, HandleType::detection);
}

focal_status focal_landmark_init(focal_landmark* landmark, size_t struct_size) {
  return guarded([&] { init_struct(landmark, struct_size); });
}

uint32_t focal_detection_landmark_count(const focal_detection* detection) {
  return guarded_value<uint32_t>(0, [&] {
    return static_cast<uint32_t>(resolve<DetectionObject>(detection)->detection.landmarks.size());
  });
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

focal_status focal_detection_info_init(focal_detection_info* info, size_t struct_size) {
  return guarded([&] { init_struct(info, struct_size); });
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

focal_status focal_stage_seconds_init(focal_stage_seconds* seconds, size_t struct_size) {
  return guarded([&] { init_struct(seconds, struct_size); });
}

focal_status focal_detection_get_seconds(const focal_detection* detection, focal_stage_seconds* out_seconds) {
  return guarded([&] {
    const StageSeconds from = resolve<DetectionObject>(detection)->detection.seconds;
    focal_stage_seconds to{};
    to.load = from.load;
    to.repair = from.repair;
    to.proxy = from.proxy;
    to.spectrum = from.spectrum;
    to.descriptors = from.descriptors;
    to.geodesics = from.geodesics;
    to.forest = from.forest;
    to.vote = from.vote;
    to.constellation = from.constellation;
    to.refine = from.refine;
    to.total = from.total;
    write_result(out_seconds, to);
  });
}

const char* focal_detection_warning(const focal_detection* detection, uint32_t index) {
  return guarded_value<const char*>(nullptr, [&] {
    return text_at(resolve<DetectionObject>(detection)->warnings, index, "the detection", "warnings");
  });
}
