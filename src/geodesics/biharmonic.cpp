// Biharmonic distance: Y. Lipman, R. Rustamov, T. Funkhouser, "Biharmonic Distance", 2010. A length.
#include "geodesics/greens_distance.h"

namespace focal {

DistanceKind biharmonic_distance() {
  return {"biharmonic", false, true, [](const MeasuredSurface& surface, const Execution& execution) {
            return greens_distance(surface, 2, execution);
          }};
}

}  // namespace focal
