// A seeded random stream whose numbers are the same with every compiler and standard library.
#pragma once
#include <cstdint>
#include <random>

namespace creatures {

class Random {
 public:
  explicit Random(uint64_t seed) : engine_(seed) {}
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
  }
  // Bell-shaped on [low, high]: most individuals are near the middle, none is outside.
  double typical(double low, double high) { return 0.5 * (uniform(low, high) + uniform(low, high)); }
  uint64_t next() { return engine_(); }

 private:
  std::mt19937_64 engine_;
};

}  // namespace creatures
