// focal.hpp - owning handles and exceptions over focal.h, for C++17 and later. Header only; every call forwards to
// one function of focal.h, whose rules apply (shapes, units, errors, threads). A failed call throws focal::Error.
//
//   focal::Context context;
//   focal::Model model(context, "humans.focal");
//   focal::Mesh mesh(context, "character.glb");
//   focal::Detection detection = model.detect(mesh);
//   for (const focal_landmark& landmark : detection.landmarks()) use(landmark.name, landmark.position);
#ifndef FOCAL_HPP
#define FOCAL_HPP

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "focal/focal.h"

namespace focal {
inline namespace abi {

// Carries the focal_status of a failed call; what() is the text of focal_last_error().
class Error : public std::runtime_error {
 public:
  Error(focal_status status, const std::string& text) : std::runtime_error(text), status_(status) {}
  focal_status status() const noexcept { return status_; }

 private:
  focal_status status_;
};

// Throws Error unless the status is FOCAL_OK.
inline void check(focal_status status) {
  if (status != FOCAL_OK) throw Error(status, focal_last_error());
}

// Returns a struct of focal.h with its struct_size and defaults set: auto params = focal::init(focal_train_params_init);
template <class T>
T init(focal_status (*initialise)(T*, size_t)) {
  T value;
  check(initialise(&value, sizeof value));
  return value;
}

// Owns one handle: movable, not copyable, destroys the handle at the end.
template <class Handle, focal_status (*destroy)(Handle*)>
class Owner {
 public:
  Owner() = default;
  explicit Owner(Handle* handle) : handle_(handle) {}
  Owner(Owner&& other) noexcept : handle_(std::exchange(other.handle_, nullptr)) {}
  Owner& operator=(Owner&& other) noexcept {
    std::swap(handle_, other.handle_);
    return *this;
  }
  ~Owner() { destroy(handle_); }
  Handle* get() const noexcept { return handle_; }
  explicit operator bool() const noexcept { return handle_ != nullptr; }

 protected:
  Handle* handle_ = nullptr;
};

class Context : public Owner<focal_context, focal_context_destroy> {
 public:
  explicit Context(const focal_context_params* params = nullptr) {
    check(focal_context_create(params, &handle_));
  }
  focal_backend backend() const { return focal_context_backend(handle_); }
  std::string backend_reason() const { return focal_context_backend_reason(handle_); }
  int thread_count() const { return focal_context_thread_count(handle_); }
  std::vector<std::string> stock_models() const {
    std::vector<std::string> result;
    for (uint32_t i = 0, count = focal_context_stock_count(handle_); i < count; ++i)
      result.emplace_back(focal_context_stock_name(handle_, i));
    return result;
  }
};

class Task : public Owner<focal_task, focal_task_destroy> {
 public:
  Task() { check(focal_task_create(&handle_)); }
  void cancel() { check(focal_task_cancel(handle_)); }
  void reset() { check(focal_task_reset(handle_)); }
  double progress() const { return focal_task_progress(handle_); }
  const char* stage() const { return focal_task_stage(handle_); }
  bool is_cancelled() const { return focal_task_is_cancelled(handle_) != 0; }
};

class Blob : public Owner<focal_blob, focal_blob_destroy> {
 public:
  using Owner::Owner;
  const void* data() const { return focal_blob_data(handle_); }
  size_t size() const { return static_cast<size_t>(focal_blob_size(handle_)); }
};

class Mesh : public Owner<focal_mesh, focal_mesh_destroy> {
 public:
  Mesh(const Context& context, const std::string& path, const focal_mesh_params* params = nullptr) {
    check(focal_mesh_load_gltf(context.get(), path.c_str(), params, &handle_));
  }
  Mesh(const Context& context, const void* gltf, size_t size, const focal_mesh_params* params = nullptr) {
    check(focal_mesh_load_gltf_memory(context.get(), gltf, size, params, &handle_));
  }
  Mesh(const Context& context, const focal_mesh_desc& desc, const focal_mesh_params* params = nullptr) {
    check(focal_mesh_create(context.get(), &desc, params, &handle_));
  }
  focal_mesh_info info() const {
    auto info = init(focal_mesh_info_init);
    check(focal_mesh_get_info(handle_, &info));
    return info;
  }
  const float* positions() const { return focal_mesh_positions(handle_); }
  const uint32_t* triangles() const { return focal_mesh_triangles(handle_); }
  std::vector<std::string> warnings() const {
    std::vector<std::string> result;
    for (uint32_t i = 0, count = info().warning_count; i < count; ++i)
      result.emplace_back(focal_mesh_warning(handle_, i));
    return result;
  }
  // Writes the closed surface around the mesh as a .glb for inspection.
  void write_wrap_gltf(const std::string& path) const {
    check(focal_mesh_write_wrap_gltf(handle_, path.c_str()));
  }
  focal_surface_point point_at_vertex(uint32_t vertex) const {
    focal_surface_point point{};
    check(focal_mesh_point_at_vertex(handle_, vertex, &point));
    return point;
  }
  // The point of the surface nearest to a position of 3 floats.
  focal_surface_point closest_point(const float* position) const {
    focal_surface_point point{};
    check(focal_mesh_closest_point(handle_, position, &point));
    return point;
  }
  // Descriptors of the given vertices: vertices.size() x focal_descriptor_dimension(descriptor), row-major.
  std::vector<float> describe(const Context& context, focal_descriptor descriptor,
                              const std::vector<uint32_t>& vertices, Task* task = nullptr) const {
    std::vector<float> result(vertices.size() * focal_descriptor_dimension(descriptor));
    check(focal_mesh_describe(context.get(), handle_, descriptor, vertices.data(), vertices.size(),
                              task ? task->get() : nullptr, result.data()));
    return result;
  }
  // Distance from the source to each vertex, in the mesh's units; INFINITY where no triangle uses the vertex.
  std::vector<float> distances(const Context& context, focal_distance distance,
                               const focal_surface_point& source, Task* task = nullptr) const {
    std::vector<float> result(static_cast<size_t>(info().vertex_count));
    check(focal_mesh_distances(context.get(), handle_, distance, &source, task ? task->get() : nullptr,
                               result.size(), result.data()));
    return result;
  }
  focal_symmetry_plane symmetry_plane(const Context& context, uint64_t seed = 0, Task* task = nullptr) const {
    auto plane = init(focal_symmetry_plane_init);
    check(focal_mesh_symmetry_plane(context.get(), handle_, seed, task ? task->get() : nullptr, &plane));
    return plane;
  }
};

class Analysis : public Owner<focal_analysis, focal_analysis_destroy> {
 public:
  using Owner::Owner;
  static Analysis load(const Context& context, const Mesh& mesh, const std::string& path) {
    focal_analysis* analysis = nullptr;
    check(focal_analysis_load(context.get(), mesh.get(), path.c_str(), &analysis));
    return Analysis(analysis);
  }
  void save(const std::string& path) const { check(focal_analysis_save(handle_, path.c_str())); }
  uint64_t sample_count() const { return focal_analysis_sample_count(handle_); }
};

class Detection : public Owner<focal_detection, focal_detection_destroy> {
 public:
  using Owner::Owner;
  // One entry per landmark of the model; the names are borrowed from this detection.
  std::vector<focal_landmark> landmarks() const {
    std::vector<focal_landmark> result(info().landmark_count, init(focal_landmark_init));
    for (size_t i = 0; i < result.size(); ++i)
      check(focal_detection_get_landmark(handle_, static_cast<uint32_t>(i), &result[i]));
    return result;
  }
  focal_detection_info info() const {
    auto info = init(focal_detection_info_init);
    check(focal_detection_get_info(handle_, &info));
    return info;
  }
  focal_stage_seconds seconds() const {
    auto seconds = init(focal_stage_seconds_init);
    check(focal_detection_get_seconds(handle_, &seconds));
    return seconds;
  }
  std::vector<std::string> warnings() const {
    std::vector<std::string> result;
    for (uint32_t i = 0, count = info().warning_count; i < count; ++i)
      result.emplace_back(focal_detection_warning(handle_, i));
    return result;
  }
  // Vote map of one landmark: a value in 0..1 for each of the caller's vertices.
  std::vector<float> votes(uint32_t landmark) const {
    std::vector<float> result(static_cast<size_t>(info().vertex_count));
    check(focal_detection_votes(handle_, landmark, result.size(), result.data()));
    return result;
  }
  // Geodesic distance from one landmark to each of the caller's vertices, in the mesh's units.
  std::vector<float> distances(uint32_t landmark) const {
    std::vector<float> result(static_cast<size_t>(info().vertex_count));
    check(focal_detection_distances(handle_, landmark, result.size(), result.data()));
    return result;
  }
  // A label for each of the caller's triangles, -1 for no label.
  std::vector<int32_t> segments(focal_segmentation method) const {
    std::vector<int32_t> result(static_cast<size_t>(info().triangle_count));
    check(focal_detection_segment(handle_, method, nullptr, result.size(), result.data()));
    return result;
  }
  // Membership (0..1) of each of the caller's vertices in the region within radius, a share of sqrt(surface area),
  // of one landmark.
  std::vector<float> region(uint32_t landmark, double radius) const {
    std::vector<float> result(static_cast<size_t>(info().vertex_count));
    check(focal_detection_region(handle_, landmark, radius, result.size(), result.data()));
    return result;
  }
  void write_gltf(const std::string& path) const { check(focal_detection_write_gltf(handle_, path.c_str())); }
  void write_votes_gltf(const std::string& path) const {
    check(focal_detection_write_votes_gltf(handle_, path.c_str()));
  }
};

class TrainingSet : public Owner<focal_training_set, focal_training_set_destroy> {
 public:
  TrainingSet(const Context& context, const std::vector<std::string>& landmark_names) {
    std::vector<const char*> names;
    for (const std::string& name : landmark_names) names.push_back(name.c_str());
    check(focal_training_set_create(context.get(), names.data(), names.size(), &handle_));
  }
  void add(const Mesh& mesh, const std::vector<focal_surface_point>& landmarks) {
    check(focal_training_set_add(handle_, mesh.get(), landmarks.data(), landmarks.size()));
  }
  void add_vertices(const Mesh& mesh, const std::vector<uint32_t>& vertices) {
    check(focal_training_set_add_vertices(handle_, mesh.get(), vertices.data(), vertices.size()));
  }
};

class Model : public Owner<focal_model, focal_model_destroy> {
 public:
  using Owner::Owner;
  // Loads a stock model by its name, see Context::stock_models.
  static Model stock(const Context& context, const std::string& name) {
    focal_model* model = nullptr;
    check(focal_model_load_stock(context.get(), name.c_str(), &model));
    return Model(model);
  }
  Model(const TrainingSet& set, const focal_train_params* params = nullptr, Task* task = nullptr) {
    check(focal_model_train(set.get(), params, task ? task->get() : nullptr, &handle_));
  }
  Model(const Context& context, const std::string& path) {
    check(focal_model_load(context.get(), path.c_str(), &handle_));
  }
  Model(const Context& context, const void* data, size_t size) {
    check(focal_model_load_memory(context.get(), data, size, &handle_));
  }
  void save(const std::string& path) const { check(focal_model_save(handle_, path.c_str())); }
  Blob save() const {
    focal_blob* blob = nullptr;
    check(focal_model_save_memory(handle_, &blob));
    return Blob(blob);
  }
  focal_model_info info() const {
    auto info = init(focal_model_info_init);
    check(focal_model_get_info(handle_, &info));
    return info;
  }
  focal_train_params train_params() const {
    auto params = init(focal_train_params_init);
    check(focal_model_get_train_params(handle_, &params));
    return params;
  }
  std::vector<std::string> landmark_names() const {
    std::vector<std::string> result;
    for (uint32_t i = 0, count = info().landmark_count; i < count; ++i)
      result.emplace_back(focal_model_landmark_name(handle_, i));
    return result;
  }
  Detection detect(const Mesh& mesh, const focal_detect_params* params = nullptr,
                   Task* task = nullptr) const {
    focal_detection* detection = nullptr;
    check(focal_model_detect(handle_, mesh.get(), params, task ? task->get() : nullptr, &detection));
    return Detection(detection);
  }
  // Analyses a mesh once, for detection with several models.
  Analysis analyse(const Mesh& mesh, const focal_detect_params* params = nullptr,
                   Task* task = nullptr) const {
    focal_analysis* analysis = nullptr;
    check(focal_model_analyse(handle_, mesh.get(), params, task ? task->get() : nullptr, &analysis));
    return Analysis(analysis);
  }
  struct Regression {
    std::vector<float> regressed, truth;  // one value per sample of the analysis
  };
  Regression regress(const Analysis& analysis, uint32_t landmark, const focal_surface_point& truth,
                     Task* task = nullptr) const {
    Regression result;
    result.regressed.resize(static_cast<size_t>(analysis.sample_count()));
    result.truth.resize(result.regressed.size());
    check(focal_model_regress(handle_, analysis.get(), landmark, &truth, task ? task->get() : nullptr,
                              result.truth.size(), result.regressed.data(), result.truth.data()));
    return result;
  }
  std::vector<Detection> detect_many(const std::vector<const Mesh*>& meshes,
                                     const focal_detect_params* params = nullptr,
                                     Task* task = nullptr) const {
    std::vector<const focal_mesh*> handles;
    for (const Mesh* mesh : meshes) handles.push_back(mesh->get());
    std::vector<focal_detection*> found(meshes.size());
    check(focal_model_detect_many(handle_, handles.data(), handles.size(), params,
                                  task ? task->get() : nullptr, found.data()));
    return {found.begin(), found.end()};
  }
  Detection detect(const Analysis& analysis, const focal_detect_params* params = nullptr,
                   Task* task = nullptr) const {
    focal_detection* detection = nullptr;
    check(focal_model_detect_analysis(handle_, analysis.get(), params, task ? task->get() : nullptr,
                                      &detection));
    return Detection(detection);
  }
};

}  // namespace abi
}  // namespace focal

#endif  // FOCAL_HPP
