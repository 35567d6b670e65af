// The training shapes as the model remembers them: enough of each to map it onto a new shape and to carry its marks over.
// Many such maps agree where the votes of a forest blur, and disagree where nothing is certain.
#pragma once
#include <optional>
#include <vector>

#include "landmarks/model_parts.h"
#include "landmarks/surface_analysis.h"

namespace focal {

// points: the marks on the analysed surface, one a landmark or none; fields: the distance of every vertex from those that
// are there, in their order.
AtlasShape remember_shape(const SurfaceAnalysis& analysis,
                          const std::vector<std::optional<SurfacePoint>>& points, const RowMatrixf& fields,
                          float reach);

// What one training shape says of a new one.
struct CarriedMarks {
  std::vector<std::optional<SurfacePoint>> point;  // one a landmark, where it is marked on the training shape
  float residual = 0;                              // of the map: small where the shapes are alike
};

struct CarryParams {
  MapParams map;
  int32_t spread = 1000;   // vertices that stand for all of them until the last round
  int32_t most_alike = 0;  // carry from so many shapes only, those whose coarse maps fit best; 0: from all
};

// landmark: those placed so far, which the maps start from; fields: the distances of all vertices from them, in this order.
// One entry a shape that was carried from.
std::vector<CarriedMarks> carry_marks(const std::vector<AtlasShape>& atlas, float reach,
                                      const SurfaceAnalysis& analysis, const std::vector<int32_t>& landmark,
                                      const RowMatrixf& fields, const CarryParams& params,
                                      const Execution& execution);

}  // namespace focal
