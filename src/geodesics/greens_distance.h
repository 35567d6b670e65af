// What biharmonic and commute-time distance share: distances between the points that Green's functions make of a surface.
#pragma once
#include "geodesics/distance.h"

namespace focal {

// d(x, y)^2 = G(x, x) + G(y, y) - 2 G(x, y). G is the pseudo-inverse of L, the commute-time distance (F. Fouss et al., 2007, up
// to the factor of the volume), or of L M^-1 L, the biharmonic one (Y. Lipman, R. Rustamov, T. Funkhouser, 2010).
// solves: 1 or 2. One solve a vertex when it is made, for the diagonal of G.
std::shared_ptr<const Distance> greens_distance(const MeasuredSurface& surface, int solves,
                                                const Execution& execution);

}  // namespace focal
