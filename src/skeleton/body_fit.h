// Rigged training shapes fitted to a detected body, from every start that is likely: as the maps place them, the same with front and
// back exchanged, and laid over the body as they stand. Which ends nearest to the body decides how it faces and where its joints lie.
#pragma once
#include <limits>
#include <vector>

#include "landmarks/detect.h"
#include "skeleton/articulated_fit.h"
#include "skeleton/fixed_joints.h"
#include "skeleton/taught_weights.h"

namespace focal {

struct FittedShape {
  int32_t shape = 0;    // of the exemplars
  double residual = 0;  // see ArticulatedFit
  double share = 1;     // how much it counts beside the others, 0..1
  Posture posture;      // in the coordinates of the analysed surface
  std::vector<Vector3> tip;
  MatrixX3 points;
};

struct BodyFit {
  std::vector<FittedShape> shapes;  // those that agree with the best, which comes first
  double start_share = 0;    // likewise, of the joints that the maps agreed on; 0 where the fits left them
  bool is_reversed = false;  // the body faces the other way than the maps suppose
  // By how much the best fit that faces the other way lies farther from the body, as a share; infinite: none was tried.
  double heading_margin = std::numeric_limits<double>::infinity();
};

// start: where the maps suppose the joints. maps: of rigged shapes, not empty. may_reverse: the body may face the other way than they
// suppose. fixed: joints whose places are known, in the coordinates of the analysed surface; those that have another side say how it
// faces.
BodyFit fit_to_body(const Detection& detection, const std::vector<ShapeMap>& maps,
                    const PlacedSkeleton& start, bool may_reverse, const FixedJoints& fixed,
                    const Execution& execution);

// The maps that fits amount to.
std::vector<ShapeMap> maps_of_fits(const BodyFit& fit, const LandmarkModel& model,
                                   const SurfaceAnalysis& analysis, const Execution& execution);

}  // namespace focal
