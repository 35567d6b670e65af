// Connected components of a mesh, and the links that join the parts of a character.
#pragma once
#include <utility>
#include <vector>

#include "mesh/triangle_mesh.h"

namespace focal {

// A component number per vertex, 0-based; vertices of one triangle share it.
struct Components {
  std::vector<int32_t> of_vertex;
  int32_t count = 0;
};
Components components_of(const TriangleMesh& mesh);

// For every component but the largest, up to three pairs of nearest vertices that link it to larger ones.
// Empty for one component.
std::vector<std::pair<int32_t, int32_t>> bridge_pairs(const TriangleMesh& mesh, const Components& components);

}  // namespace focal
