// Parts of a scene that are not the character: a ground, a backdrop, a dome, a helper, a prop that stands apart.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "mesh/components.h"
#include "mesh/triangle_mesh.h"

namespace focal {

// Triangles that came together, as those of a node of a file.
struct MeshPiece {
  std::string name;  // for messages: "node 'Ground'"
  int32_t first_triangle = 0, triangle_count = 0;
  bool is_character = false;  // it has a skin or hangs on a joint: never scenery
};

enum class SceneryKind : int32_t {
  sheet = 1,      // flat, and it reaches beyond the character on all sides
  enclosure = 2,  // a convex shape that contains most of the character
  apart = 3       // farther from the character than parts of it are from each other
};

struct Scenery {
  SceneryKind kind = SceneryKind::sheet;
  int32_t piece = 0;         // index of the MeshPiece
  bool whole_piece = false;  // nothing of the piece is character
  int32_t triangle_count = 0;
};

struct FoundScenery {
  std::vector<Scenery> parts;   // by piece
  std::vector<char> triangles;  // 1: scenery, one a triangle of the surface; empty where there is none
};

// surface: welded, every vertex used, finite; components: its own. source_triangle: per triangle its number in the pieces; without
// pieces all of it is one. Only whole connected parts, and only where the rest is a character without them: in doubt a part
// stays, and so does a surface of a single part. Depends on geometry alone, not on units or on a direction that is up,
// but for one: a sheet across y, below all else, need not be as large as others. Cost: at most 64 large parts are tested, on
// 20,000 vertices of the rest.
FoundScenery find_scenery(const TriangleMesh& surface, const Components& components,
                          std::span<const int32_t> source_triangle, std::span<const MeshPiece> pieces);

// "node 'Ground' (a flat sheet that reaches beyond the character on all sides)".
std::string describe(const Scenery& scenery, std::span<const MeshPiece> pieces);

}  // namespace focal
