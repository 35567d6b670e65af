// Meshes of any size made from a given one, as a scanner might give them: closed like the original, with fine relief,
// irregular triangles of uneven size, nothing that a decimator could undo by collapsing flat squares.
#pragma once
#include <cstdint>

#include "mesh/triangle_mesh.h"

namespace focal_bench {

// Larger: edges are split, long ones first, each new vertex moved off the surface by a few hundredths of its edge; then
// every vertex moves along the surface and a fifth of the edges flip. Smaller: decimated. `mesh` must be welded. The
// same seed gives the same mesh.
focal::TriangleMesh resized(const focal::TriangleMesh& mesh, int32_t vertex_count, uint64_t seed);

// Edges that do not have exactly two triangles.
int64_t open_edges(const focal::TriangleMesh& mesh);

}  // namespace focal_bench
