// A point of one detected mesh for every point of another, from a functional map that starts at the landmarks of both: left and
// right, front and back are settled by then.
#pragma once
#include <vector>

#include "landmarks/detect.h"

namespace focal {

struct DenseMap {
  std::vector<SurfacePoint>
      point;  // per vertex of from.mesh->source, on to.mesh->source; triangle -1: none uses the vertex
  float residual = 0;  // of the functional map: small where the shapes are alike
};

// Both by one model. Throws invalid_argument when they are not, when a detection keeps no analysis (preset paper's do not suit
// either), or when fewer than three landmarks were found on both. About 0.2 s at any size.
DenseMap dense_map(const Detection& from, const Detection& to, const Execution& execution);

// Values at the vertices of to.mesh->source (a row each), carried to those of from.mesh->source; 0 where no triangle uses one.
RowMatrixf pulled_back(const DenseMap& map, const PreparedMesh& to, const RowMatrixf& values);

}  // namespace focal
