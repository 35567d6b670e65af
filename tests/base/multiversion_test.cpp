// The choice among versions of a kernel.
#include "base/multiversion.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <utility>
#include <vector>

using namespace focal;

namespace {

FOCAL_MULTIVERSION(int width_of_version(), return vector_bytes;)
FOCAL_MULTIVERSION(void add_to(float* sum, const float* values, int count),
                   for (int i = 0; i < count; ++i) sum[i] += values[i];)

}  // namespace

TEST_CASE("a limit chooses the version that runs, and never one beyond the processor") {
  const InstructionSet widest = instruction_set();
  const std::pair<InstructionSet, int> versions[] = {
      {InstructionSet::baseline, 16}, {InstructionSet::avx2, 32}, {InstructionSet::avx512, 64}};
  for (const auto& [set, bytes] : versions) {
    limit_instruction_set(set);
    CHECK(instruction_set() == std::min(set, widest));
    if (set <= widest) CHECK(width_of_version() == bytes);
    std::vector<float> sum(37, 1), values(37, 0.5f);
    add_to(sum.data(), values.data(), 37);
    CHECK(sum == std::vector<float>(37, 1.5f));
  }
  CHECK(instruction_set() == widest);
}
