// The common part of biharmonic and commute-time distance: distances in the embedding of a surface by a
// Green's function.
#pragma once
#include "geodesics/distance.h"

namespace focal {

// d(x, y)^2 = G(x, x) + G(y, y) - 2 G(x, y). G is the pseudo-inverse of L for the commute-time distance (F.
// Fouss et al., 2007, up to the factor of the volume), or of L M^-1 L for the biharmonic one (Y. Lipman, R.
// Rustamov, T. Funkhouser, 2010). solves: 1 or 2. The constructor does one solve per vertex for the diagonal
// of G.
std::shared_ptr<const Distance> greens_distance(const MeasuredSurface& surface, int solves,
                                                const Execution& execution);

}  // namespace focal
