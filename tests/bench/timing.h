// Time of what is compared: taken in turn, so that a busy moment of the machine hits all alike.
#pragma once
#include <algorithm>
#include <chrono>
#include <ctime>
#include <functional>
#include <vector>

namespace focal_bench {

// Wall time, and the processors' time of all threads, which other programs on the machine hardly change.
struct Seconds {
  double wall = 0, cpu = 0;
};

inline Seconds seconds_of(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  const std::clock_t cpu = std::clock();
  work();
  return {std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
          static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC};
}

inline double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const size_t half = values.size() / 2;
  return values.size() % 2 ? values[half] : (values[half - 1] + values[half]) / 2;
}

// The medians of each, over `runs` rounds of one run of each.
inline std::vector<Seconds> medians_in_turn(int runs, const std::vector<std::function<void()>>& works) {
  std::vector<std::vector<double>> wall(works.size()), cpu(works.size());
  for (int run = 0; run < runs; ++run)
    for (size_t i = 0; i < works.size(); ++i) {
      const Seconds taken = seconds_of(works[i]);
      wall[i].push_back(taken.wall);
      cpu[i].push_back(taken.cpu);
    }
  std::vector<Seconds> medians;
  for (size_t i = 0; i < works.size(); ++i) medians.push_back({median(wall[i]), median(cpu[i])});
  return medians;
}

}  // namespace focal_bench
