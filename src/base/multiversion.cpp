#include "base/multiversion.h"

#include <algorithm>

namespace focal {
namespace {

InstructionSet of_processor() {
#if defined(__x86_64__) && defined(__GNUC__)
  __builtin_cpu_init();
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")) return InstructionSet::baseline;
  return __builtin_cpu_supports("avx512f") ? InstructionSet::avx512 : InstructionSet::avx2;
#else
  return InstructionSet::baseline;
#endif
}

}  // namespace

std::atomic<InstructionSet> chosen_instruction_set{of_processor()};

void limit_instruction_set(InstructionSet widest) {
  chosen_instruction_set = std::min(of_processor(), widest);
}

}  // namespace focal
