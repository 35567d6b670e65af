// Meshes of a set, loaded with their marks as places on the surface.
// The nearest point of a triangle: Christer Ericson, "Real-Time Collision Detection", 2004, section 5.1.5.
#include "marked_mesh.h"

#include <algorithm>
#include <chrono>
#include <limits>

#include "command_error.h"

namespace focal_cli {
namespace {

Position minus(const Position& a, const Position& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
double dot(const Position& a, const Position& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

double share(double part, double whole) { return whole > 0 ? std::clamp(part / whole, 0.0, 1.0) : 0; }

// Weights of the corners a, b, c at the point of the triangle nearest to p, by the region p projects into.
Position nearest_weights(const Position& p, const Position& a, const Position& b, const Position& c) {
  const Position ab = minus(b, a), ac = minus(c, a), ap = minus(p, a), bp = minus(p, b), cp = minus(p, c);
  const double d1 = dot(ab, ap), d2 = dot(ac, ap), d3 = dot(ab, bp), d4 = dot(ac, bp);
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
  if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
  if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
  const double va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) {
    const double v = share(d1, d1 - d3);
    return {1 - v, v, 0};
  }
  if (vb <= 0 && d2 >= 0 && d6 <= 0) {
    const double w = share(d2, d2 - d6);
    return {1 - w, 0, w};
  }
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const double w = share(d4 - d3, (d4 - d3) + (d5 - d6));
    return {0, 1 - w, w};
  }
  const double sum = va + vb + vc;
  return {va / sum, vb / sum, vc / sum};
}

// A look at every triangle: marks are few, and meshes of a million triangles still take but milliseconds.
focal_surface_point nearest_point(const focal_mesh* mesh, const Position& p) {
  const float* positions = focal_mesh_positions(mesh);
  const uint32_t* corners = focal_mesh_triangles(mesh);
  const uint64_t count = info_of(mesh).triangle_count;
  focal_surface_point best{FOCAL_NO_TRIANGLE, {1, 0, 0}};
  double best_distance = std::numeric_limits<double>::infinity();
  for (uint64_t t = 0; t < count; ++t) {
    Position corner[3];
    for (size_t k = 0; k < 3; ++k) {
      const float* xyz = positions + 3 * static_cast<size_t>(corners[3 * t + k]);
      corner[k] = {xyz[0], xyz[1], xyz[2]};
    }
    const Position weights = nearest_weights(p, corner[0], corner[1], corner[2]);
    Position gap = p;
    for (size_t k = 0; k < 3; ++k) {
      for (size_t axis = 0; axis < 3; ++axis) gap[axis] -= weights[k] * corner[k][axis];
    }
    if (const double distance = dot(gap, gap); distance < best_distance) {
      best_distance = distance;
      best.triangle = static_cast<uint32_t>(t);
      std::copy(weights.begin(), weights.end(), best.barycentric);
    }
  }
  return best;
}

}  // namespace

Mesh load_mesh(const focal_context* context, const std::string& path, const MeshOptions& how) {
  auto params = initialised(focal_mesh_params_init);
  params.lenient = how.lenient;
  params.surface = how.surface;
  params.keep_scenery = how.keep_scenery;
  params.allow_external_files = 1;  // whoever names a .gltf means the files beside it too
  return owned<Mesh>(focal_mesh_load_gltf, context, path.c_str(), &params);
}

focal_mesh_info info_of(const focal_mesh* mesh) {
  auto info = initialised(focal_mesh_info_init);
  check(focal_mesh_get_info(mesh, &info));
  return info;
}

Position position_of(const focal_mesh* mesh, const focal_surface_point& point) {
  float xyz[3];
  check(focal_mesh_position_of(mesh, &point, xyz));
  return {xyz[0], xyz[1], xyz[2]};
}

focal_surface_point place_of(const focal_mesh* mesh, const Landmark& mark) {
  focal_surface_point point{FOCAL_NO_TRIANGLE, {1, 0, 0}};
  if (mark.surface) {
    point.triangle = mark.surface->triangle;
    std::copy(mark.surface->barycentric.begin(), mark.surface->barycentric.end(), point.barycentric);
    position_of(mesh, point);  // throws when there is no such triangle
  } else if (mark.vertex) {
    check(focal_mesh_point_at_vertex(mesh, *mark.vertex, &point));
  } else if (mark.position) {
    point = nearest_point(mesh, *mark.position);
  }
  return point;
}

MarkedMesh load_marked_mesh(const focal_context* context, const SetFolder& set, const std::string& name,
                            const MeshOptions& how) {
  const auto marks = set.marks(name);
  const auto start = std::chrono::steady_clock::now();
  MarkedMesh loaded{name, load_mesh(context, set.mesh_path(name), how), {}, 0};
  loaded.load_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  for (const auto& [landmark, mark] : marks) {
    try {
      loaded.marks[landmark] = place_of(loaded.mesh.get(), mark);
    } catch (const CommandError& error) {
      throw CommandError("mesh '" + name + "', landmark '" + landmark + "': " + error.what(), error.hint);
    }
  }
  return loaded;
}

TrainingSet training_set_of(const focal_context* context, const SetFolder& set,
                            const std::vector<const MarkedMesh*>& meshes) {
  std::vector<const char*> names;
  for (const std::string& name : set.landmark_names) names.push_back(name.c_str());
  auto training_set = owned<TrainingSet>(focal_training_set_create, context, names.data(), names.size());
  for (const MarkedMesh* mesh : meshes) {
    std::vector<focal_surface_point> points;
    for (const std::string& name : set.landmark_names) {
      const auto mark = mesh->marks.find(name);
      points.push_back(mark == mesh->marks.end() ? focal_surface_point{FOCAL_NO_TRIANGLE, {1, 0, 0}}
                                                 : mark->second);
    }
    check(focal_training_set_add(training_set.get(), mesh->mesh.get(), points.data(), points.size()),
          "mesh '" + mesh->name + "': ");
  }
  return training_set;
}

}  // namespace focal_cli
