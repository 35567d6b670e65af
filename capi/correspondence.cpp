#include "correspondence.h"

#include <algorithm>
#include <string>

#include "arguments.h"
#include "base/error.h"
#include "boundary.h"
#include "structs.h"
#include "surface_points.h"
#include "task.h"

namespace focal {
namespace {

void check_vertices(const char* name, uint64_t count, const MeshObject& mesh) {
  check_count(name, count, static_cast<uint64_t>(mesh.mesh->source.vertex_count()), "the mesh", "vertices");
}

}  // namespace
}  // namespace focal

using namespace focal;

focal_status focal_correspondence_create(const focal_detection* source, const focal_detection* target,
                                         focal_task* task, focal_correspondence** out_correspondence) {
  return guarded([&] {
    require(out_correspondence, "out_correspondence");
    const auto from = resolve<DetectionObject>(source), to = resolve<DetectionObject>(target);
    const TaskLease lease(task);
    const Execution execution = from->model->context->execution_with(lease.task());
    execution.check_cancelled();
    const auto object = std::make_shared<CorrespondenceObject>();
    object->from = from->mesh, object->to = to->mesh;
    object->map = dense_map(from->detection, to->detection, execution);
    *out_correspondence = publish(object);
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
