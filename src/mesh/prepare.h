// Converts a caller's triangles to the surface that is analysed: welded, cleaned, centred, of unit area, with
// the maps back to the caller's own vertex and triangle numbers.
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

// The analysed surface: the mesh's own triangles, or one closed surface around them (see wrap.h).
enum class AnalysedSurface : int32_t {
  automatic = 0,  // wrapped where the mesh has several parts, or many edges of more than two triangles
  as_it_is = 1,
  wrapped = 2
};

struct PrepareParams {
  AnalysedSurface analysed = AnalysedSurface::automatic;
  bool weld = true;  // merge vertices at equal positions, and borders that nearly meet (see stitch.h)
  bool drop_degenerate = true;  // drop triangles with a repeated corner, and duplicate triangles
  // Skip triangles with a NaN or infinite corner or an index out of range, instead of rejecting the mesh.
  bool lenient = false;
  // Check the topology, join borders and flip inconsistent triangles; not needed for surfaces derived from a
  // prepared one.
  bool repair_orientation = true;
  // Find parts that are not the character and leave them out (see scenery.h); pieces: of the source, or none.
  bool leave_out_scenery = false;
  std::vector<MeshPiece> pieces = {};
};

struct PreparedMesh {
  // The caller's mesh, with its numbering and units. Triangles that lenient skips are 0 0 0 here and invalid
  // vertices are at the origin, so that it contains nothing invalid.
  TriangleMesh source;
  TriangleMesh surface;  // the analysed surface: every vertex used by a triangle; centred, area 1
  double scale = 1;      // caller's units per surface unit = sqrt(area of the surface in caller's units)
  Vector3 centre = Vector3::Zero();       // source position = centre + scale * surface position
  std::vector<int32_t> surface_vertex;    // per source vertex: its surface vertex, or -1
  std::vector<int32_t> source_vertex;     // per surface vertex: its first source vertex
  std::vector<int32_t> surface_triangle;  // per source triangle: its surface triangle, or -1
  std::vector<int32_t> source_triangle;   // per surface triangle: its source triangle
  // Per surface triangle: its corners 1 and 2 are the source's 2 and 1; empty: no triangle is flipped.
  std::vector<char> flipped;
  int32_t components = 1;         // connected components
  bool is_wrapped = false;        // see AnalysedSurface: make_proxy wraps the surface
  int64_t invalid_triangles = 0;  // skipped by lenient
  std::vector<Scenery> scenery;   // left out by leave_out_scenery: no surface triangle, no surface vertex
  int64_t scenery_triangles = 0;
  bool is_oriented = true;            // see Orientation; where false, nothing distinguishes left from right
  std::optional<Topology> topology;   // of the surface; empty if it was not checked
  std::vector<std::string> warnings;  // sentences on defects and repairs
};

// Throws invalid_mesh (no triangles, index out of range, NaN or infinite position), mesh_too_small, cancelled.
PreparedMesh prepare(TriangleMesh source, const PrepareParams& params = {}, const Execution& execution = {});

// The wrapped surface, prepared without further changes; its source is in the coordinates of mesh.surface.
PreparedMesh wrapped(const PreparedMesh& mesh, const Execution& execution = {});

int64_t degenerate_triangles(const PreparedMesh& mesh);  // dropped: a repeated corner, or a duplicate
int64_t flipped_triangles(const PreparedMesh& mesh);

// Pairs of surface vertices that link otherwise unconnected parts (operators add an edge for each), so that
// heat and distances reach eyes, teeth and armour. Computed by each call, 0.4 s for 95 parts of 50,000
// vertices; not needed for a wrapped mesh.
std::vector<std::pair<int32_t, int32_t>> bridges_of(const PreparedMesh& mesh);

// The source vertices that are analysed, in the caller's units: the basis of the size of the mesh.
MatrixX3 analysed_positions(const PreparedMesh& mesh);

// Converts the caller's surface point to the prepared surface and back; triangle -1 when it was dropped.
SurfacePoint to_surface(const PreparedMesh& mesh, const SurfacePoint& source_point);
SurfacePoint to_source(const PreparedMesh& mesh, const SurfacePoint& surface_point);
// A surface point at a vertex of the surface (in any of its triangles), or at each of several.
SurfacePoint at_vertex(const TriangleMesh& mesh, int32_t vertex);
std::vector<SurfacePoint> points_at(const TriangleMesh& mesh, std::span<const int32_t> vertices);

}  // namespace focal
