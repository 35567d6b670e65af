// Fits rigged training shapes to a detected body from every likely start: as the maps place them, the same
// with front and back exchanged, and overlaid on the body in their own pose. The best fit determines the
// heading of the body and the positions of its joints.
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
  double share = 1;     // relative weight, 0..1
  Posture posture;      // in the coordinates of the analysed surface
  std::vector<Vector3> tip;
  MatrixX3 points;
};

struct BodyFit {
  std::vector<FittedShape> shapes;  // those that agree with the best, which is first
  // Relative weight of the joints from the maps; 0 where the fits moved away from them.
  double start_share = 0;
  bool is_reversed = false;  // the heading is opposite to that of the maps
  // Evidence against the opposite heading: the logarithm of the ratio of the residuals of the best fits, plus
  // the detection's share; infinite: none was tried.
  double heading_margin = std::numeric_limits<double>::infinity();
};

// start: the joints according to the maps. maps: of rigged shapes, not empty. may_reverse: the body may have
// the opposite heading. fixed: joints of known positions, in the coordinates of the analysed surface; those
// with a counterpart determine the heading.
BodyFit fit_to_body(const Detection& detection, const std::vector<ShapeMap>& maps,
                    const PlacedSkeleton& start, bool may_reverse, const FixedJoints& fixed,
                    const Execution& execution);

// Converts fits to maps.
std::vector<ShapeMap> maps_of_fits(const BodyFit& fit, const LandmarkModel& model,
                                   const SurfaceAnalysis& analysis, const Execution& execution);

}  // namespace focal
