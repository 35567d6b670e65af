// A point of one detected mesh for every vertex of another, and the parts of one under the model's names.
#include <algorithm>

#include "arguments.h"
#include "base/atomic_file.h"
#include "boundary.h"
#include "correspondence/segmentation.h"
#include "objects.h"
#include "skeleton/rig_transfer.h"

using namespace focal;

namespace {

void check_vertices(const char* name, uint64_t count, const MeshObject& mesh) {
  check_count(name, count, static_cast<uint64_t>(mesh.mesh->source.vertex_count()), "the mesh", "vertices");
}

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

}  // namespace

focal_status focal_correspondence_create(const focal_detection* source, const focal_detection* target,
                                         focal_task* task, focal_correspondence** out_correspondence) {
  return guarded([&] {
    require(out_correspondence, "out_correspondence");
    const auto from = resolve<DetectionObject>(source), to = resolve<DetectionObject>(target);
    const TaskLease lease(task);
    const Execution execution = from->model->context->execution_with(lease.task());
    const auto object = std::make_shared<CorrespondenceObject>();
    object->from = from->mesh, object->to = to->mesh;
    object->map = dense_map(from->detection, to->detection, execution);
    *out_correspondence = publish(object, *from->mesh);
  });
}

focal_status focal_correspondence_destroy(focal_correspondence* correspondence) {
  return remove_handle(correspondence, HandleType::correspondence);
}

focal_status focal_correspondence_points(const focal_correspondence* correspondence, uint64_t vertex_count,
                                         focal_surface_point* out_points) {
  return guarded([&] {
    require(out_points, "out_points");
    const auto object = resolve<CorrespondenceObject>(correspondence);
    check_vertices("vertex_count", vertex_count, *object->from);
    for (size_t v = 0; v < object->map.point.size(); ++v) out_points[v] = point_out(object->map.point[v]);
  });
}

focal_status focal_correspondence_carry(const focal_correspondence* correspondence,
                                        uint64_t target_vertex_count, const float* target_values,
                                        uint64_t vertex_count, float* out_values) {
  return guarded([&] {
    require(target_values, "target_values");
    require(out_values, "out_values");
    const auto object = resolve<CorrespondenceObject>(correspondence);
    check_vertices("target_vertex_count", target_vertex_count, *object->to);
    check_vertices("vertex_count", vertex_count, *object->from);
    const Eigen::Map<const RowMatrixf> values(target_values, static_cast<Eigen::Index>(target_vertex_count),
                                              1);
    const RowMatrixf carried = pulled_back(object->map, *object->to->mesh, values);
    std::copy_n(carried.data(), carried.size(), out_values);
  });
}

focal_status focal_detection_segment(const focal_detection* detection, focal_segmentation method,
                                     focal_task* task, uint64_t triangle_count, int32_t* out_labels) {
  return guarded([&] {
    require(out_labels, "out_labels");
    const auto object = resolve<DetectionObject>(detection);
    check_count("triangle_count", triangle_count,
                static_cast<uint64_t>(object->mesh->mesh->source.triangle_count()), "the mesh", "triangles");
    const TaskLease lease(task);
    const Execution execution = object->model->context->execution_with(lease.task());
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
    const ColouredMesh parts = coloured(object->mesh->mesh->source, labels);
    write_file_atomically(file, write_glb(parts.mesh, parts.colours, "parts"));
  });
}
