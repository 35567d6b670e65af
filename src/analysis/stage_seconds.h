#pragma once

namespace focal {

// Wall time per stage in seconds; the callers of load, repair and proxy set those.
struct StageSeconds {
  double load = 0, repair = 0, proxy = 0, spectrum = 0, descriptors = 0, geodesics = 0, forest = 0, vote = 0,
         constellation = 0, refine = 0, total = 0;
};

}  // namespace focal
