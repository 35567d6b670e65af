#include "base/random.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

using focal::Random;

TEST_CASE("the stream is PCG32's own, as printed by its author's demo for seed 42 and stream 54") {
  Random random(42, 54);
  for (const uint32_t expected :
       {0xa15c02b7u, 0x7b47f409u, 0xba1d3330u, 0x83d2f293u, 0xbfa4784bu, 0xcbed606eu})
    CHECK(random.next() == expected);
}

TEST_CASE("two streams of one seed are uncorrelated, the same stream repeats") {
  Random a(7, 0), b(7, 1), again(7, 0);
  const int n = 100'000;
  double product = 0;
  bool repeats = true;
  for (int i = 0; i < n; ++i) {
    const double x = a.uniform() - 0.5, y = b.uniform() - 0.5;
    product += x * y;
    repeats = repeats && x == again.uniform() - 0.5;
  }
  CHECK(repeats);
  CHECK(std::abs(product / n * 12) < 4 / std::sqrt(n));  // correlation, within 4 standard errors
}

TEST_CASE("uniform and normal have the moments of their distributions") {
  Random random(1);
  const int n = 200'000;
  double uniform_sum = 0, uniform_squares = 0, normal_sum = 0, normal_squares = 0, normal_fourth = 0;
  for (int i = 0; i < n; ++i) {
    const double u = random.uniform(), z = random.normal();
    REQUIRE((u >= 0 && u < 1));
    REQUIRE(std::isfinite(z));
    uniform_sum += u, uniform_squares += u * u;
    normal_sum += z, normal_squares += z * z, normal_fourth += z * z * z * z;
  }
  CHECK(uniform_sum / n == doctest::Approx(0.5).epsilon(0.01));
  CHECK(uniform_squares / n == doctest::Approx(1.0 / 3).epsilon(0.01));
  CHECK(std::abs(normal_sum / n) < 0.01);
  CHECK(normal_squares / n == doctest::Approx(1).epsilon(0.02));
  CHECK(normal_fourth / n == doctest::Approx(3).epsilon(0.05));
}

TEST_CASE("below is even, also for a bound that does not divide 2^32") {
  Random random(3);
  std::array<int, 7> counts{};
  for (int i = 0; i < 70'000; ++i) ++counts[random.below(7)];
  double chi_squared = 0;
  for (const int count : counts) chi_squared += (count - 10'000.0) * (count - 10'000.0) / 10'000;
  CHECK(chi_squared < 22.5);  // 6 degrees of freedom, 1 in 1,000

  // 3 * 2^30: a plain modulo would give the lowest third half of all draws.
  int low = 0;
  for (int i = 0; i < 30'000; ++i) low += random.below(3u << 30u) < (1u << 30u);
  CHECK(low == doctest::Approx(10'000).epsilon(0.05));
}

TEST_CASE("samples without replacement are different numbers, each as likely as the others") {
  std::array<int, 10> counts{};
  for (uint64_t seed = 0; seed < 5000; ++seed) {
    Random random(seed);
    auto sample = focal::sample_without_replacement(random, 10, 3);
    REQUIRE(sample.size() == 3);
    for (const int32_t i : sample) ++counts.at(static_cast<size_t>(i));
    std::sort(sample.begin(), sample.end());
    REQUIRE(std::adjacent_find(sample.begin(), sample.end()) == sample.end());
  }
  for (const int count : counts) CHECK(count == doctest::Approx(1500).epsilon(0.1));
}

TEST_CASE("asking for more samples than there are gives them all once") {
  Random random(5);
  auto sample = focal::sample_without_replacement(random, 6, 100);
  std::sort(sample.begin(), sample.end());
  std::vector<int32_t> all(6);
  std::iota(all.begin(), all.end(), 0);
  CHECK(sample == all);
  CHECK(focal::sample_without_replacement(random, 0, 4).empty());
}
