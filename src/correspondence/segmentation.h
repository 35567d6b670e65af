// Labels every triangle with a landmark: segments that have the same meaning on every shape of a category.
#pragma once
#include <cstdint>
#include <vector>

#include "landmarks/detect.h"

namespace focal {

// Labels of vertices or triangles are landmark numbers; -1: no landmark was found, or no triangle uses the vertex.

// Xia et al. 2016, Section 6: k-means over position and SI-HKS, with a cluster starting at each landmark that
// was found. seed_vertices: start at these vertices of the analysed surface instead, for comparison; labels
// are then their numbers.
std::vector<int32_t> segment_k_means(const Detection& detection, const Execution& execution,
                                     const std::vector<int32_t>& seed_vertices = {});

// Each triangle goes to the landmark nearest along the surface.
std::vector<int32_t> segment_geodesic(const Detection& detection, const Execution& execution);

// The most frequent label of a triangle's vertices; of three different ones the first corner's. Per triangle
// of mesh.source.
std::vector<int32_t> triangle_labels(const PreparedMesh& mesh,
                                     const std::vector<int32_t>& source_vertex_labels);

// To look at: every triangle with corners of its own, so that colours end where parts do. Colours: see vote_maps.h.
struct ColouredMesh {
  TriangleMesh mesh;
  RowMatrixf colours;  // vertices x 3
};
ColouredMesh coloured(const TriangleMesh& mesh, const std::vector<int32_t>& triangle_labels);

}  // namespace focal
