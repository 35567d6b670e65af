// What leaves a detection in bulk: vote maps, distances and regions, files.
#include <algorithm>

#include "arguments.h"
#include "base/atomic_file.h"
#include "boundary.h"
#include "landmarks/vote_maps.h"
#include "objects.h"

namespace focal {
namespace {

std::vector<GltfLandmark> landmarks_of(const DetectionObject& object) {
  std::vector<GltfLandmark> result;
  for (size_t i = 0; i < object.detection.landmarks.size(); ++i) {
    const DetectedLandmark& from = object.detection.landmarks[i];
    result.push_back({object.model->info.landmark_names[i], from.source_point, from.position, from.confidence,
                      from.status});
  }
  return result;
}

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

void put_landmarks(const DetectionObject& object, SourceFile& source) {
  source.document.add_landmarks(source.primitives, landmarks_of(object));
}

const RowMatrixf& DetectionObject::votes() const {
  if (detection.votes.size() == 0)
    throw Error(Status::unsupported, "the detection has no vote maps",
                "detect with focal_detect_params.keep_votes 1");
  if (detection.proxy.is_full()) return detection.votes;
  return votes_.get([&] { return full_votes(detection, model->context->execution_with(nullptr)); });
}

const DistanceFields& DetectionObject::distance_fields(const Execution& execution) const {
  return distances_.get([&] { return DistanceFields(detection.proxy, execution); });
}

}  // namespace focal

using namespace focal;

focal_status focal_detection_votes(const focal_detection* detection, uint32_t index, uint64_t vertex_count,
                                   float* out_votes) {
  return guarded([&] {
    require(out_votes, "out_votes");
    const auto object = resolve<DetectionObject>(detection);
    const auto& surface_vertex = object->mesh->mesh->surface_vertex;
    check_index(index, object->detection.landmarks.size(), "the detection", "landmarks");
    check_count("vertex_count", vertex_count, surface_vertex.size(), "the mesh", "vertices");
    const auto votes = object->votes().row(index);
    for (size_t v = 0; v < surface_vertex.size(); ++v)
      out_votes[v] = surface_vertex[v] < 0 ? 0 : votes(surface_vertex[v]);
  });
}

focal_status focal_detection_write_gltf(const focal_detection* detection, const char* path) {
  return guarded([&] {
    const auto object = resolve<DetectionObject>(detection);
    const auto file = path_of(path);
    SourceFile source = source_file(object->mesh->file.get(), object->mesh->mesh->source, file);
    put_landmarks(*object, source);
    object->model->context->report_warnings(write_document(source.document, file));
  });
}

focal_status focal_detection_write_votes_gltf(const focal_detection* detection, const char* path) {
  return guarded([&] {
    const auto object = resolve<DetectionObject>(detection);
    const auto file = path_of(path);
    check_suffix(file, true);
    const PreparedMesh& mesh = *object->mesh->mesh;
    write_file_atomically(
        file, write_glb(in_source_coordinates(mesh.surface, mesh), vote_colours(object->votes()), "votes"));
  });
}

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
