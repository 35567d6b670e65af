// A small random number generator (PCG32, O'Neill 2014): the same stream on every platform and standard
// library.
#pragma once
#include <cstdint>
#include <vector>

namespace focal {

class Random {
 public:
  // Streams of one seed are independent: use one per tree or per shape.
  explicit Random(uint64_t seed, uint64_t stream = 0);
  uint32_t next();                 // uniform over all 32-bit values
  uint32_t below(uint32_t bound);  // uniform in [0, bound), bound > 0
  double uniform();                // uniform in [0, 1)
  double normal();                 // mean 0, variance 1

 private:
  uint64_t state_, increment_;
};

// Draws `count` different numbers from [0, n), in random order; all of them when count >= n.
std::vector<int32_t> sample_without_replacement(Random& random, int32_t n, int32_t count);

}  // namespace focal
