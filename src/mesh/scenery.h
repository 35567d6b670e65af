// Parts of a scene that are not the character: a ground, a backdrop, a dome, a helper, a separate prop.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "mesh/components.h"
#include "mesh/triangle_mesh.h"

namespace focal {

// Triangles with a common origin, for example a node of a file.
struct MeshPiece {
  std::string name;  // for messages: "node 'Ground'"
  int32_t first_triangle = 0, triangle_count = 0;
  bool is_character = false;  // it has a skin or is below a joint: never scenery
};

enum class SceneryKind : int32_t {
  sheet = 1,      // flat and larger than the character on all sides
  enclosure = 2,  // a convex shape that contains most of the character
  apart = 3       // farther from the character than its parts are from each other
};

struct Scenery {
  SceneryKind kind = SceneryKind::sheet;
  int32_t piece = 0;         // index of the MeshPiece
  bool whole_piece = false;  // no part of the piece is character
  int32_t triangle_count = 0;
};

struct FoundScenery {
  std::vector<Scenery> parts;   // by piece
  std::vector<char> triangles;  // 1: scenery, one per triangle of the surface; empty without scenery
};

// surface: welded, every vertex used, finite; components: its own. source_triangle: per triangle its number
// in the pieces; without pieces everything is one piece. Only whole components are scenery, and only if the
// rest is a character without them: in doubt a part is kept, as is a surface of a single component. Depends
// on geometry alone, not on units or an up direction, with one exception: a sheet across y below everything
// else need not be as large as others. Cost: at most 64 large components are tested, on 20,000 vertices of
// the rest.
FoundScenery find_scenery(const TriangleMesh& surface, const Components& components,
                          std::span<const int32_t> source_triangle, std::span<const MeshPiece> pieces);

// "node 'Ground' (a flat sheet that reaches beyond the character on all sides)".
std::string describe(const Scenery& scenery, std::span<const MeshPiece> pieces);

}  // namespace focal
