// Maps every point of one detected mesh to a point of another, by a functional map that starts at the
// landmarks of both; these resolve left and right, front and back.
#pragma once
#include <vector>

#include "landmarks/detect.h"

namespace focal {

struct DenseMap {
  // Per vertex of from.mesh->source, on to.mesh->source; triangle -1: no triangle uses the vertex.
  std::vector<SurfacePoint> point;
  float residual = 0;  // of the functional map: small where the shapes are similar
};

// Both detections must be by one model. Throws invalid_argument when they are not, when a detection keeps no
// analysis (nor with preset paper), or when fewer than three landmarks were found on both. About 0.2 s at any
// size.
DenseMap dense_map(const Detection& from, const Detection& to, const Execution& execution);

// Transfers values at the vertices of to.mesh->source (one row each) to those of from.mesh->source; 0 where
// no triangle uses a vertex.
RowMatrixf pulled_back(const DenseMap& map, const PreparedMesh& to, const RowMatrixf& values);

}  // namespace focal
