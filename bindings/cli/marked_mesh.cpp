// Meshes of a set, loaded with their marks as places on the surface.
#include "marked_mesh.h"

#include <algorithm>
#include <chrono>

#include "command_error.h"

namespace focal_cli {
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
    const float place[3] = {static_cast<float>((*mark.position)[0]), static_cast<float>((*mark.position)[1]),
                            static_cast<float>((*mark.position)[2])};
    check(focal_mesh_closest_point(mesh, place, &point));
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
