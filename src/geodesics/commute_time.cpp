// Commute-time distance, the expected time of a random walk from one point to the other and back: F. Fouss et
// al., "Random-Walk Computation of Similarities between Nodes of a Graph", 2007. No unit.
#include "geodesics/greens_distance.h"

namespace focal {

DistanceKind commute_time_distance() {
  return {"commute-time", false, false, [](const MeasuredSurface& surface, const Execution& execution) {
            return greens_distance(surface, 1, execution);
          }};
}

}  // namespace focal
