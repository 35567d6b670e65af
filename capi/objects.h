// What stands behind each handle.
#pragma once
#include <atomic>
#include <cstddef>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/surface_analysis.h"
#include "base/lazy.h"
#include "base/parallel.h"
#include "base/task.h"
#include "compute/module_loader.h"
#include "correspondence/dense_map.h"
#include "gltf/output_file.h"
#include "handles.h"
#include "landmarks/detect.h"
#include "landmarks/regions.h"
#include "mesh/prepare.h"
#include "model/model_info.h"
#include "model/stock_models.h"
#include "model/training_set.h"
#include "skeleton/character.h"
#include "skeleton/rigged_shapes.h"
#include "skeleton/skeleton_template.h"

namespace focal {

// How calls are run.
struct ContextObject : HandleObject<focal_context, HandleType::context> {
  std::shared_ptr<const Backend> backend;  // null: the CPU
  std::string cpu_reason;                  // then why
  Execution execution;                     // without a task
  focal_log_fn log = nullptr;
  void* log_user_data = nullptr;
  std::string models_folder;  // of the host; empty: none

  focal_backend used_backend() const;
  const char* backend_reason() const;
  Execution execution_with(Task* task) const;  // throws cancelled: the task was, before
  void report(focal_log_level level, const std::string& message) const;
  void report_warnings(const std::vector<std::string>& warnings) const;
  // Looked up once.
  const std::vector<StockModel>& stock() const;

 private:
  Lazy<std::vector<StockModel>> stock_;
};

// What of a scene is not analysed.
struct LeftOut {
  int32_t reason = 0;  // focal_scenery
  std::string name;
  int64_t triangle_count = 0;
  bool is_whole_node = true;
};

// Of the caller's vertices and triangles.
struct MeshPart {
  uint64_t first_vertex = 0, vertex_count = 0, first_triangle = 0, triangle_count = 0;
};

// The caller's triangles, the surface made of them, and the file they came from.
struct MeshObject : HandleObject<focal_mesh, HandleType::mesh> {
  std::shared_ptr<const PreparedMesh> mesh;
  std::vector<float> positions;  // vertex_count x 3, as the caller may read them
  double mean_edge_length = 0, surface_area = 0;
  double load_seconds = 0, repair_seconds = 0;
  std::vector<std::string> warnings;       // of reading, then of preparing
  std::string name;                        // of the file it came from, for messages; or none
  std::shared_ptr<const SourceFile> file;  // the caller's glTF; null if it has none or did not keep it
  std::vector<LeftOut> left_out;
  std::vector<MeshPart> parts;
};
// Throws invalid_argument if it has none: "the mesh has no glTF file to take a skeleton from".
const SourceFile& file_of(const MeshObject& mesh, const char* missing, const std::string& way_out = "");

// What training starts from.
struct TrainingSetObject : HandleObject<focal_training_set, HandleType::training_set> {
  std::shared_ptr<const ContextObject> context;
  TrainingSet set;
  std::vector<RiggedMesh> characters;  // of a set without landmark names: these follow from their skeletons
  std::vector<std::string> warnings;   // of the last check
};

// What training makes and detection uses.
struct ModelObject : HandleObject<focal_model, HandleType::model> {
  std::shared_ptr<const ContextObject> context;
  std::shared_ptr<const LandmarkModel> model;
  ModelInfo info;                               // its joints: those of `by_template`, where there is one
  std::optional<SkeletonTemplate> by_template;  // the skeleton over marked landmarks that it carries

  uint64_t file_bytes() const;  // of the model as a file; written once to find out

 private:
  Lazy<uint64_t> file_bytes_;
};

focal_model* publish_model(std::shared_ptr<const ContextObject> context, LandmarkModel model);

// What is computed of a mesh before any model is asked.
struct AnalysisObject : HandleObject<focal_analysis, HandleType::analysis> {
  std::shared_ptr<const MeshObject> mesh;
  SurfaceAnalysis analysis;
};

// Landmarks found on one mesh.
struct DetectionObject : HandleObject<focal_detection, HandleType::detection> {
  std::shared_ptr<const ModelObject> model;
  std::shared_ptr<const MeshObject> mesh;
  Detection detection;
  std::vector<std::string> warnings;  // the mesh's, then the detection's own

  // Landmarks x vertices of the mesh's surface, made when first asked for. Any thread. Throws unsupported: no votes were kept.
  const RowMatrixf& votes() const;
  // Made when first asked for. Any thread.
  const DistanceFields& distance_fields(const Execution& execution) const;

 private:
  Lazy<RowMatrixf> votes_;
  Lazy<DistanceFields> distances_;
};

void put_landmarks(const DetectionObject& object, SourceFile& source);

// Joints and skin weights for one mesh.
struct SkeletonObject : HandleObject<focal_skeleton, HandleType::skeleton> {
  std::shared_ptr<const ContextObject> context;
  std::shared_ptr<const MeshObject> mesh;
  std::shared_ptr<const DetectionObject> detection;  // null: a skeleton that was there
  Character character;
  bool keeps_joints = false;  // those of the mesh's own file, which gets other weights only
};

// A point of one detected mesh for every vertex of another.
struct CorrespondenceObject : HandleObject<focal_correspondence, HandleType::correspondence> {
  std::shared_ptr<const MeshObject> from, to;
  DenseMap map;
};

// A block of bytes the caller reads.
struct BlobObject : HandleObject<focal_blob, HandleType::blob> {
  std::vector<std::byte> bytes;
};

// Progress and cancellation of one call at a time.
struct TaskObject : HandleObject<focal_task, HandleType::task> {
  Task task;
  std::atomic<bool> busy{false};
};

// Holds the caller's task, which may be NULL, for one call. Unless an exception ends it, the task says then that all is done.
class TaskLease {
 public:
  // Throws invalid_handle; invalid_argument when another call has it; cancelled when it was cancelled before.
  explicit TaskLease(focal_task* handle);
  ~TaskLease();
  TaskLease(const TaskLease&) = delete;
  TaskLease& operator=(const TaskLease&) = delete;

  Task* task() const { return object_ ? &object_->task : nullptr; }

 private:
  std::shared_ptr<TaskObject> object_;
  int exceptions_ = std::uncaught_exceptions();
};

}  // namespace focal
