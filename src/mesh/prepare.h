// From a caller's triangles to the surface that is analysed: welded, cleaned, centred, of unit area, with the
// maps back to the caller's own vertex and triangle numbers.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "mesh/scenery.h"
#include "mesh/topology.h"
#include "mesh/triangle_mesh.h"

namespace focal {

// What is analysed: the mesh's own triangles, or one closed surface round them (see wrap.h).
enum class AnalysedSurface : int32_t {
  automatic = 0,  // wrapped where the mesh has several parts, or many edges of more than two triangles
  as_it_is = 1,
  wrapped = 2
};

struct PrepareParams {
  AnalysedSurface analysed = AnalysedSurface::automatic;
  bool weld = true;  // merge vertices of equal position, and borders that nearly meet (see stitch.h)
  bool drop_degenerate = true;  // drop triangles with a repeated corner, and repeated triangles
  // Leave out triangles with a NaN or infinite corner or an index out of range, instead of refusing the mesh.
  bool lenient = false;
  // Look at the topology, join borders and turn triangles over where they disagree; not needed for what is made of a prepared surface.
  bool repair_orientation = true;
  // Look for parts that are not the character and leave them out (see scenery.h); pieces: of the source, or none.
  bool leave_out_scenery = false;
  std::vector<MeshPiece> pieces = {};
};

struct PreparedMesh {
  // As the caller gave it, his numbers and units; but what lenient leaves out stands there as triangles 0 0 0 and as
  // vertices at the origin, so that whoever reads it meets nothing invalid.
  TriangleMesh source;
  TriangleMesh surface;  // analysed surface: every vertex used by a triangle; centred, area 1
  double scale = 1;      // caller's units per surface unit = sqrt(area of the surface in caller's units)
  Vector3 centre = Vector3::Zero();       // source position = centre + scale * surface position
  std::vector<int32_t> surface_vertex;    // per source vertex: its surface vertex, or -1
  std::vector<int32_t> source_vertex;     // per surface vertex: the first source vertex of it
  std::vector<int32_t> surface_triangle;  // per source triangle: its surface triangle, or -1
  std::vector<int32_t> source_triangle;   // per surface triangle: its source triangle
  std::vector<char>
      flipped;  // per surface triangle: its corners 1 and 2 are the source's 2 and 1; empty: none is
  int32_t components = 1;         // separate parts
  bool is_wrapped = false;        // see AnalysedSurface: make_proxy wraps the surface
  int64_t invalid_triangles = 0;  // left out by lenient
  std::vector<Scenery> scenery;   // left out by leave_out_scenery: no surface triangle, no surface vertex
  int64_t scenery_triangles = 0;
  bool is_oriented = true;            // see Orientation; where false, nothing distinguishes left from right
  std::optional<Topology> topology;   // of the surface; empty where nobody looked
  std::vector<std::string> warnings;  // plain sentences on what was found and done
};

// Throws invalid_mesh (no triangles, index out of range, NaN or infinite position), mesh_too_small, cancelled.
PreparedMesh prepare(TriangleMesh source, const PrepareParams& params = {}, const Execution& execution = {});

// The surface wrapped, prepared as it is; its source lies in the coordinates of mesh.surface.
PreparedMesh wrapped(const PreparedMesh& mesh, const Execution& execution = {});

int64_t degenerate_triangles(const PreparedMesh& mesh);  // with a repeated corner, or repeated: left out
int64_t flipped_triangles(const PreparedMesh& mesh);

// Pairs of surface vertices that link otherwise unconnected parts (operators add an edge for each), so that heat and
// distances reach eyes, teeth and armour. Found anew by each call, 0.4 s for 95 parts of 50,000 vertices: what analyses a
// wrapped mesh needs none.
std::vector<std::pair<int32_t, int32_t>> bridges_of(const PreparedMesh& mesh);

// The source vertices that are analysed, in the caller's units: what a size of the mesh is taken from.
MatrixX3 analysed_positions(const PreparedMesh& mesh);

// Surface point of the prepared surface for one of the caller's and back; triangle -1 when it was dropped.
SurfacePoint to_surface(const PreparedMesh& mesh, const SurfacePoint& source_point);
SurfacePoint to_source(const PreparedMesh& mesh, const SurfacePoint& surface_point);
// A surface point at a vertex of the surface (any of its triangles), or at each of several.
SurfacePoint at_vertex(const TriangleMesh& mesh, int32_t vertex);
std::vector<SurfacePoint> points_at(const TriangleMesh& mesh, std::span<const int32_t> vertices);

}  // namespace focal
