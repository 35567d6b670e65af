// What leaves a detection in bulk: vote maps and files.
#include <algorithm>
#include <mutex>
#include <string>
#include <utility>

#include "arguments.h"
#include "base/atomic_file.h"
#include "base/error.h"
#include "boundary.h"
#include "detection.h"
#include "vote_colours.h"

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

// Landmarks x vertices of the proxy, as values of the full surface; the largest of each is 1.
RowMatrixf carried_over(const RowMatrixf& votes, const Proxy& proxy, const Execution& execution) {
  const auto places = coarse_place_of_vertices(proxy, execution);
  RowMatrixf result = RowMatrixf::Zero(votes.rows(), static_cast<Eigen::Index>(places.size()));
  for (size_t v = 0; v < places.size(); ++v)
    for (int i = 0; i < 3; ++i)
      result.col(v) += static_cast<float>(places[v].barycentric[i]) *
                       votes.col(proxy.coarse->surface.triangles(places[v].triangle, i));
  for (Eigen::Index l = 0; l < result.rows(); ++l)
    result.row(l) /= std::max(result.row(l).maxCoeff(), 1e-30f);
  return result;
}

}  // namespace

void put_landmarks(const DetectionObject& object, SourceFile& source) {
  source.document.add_landmarks(source.primitives, landmarks_of(object));
}

const RowMatrixf& DetectionObject::full_votes() const {
  if (detection.votes.size() == 0)
    throw Error(Status::unsupported, "the detection has no vote maps",
                "detect with focal_detect_params.keep_votes 1");
  if (detection.proxy.is_full()) return detection.votes;
  return votes_.get([&] {
    return carried_over(detection.votes, detection.proxy, model->context->execution_with(nullptr));
  });
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
    const auto votes = object->full_votes().row(index);
    for (size_t v = 0; v < surface_vertex.size(); ++v)
      out_votes[v] = surface_vertex[v] < 0 ? 0 : votes(surface_vertex[v]);
  });
}

focal_status focal_detection_write_gltf(const focal_detection* detection, const char* path) {
  return guarded([&] {
    const auto object = resolve<DetectionObject>(detection);
    const auto file = path_of(path);
    SourceFile source = source_file(*object->mesh, file);
    put_landmarks(*object, source);
    object->model->context->report_warnings(write_document(source.document, file));
  });
}

focal_status focal_detection_write_votes_gltf(const focal_detection* detection, const char* path) {
  return guarded([&] {
    const auto object = resolve<DetectionObject>(detection);
    const auto file = path_of(path);
    check_suffix(file, true);
    TriangleMesh surface = object->mesh->mesh->surface;
    surface.positions *= object->mesh->mesh->scale;
    surface.positions.rowwise() += object->mesh->mesh->centre.transpose();
    write_file_atomically(file, write_glb(surface, vote_colours(object->full_votes()), "votes"));
  });
}
