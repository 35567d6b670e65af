// The training shapes as the model remembers them: enough of each to map it onto a new shape and to carry its marks over.
// Many such maps agree where the votes of a forest blur, and disagree where nothing is certain.
#pragma once
#include <optional>
#include <vector>

#include "analysis/surface_analysis.h"
#include "mesh/closest_point.h"
#include "model/landmark_model.h"

namespace focal {

// points: the marks on the analysed surface, one a landmark or none; fields: the distance of every vertex from those that
// are there, in their order; rig: of the surface that the proxy stands for, or none.
Exemplar remember_shape(const SurfaceAnalysis& analysis,
                        const std::vector<std::optional<SurfacePoint>>& points, const RowMatrixf& fields,
                        float reach, const std::optional<ShapeRig>& rig = std::nullopt);

// A place near the surface, and how much of a shape's word it has.
struct TransferredPlace {
  SurfaceQuery at;
  float share = 0;
};

// What one training shape says of a new one.
struct TransferredLandmarks {
  // One entry a landmark: where it lies, by each of the vertices that it lies between; empty where the training shape is not
  // marked.
  std::vector<std::vector<TransferredPlace>> places;
  float residual = 0;  // of the map: small where the shapes are alike
};

struct TransferParams {
  MapParams map;           // exact_from is set here
  int32_t spread = 1000;   // vertices that stand for all of them until the last round
  int32_t most_alike = 0;  // carry from so many shapes only, those whose coarse maps fit best; 0: from all
};

// A training shape mapped onto the analysed surface.
struct ShapeMap {
  int32_t shape = 0;  // of the exemplars
  FunctionalMap map;  // its points, then its marks, to vertices of the surface
};

// among: numbers of the shapes to map. landmark: those placed so far, which the maps start from; fields: the distances of all vertices from them, in this order.
// One entry a shape that was mapped.
std::vector<ShapeMap> map_shapes(const std::vector<Exemplar>& exemplars, std::span<const int32_t> among,
                                 float reach, const SurfaceAnalysis& analysis,
                                 const std::vector<int32_t>& landmark, const RowMatrixf& fields,
                                 const TransferParams& params, const Execution& execution);

// Moves the points' images, which lie at vertices that stand for all, to the nearest of all.
void find_exact_images(std::vector<ShapeMap>& maps, const std::vector<Exemplar>& exemplars,
                       const SurfaceAnalysis& analysis, const Execution& execution);

// Correlation by area of how both surfaces bulge at the points and their images, mean over the radii, -1..1. The true map of a body
// has a clearly higher one than one that takes front for back.
float bulge_agreement(const Exemplar& shape, const FunctionalMap& map, const SurfaceAnalysis& analysis);

// What each of the maps says of the landmarks.
std::vector<TransferredLandmarks> transfer_landmarks(const std::vector<Exemplar>& exemplars,
                                                     const std::vector<ShapeMap>& maps,
                                                     const SurfaceAnalysis& analysis,
                                                     const Execution& execution);

}  // namespace focal
