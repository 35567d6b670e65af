// Regions round the landmarks of a detection.
#include <algorithm>
#include <string>

#include "arguments.h"
#include "base/error.h"
#include "boundary.h"
#include "detection.h"
#include "structs.h"

namespace focal {
namespace {

constexpr double largest_radius = 1e6;  // of sqrt(area): everything

std::vector<float> distances_of(const DetectionObject& object, uint32_t index, uint64_t vertex_count) {
  const auto& landmarks = object.detection.landmarks;
  check_index(index, landmarks.size(), "the detection", "landmarks");
  check_count("vertex_count", vertex_count, static_cast<uint64_t>(object.mesh->mesh->source.vertex_count()),
              "the mesh", "vertices");
  if (landmarks[index].source_point.triangle < 0)
    throw Error(Status::invalid_landmark,
                "landmark \"" + object.model->info.landmark_names[index] + "\" has no place on this mesh",
                "look at focal_landmark.point first");
  const Execution execution = object.model->context->execution_with(nullptr);
  return object.distance_fields(execution).from(landmarks[index].source_point, execution);
}

}  // namespace

const DistanceFields& DetectionObject::distance_fields(const Execution& execution) const {
  return distances_.get([&] { return DistanceFields(detection.proxy, execution); });
}

}  // namespace focal

using namespace focal;

focal_status focal_detection_distances(const focal_detection* detection, uint32_t index,
                                       uint64_t vertex_count, float* out_distances) {
  return guarded([&] {
    require(out_distances, "out_distances");
    const auto distances = distances_of(*resolve<DetectionObject>(detection), index, vertex_count);
    std::copy(distances.begin(), distances.end(), out_distances);
  });
}

focal_status focal_detection_region(const focal_detection* detection, uint32_t index, double radius,
                                    uint64_t vertex_count, float* out_membership) {
  return guarded([&] {
    require(out_membership, "out_membership");
    const auto object = resolve<DetectionObject>(detection);
    check_range("radius", radius, 0, largest_radius);
    const auto shares = membership(distances_of(*object, index, vertex_count),
                                   radius * object->mesh->mesh->scale, object->mesh->mean_edge_length);
    std::copy(shares.begin(), shares.end(), out_membership);
  });
}
