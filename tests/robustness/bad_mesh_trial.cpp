#include "bad_mesh_trial.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <set>
#include <stdexcept>

namespace focal_bad_meshes {
namespace {

// A promise that is not kept.
struct Broken : std::runtime_error {
  using std::runtime_error::runtime_error;
};
// An error of the library that may be.
struct Refused : std::runtime_error {
  using std::runtime_error::runtime_error;
};

template <auto destroy>
struct Destroyer {
  template <class Handle>
  void operator()(Handle* handle) const {
    destroy(handle);
  }
};
using Mesh = std::unique_ptr<focal_mesh, Destroyer<focal_mesh_destroy>>;
using Analysis = std::unique_ptr<focal_analysis, Destroyer<focal_analysis_destroy>>;
using Detection = std::unique_ptr<focal_detection, Destroyer<focal_detection_destroy>>;
using Correspondence = std::unique_ptr<focal_correspondence, Destroyer<focal_correspondence_destroy>>;

void insist(bool promise, const std::string& what) {
  if (!promise) throw Broken(what);
}

void check(focal_status status) {
  if (status == FOCAL_OK) return;
  const std::string error = focal_last_error(), name = focal_status_name(status);
  const bool expected = status == FOCAL_ERROR_INVALID_MESH || status == FOCAL_ERROR_MESH_TOO_SMALL ||
                        status == FOCAL_ERROR_NOT_CONVERGED;
  insist(expected && error.find("\nhint: ") > 0 && error.find("\nhint: ") != std::string::npos,
         name + " is no clear error: " + error);
  throw Refused(name + ": " + error.substr(0, error.find('\n')));
}

template <class Struct>
Struct initialised(focal_status (*init)(Struct*, size_t)) {
  Struct value;
  insist(init(&value, sizeof value) == FOCAL_OK, "init");
  return value;
}

focal_mesh_info info_of(const focal_mesh* mesh) {
  auto info = initialised(focal_mesh_info_init);
  insist(focal_mesh_get_info(mesh, &info) == FOCAL_OK, "mesh info");
  insist(info.mean_edge_length > 0 && std::isfinite(info.mean_edge_length), "mean edge length");
  insist(info.surface_area > 0 && std::isfinite(info.surface_area), "surface area");
  insist(info.component_count > 0 && info.surface_triangle_count > 0, "counts");
  insist(info.surface_triangle_count + info.invalid_triangles + info.degenerate_triangles +
                 info.left_out_triangles ==
             info.triangle_count,
         "counts of triangles");
  return info;
}

void check_point(const focal_mesh* mesh, const focal_mesh_info& info, const focal_surface_point& point,
                 const float* position) {
  insist(point.triangle < info.triangle_count, "the triangle of a landmark");
  float sum = 0;
  for (const float weight : point.barycentric) {
    insist(weight >= 0 && weight <= 1.00001f, "a barycentric weight");
    sum += weight;
  }
  insist(std::abs(sum - 1) < 1e-4f, "barycentric weights");
  if (!position) return;
  float there[3];
  insist(focal_mesh_position_of(mesh, &point, there) == FOCAL_OK, "the position of a landmark's point");
  const uint32_t* corner = focal_mesh_triangles(mesh) + 3 * size_t{point.triangle};
  float size = 0;  // of what rounding is a share of
  for (int k = 0; k < 3; ++k)
    for (int i = 0; i < 3; ++i)
      size = std::max(size,
                      std::abs(focal_mesh_positions(mesh)[3 * size_t{corner[k]} + static_cast<size_t>(i)]));
  for (int i = 0; i < 3; ++i)
    insist(std::isfinite(position[i]) && std::abs(there[i] - position[i]) <= 1e-5f * size,
           "the position of a landmark is not that of its point");
}

void check_landmark(const focal_mesh* mesh, const focal_mesh_info& info, const focal_landmark& landmark) {
  insist(landmark.confidence >= 0 && landmark.confidence <= 1, "a confidence");
  insist(landmark.expected_error >= 0 && std::isfinite(landmark.expected_error), "an expected error");
  if (landmark.point.triangle == FOCAL_NO_TRIANGLE) {
    insist(landmark.status == FOCAL_LANDMARK_ABSENT, "a landmark without a place");
    return;
  }
  check_point(mesh, info, landmark.point, landmark.position);
  insist(landmark.vertex < info.vertex_count, "the vertex of a landmark");
  if (landmark.has_runner_up) check_point(mesh, info, landmark.runner_up_point, landmark.runner_up_position);
}

// Votes, distances and a region of one landmark, and the parts of the surface.
void check_fields(const focal_detection* detection, const focal_mesh_info& info, uint32_t landmark) {
  std::vector<float> values(info.vertex_count);
  check(focal_detection_votes(detection, landmark, info.vertex_count, values.data()));
  for (const float vote : values) insist(vote >= 0 && vote <= 1, "a vote");
  check(focal_detection_distances(detection, landmark, info.vertex_count, values.data()));
  const bool any_finite = std::any_of(values.begin(), values.end(), [](float d) { return std::isfinite(d); });
  for (const float distance : values) insist(distance >= 0, "a distance");  // infinite: no way leads there
  insist(any_finite, "distances");
  check(focal_detection_region(detection, landmark, 0.2, info.vertex_count, values.data()));
  for (const float member : values) insist(member >= 0 && member <= 1, "a region");
  std::vector<int32_t> labels(info.triangle_count);
  for (const focal_segmentation method : {FOCAL_SEGMENTATION_GEODESIC, FOCAL_SEGMENTATION_K_MEANS}) {
    check(focal_detection_segment(detection, method, nullptr, info.triangle_count, labels.data()));
    for (const int32_t label : labels) insist(label >= -1 && label < 1000, "a label");
  }
}

void check_correspondence(const focal_detection* detection, const focal_mesh* mesh,
                          const focal_mesh_info& info) {
  focal_correspondence* made = nullptr;
  const focal_status status = focal_correspondence_create(detection, detection, nullptr, &made);
  if (status == FOCAL_ERROR_INVALID_ARGUMENT) return;  // fewer than three landmarks found
  check(status);
  const Correspondence map(made);
  std::vector<focal_surface_point> points(info.vertex_count);
  check(focal_correspondence_points(made, info.vertex_count, points.data()));
  for (const auto& point : points)
    if (point.triangle != FOCAL_NO_TRIANGLE) check_point(mesh, info, point, nullptr);
}

void try_detection(const focal_model* model, const focal_mesh* mesh) {
  const focal_mesh_info info = info_of(mesh);
  focal_analysis* analysed = nullptr;
  check(focal_model_analyse(model, mesh, nullptr, nullptr, &analysed));
  const Analysis analysis(analysed);
  focal_detection* found = nullptr;
  check(focal_model_detect_analysis(model, analysed, nullptr, nullptr, &found));
  const Detection quick(found);
  check(focal_model_detect(model, mesh, nullptr, nullptr, &found));
  const Detection detection(found);
  uint32_t placed = FOCAL_NO_VERTEX;
  for (uint32_t l = 0; l < focal_detection_landmark_count(found); ++l) {
    auto landmark = initialised(focal_landmark_init), again = landmark;
    check(focal_detection_get_landmark(found, l, &landmark));
    check(focal_detection_get_landmark(quick.get(), l, &again));
    check_landmark(mesh, info, landmark);
    insist(std::memcmp(landmark.position, again.position, sizeof again.position) == 0,
           "detection and detection on an analysis differ");
    if (landmark.point.triangle != FOCAL_NO_TRIANGLE) placed = l;
  }
  auto about = initialised(focal_detection_info_init);
  check(focal_detection_get_info(found, &about));
  insist(about.category_fit >= 0 && about.category_fit <= 1, "the category fit");
  insist(placed != FOCAL_NO_VERTEX, "no landmark has a place");
  check_fields(found, info, placed);
  check_correspondence(found, mesh, info);
}

// Strictly first, which must refuse what is not valid; then leniently.
template <class Make>
Verdict judge(const focal_model* model, bool must_be_refused, const Make& make) {
  try {
    auto params = initialised(focal_mesh_params_init);
    focal_mesh* made = nullptr;
    if (must_be_refused) {
      insist(make(params, &made) == FOCAL_ERROR_INVALID_MESH, "an invalid mesh is not refused");
      params.lenient = 1;
    }
    check(make(params, &made));
    const Mesh mesh(made);
    try_detection(model, made);
    return {Outcome::usable, {}};
  } catch (const Refused& error) {
    return {Outcome::refused, error.what()};
  } catch (const Broken& error) {
    return {Outcome::broken, error.what()};
  }
}

bool names_valid_corners(const BadMesh& mesh, uint32_t t) {
  for (int i = 0; i < 3; ++i) {
    const uint32_t v = mesh.indices[3 * t + static_cast<uint32_t>(i)];
    if (v >= mesh.vertex_count()) return false;
    const float* p = &mesh.positions[3 * v];
    if (!std::isfinite(p[0]) || !std::isfinite(p[1]) || !std::isfinite(p[2])) return false;
  }
  return true;
}

}  // namespace

bool is_valid(const BadMesh& mesh) {
  for (const float x : mesh.positions)
    if (!std::isfinite(x)) return false;
  for (const uint32_t v : mesh.indices)
    if (v >= mesh.vertex_count()) return false;
  return true;
}

bool should_be_usable(const BadMesh& mesh) {
  using Point = std::array<double, 3>;
  std::set<Point> places;
  double area = 0, largest = 0;
  Point low{}, high{};
  for (uint32_t t = 0; t < mesh.triangle_count(); ++t) {
    if (!names_valid_corners(mesh, t)) continue;
    Point p[3];
    for (size_t k = 0; k < 3; ++k)
      for (size_t i = 0; i < 3; ++i) p[k][i] = mesh.positions[3 * mesh.indices[3 * t + k] + i];
    if (p[0] == p[1] || p[1] == p[2] || p[2] == p[0]) continue;
    if (places.empty()) low = high = p[0];
    places.insert(p, p + 3);
    for (const Point& q : p)
      for (size_t i = 0; i < 3; ++i) low[i] = std::min(low[i], q[i]), high[i] = std::max(high[i], q[i]);
    Point n;
    for (size_t i = 0; i < 3; ++i) {
      const size_t j = (i + 1) % 3, k = (i + 2) % 3;
      n[i] = (p[1][j] - p[0][j]) * (p[2][k] - p[0][k]) - (p[1][k] - p[0][k]) * (p[2][j] - p[0][j]);
    }
    area += std::hypot(n[0], n[1], n[2]) / 2;
  }
  for (size_t i = 0; i < 3; ++i) largest = std::max(largest, high[i] - low[i]);
  return places.size() >= 12 && area > 1e-10 * largest * largest;
}

Verdict try_mesh(const focal_context* context, const focal_model* model, const BadMesh& mesh) {
  auto desc = initialised(focal_mesh_desc_init);
  desc.positions = mesh.positions.data(), desc.vertex_count = mesh.vertex_count();
  desc.indices = mesh.indices.data(), desc.index_count = mesh.indices.size();
  return judge(model, !is_valid(mesh), [&](const focal_mesh_params& params, focal_mesh** out) {
    return focal_mesh_create(context, &desc, &params, out);
  });
}

Verdict try_file(const focal_context* context, const focal_model* model, const std::string& path) {
  return judge(model, false, [&](focal_mesh_params params, focal_mesh** out) {
    params.lenient = 1;
    return focal_mesh_load_gltf(context, path.c_str(), &params, out);
  });
}

}  // namespace focal_bad_meshes
