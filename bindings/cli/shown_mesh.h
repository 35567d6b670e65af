// A mesh and its vote maps as the report page shows them: decimated where large, quantised, base64.
#pragma once
#include <cstdint>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "handles.h"
#include "output.h"

namespace focal_cli {

struct ShownMesh {
  std::vector<uint32_t> vertices;   // the mesh's vertex behind each vertex shown
  std::vector<uint32_t> triangles;  // three vertices shown each
};

// Equal positions welded, and so decimated that about most_vertices are left, where there are more.
ShownMesh shown_mesh(const focal_mesh* mesh, size_t most_vertices);

// Positions as 16-bit steps of the box, a byte a vertex for each counted landmark's votes.
Json shown_mesh_json(const focal_mesh* mesh, const ShownMesh& shown, const focal_detection* detection,
                     const std::set<std::string>& counted);

// How many vertices of each mesh to show so that the page stays small enough to mail and to open.
size_t shown_vertices_for(size_t meshes, size_t landmarks);

std::string base64(std::string_view bytes);

}  // namespace focal_cli
