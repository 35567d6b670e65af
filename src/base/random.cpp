#include "base/random.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace focal {

Random::Random(uint64_t seed, uint64_t stream) : state_(0), increment_((stream << 1u) | 1u) {
  next();
  state_ += seed;
  next();
}

uint32_t Random::next() {
  const uint64_t old = state_;
  state_ = old * 6364136223846793005ULL + increment_;
  const auto shifted = static_cast<uint32_t>(((old >> 18u) ^ old) >> 27u);
  const auto rotation = static_cast<uint32_t>(old >> 59u);
  return (shifted >> rotation) | (shifted << ((32 - rotation) & 31));
}

uint32_t Random::below(uint32_t bound) {
  const uint32_t threshold = (0u - bound) % bound;  // rejecting below it removes the modulo's bias
  for (;;) {
    const uint32_t value = next();
    if (value >= threshold) return value % bound;
  }
}

double Random::uniform() { return next() * 0x1p-32; }

double Random::normal() {  // Box and Muller 1958
  const double radius = std::sqrt(-2 * std::log(1 - uniform()));
  return radius * std::cos(2 * std::numbers::pi * uniform());
}

std::vector<int32_t> sample_without_replacement(Random& random, int32_t n, int32_t count) {
  std::vector<int32_t> all(n);
  std::iota(all.begin(), all.end(), 0);
  count = std::min(count, n);
  for (int32_t i = 0; i < count; ++i) std::swap(all[i], all[i + random.below(n - i)]);
  all.resize(count);
  return all;
}

}  // namespace focal
