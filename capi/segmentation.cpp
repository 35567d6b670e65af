// The parts of a detected mesh under the model's names.
#include "correspondence/segmentation.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "arguments.h"
#include "base/atomic_file.h"
#include "base/error.h"
#include "boundary.h"
#include "detection.h"
#include "gltf/document.h"
#include "skeleton/rig_transfer.h"
#include "structs.h"
#include "task.h"
#include "vote_colours.h"

namespace focal {
namespace {

// The joint that moves each triangle most.
std::vector<int32_t> segment_by_skeleton(const DetectionObject& object, const Execution& execution) {
  const Detection& detection = object.detection;
  const auto& by_template = object.model->by_template;
  const CharacterRig rig =
      by_template ? rig_by_template(*by_template, detection, execution) : transfer_rig(detection, execution);
  std::vector<int32_t> joint;
  for (const VertexInfluences& influences : rig.rig.influences)
    joint.push_back(influences[0].weight > 0 ? influences[0].joint : -1);
  return triangle_labels(*detection.mesh, joint);
}

std::vector<int32_t> segment(const DetectionObject& object, focal_segmentation method,
                             const Execution& execution) {
  check_range("method", method, FOCAL_SEGMENTATION_AUTO, FOCAL_SEGMENTATION_SKELETON);
  const bool has_skeleton = !object.model->info.joint_names.empty();
  if (method == FOCAL_SEGMENTATION_AUTO)
    method = has_skeleton ? FOCAL_SEGMENTATION_SKELETON : FOCAL_SEGMENTATION_GEODESIC;
  if (method == FOCAL_SEGMENTATION_SKELETON) return segment_by_skeleton(object, execution);
  if (method == FOCAL_SEGMENTATION_K_MEANS) return segment_k_means(object.detection, execution);
  return segment_geodesic(object.detection, execution);
}

// Every triangle with corners of its own, so that colours end where parts do.
std::vector<std::byte> coloured(const TriangleMesh& mesh, const std::vector<int32_t>& labels) {
  const auto count = static_cast<Eigen::Index>(mesh.triangle_count());
  TriangleMesh split{MatrixX3(3 * count, 3), MatrixX3i(count, 3)};
  RowMatrixf colours(3 * count, 3);
  for (Eigen::Index t = 0; t < count; ++t)
    for (int i = 0; i < 3; ++i) {
      split.positions.row(3 * t + i) = mesh.positions.row(mesh.triangles(t, i));
      split.triangles(t, i) = static_cast<int32_t>(3 * t + i);
      colours.row(3 * t + i) = labels[t] < 0 ? Eigen::RowVector3f(0.5F, 0.5F, 0.5F) : label_colour(labels[t]);
    }
  return write_glb(split, colours, "parts");
}

}  // namespace
}  // namespace focal

using namespace focal;

focal_status focal_detection_segment(const focal_detection* detection, focal_segmentation method,
                                     focal_task* task, uint64_t triangle_count, int32_t* out_labels) {
  return guarded([&] {
    require(out_labels, "out_labels");
    const auto object = resolve<DetectionObject>(detection);
    check_count("triangle_count", triangle_count,
                static_cast<uint64_t>(object->mesh->mesh->source.triangle_count()), "the mesh", "triangles");
    const TaskLease lease(task);
    const Execution execution = object->model->context->execution_with(lease.task());
    execution.check_cancelled();
    const auto labels = segment(*object, method, execution);
    std::copy(labels.begin(), labels.end(), out_labels);
  });
}

focal_status focal_detection_write_segments_gltf(const focal_detection* detection, focal_segmentation method,
                                                 const char* path) {
  return guarded([&] {
    const auto object = resolve<DetectionObject>(detection);
    const auto file = path_of(path);
    check_suffix(file, true);
    const auto labels = segment(*object, method, object->model->context->execution_with(nullptr));
    write_file_atomically(file, coloured(object->mesh->mesh->source, labels));
  });
}
