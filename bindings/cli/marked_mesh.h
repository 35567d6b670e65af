// Meshes of a set, loaded with their marks as places on the surface.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "evaluation/accuracy.h"
#include "handles.h"
#include "options.h"
#include "set_folder.h"

namespace focal_cli {

struct MarkedMesh {
  std::string name;
  Mesh mesh;
  std::map<std::string, focal_surface_point> marks;  // by landmark; what is missing is absent on this mesh
  double load_seconds = 0;                           // of the mesh, as waited for
};

Mesh load_mesh(const focal_context* context, const std::string& path, const MeshOptions& how);
focal_mesh_info info_of(const focal_mesh* mesh);
Position position_of(const focal_mesh* mesh, const focal_surface_point& point);

// Where a mark lies: on its triangle, at its vertex, or else at the surface point nearest to its position.
focal_surface_point place_of(const focal_mesh* mesh, const Landmark& mark);

MarkedMesh load_marked_mesh(const focal_context* context, const SetFolder& set, const std::string& name,
                            const MeshOptions& how);

// The meshes as a training set for all landmarks of the set.
TrainingSet training_set_of(const focal_context* context, const SetFolder& set,
                            const std::vector<const MarkedMesh*>& meshes);

}  // namespace focal_cli
