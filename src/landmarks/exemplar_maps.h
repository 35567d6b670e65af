// Training shapes as stored in the model: enough of each to map it onto a new shape and to transfer its
// landmarks. Many such maps agree where the votes of a forest are blurred, and disagree where nothing is
// certain.
#pragma once
#include <optional>
#include <vector>

#include "analysis/surface_analysis.h"
#include "mesh/closest_point.h"
#include "model/landmark_model.h"

namespace focal {

// points: the landmarks on the analysed surface, one per landmark or none; fields: the distances of every
// vertex from the existing ones, in their order; rig: of the surface that the proxy represents, or none.
Exemplar remember_shape(const SurfaceAnalysis& analysis,
                        const std::vector<std::optional<SurfacePoint>>& points, const RowMatrixf& fields,
                        float reach, const std::optional<ShapeRig>& rig = std::nullopt);

// A position near the surface with its weight.
struct TransferredPlace {
  SurfaceQuery at;
  float share = 0;
};

// The landmarks that one training shape predicts on a new one.
struct TransferredLandmarks {
  // One entry per landmark: its position, split over the vertices that it is between; empty where the
  // training shape has no such landmark.
  std::vector<std::vector<TransferredPlace>> places;
  float residual = 0;  // of the map: small where the shapes are alike
};

struct TransferParams {
  MapParams map;          // exact_from is set here
  int32_t spread = 1000;  // vertices that represent all of them until the last round
  // Transfer from this many shapes only, those whose coarse maps fit best; 0: from all.
  int32_t most_alike = 0;
};

// A training shape mapped onto the analysed surface.
struct ShapeMap {
  int32_t shape = 0;  // number among the exemplars
  FunctionalMap map;  // from its points, then its landmarks, to vertices of the surface
};

// among: numbers of the shapes to map. landmark: the landmarks placed so far, which the maps start from;
// fields: the distances of all vertices from them, in this order. Returns one entry per mapped shape.
std::vector<ShapeMap> map_shapes(const std::vector<Exemplar>& exemplars, std::span<const int32_t> among,
                                 float reach, const SurfaceAnalysis& analysis,
                                 const std::vector<int32_t>& landmark, const RowMatrixf& fields,
                                 const TransferParams& params, const Execution& execution);

// Moves the points' images from the representative vertices to the nearest of all vertices.
void find_exact_images(std::vector<ShapeMap>& maps, const std::vector<Exemplar>& exemplars,
                       const SurfaceAnalysis& analysis, const Execution& execution);

// Area-weighted correlation of the bulge of both surfaces at the points and their images, mean over the
// radii, -1..1. The true map of a body has a clearly higher one than a map that swaps front and back.
float bulge_agreement(const Exemplar& shape, const FunctionalMap& map, const SurfaceAnalysis& analysis);

// The landmarks that each of the maps predicts.
std::vector<TransferredLandmarks> transfer_landmarks(const std::vector<Exemplar>& exemplars,
                                                     const std::vector<ShapeMap>& maps,
                                                     const SurfaceAnalysis& analysis,
                                                     const Execution& execution);

}  // namespace focal
