// Inner loops compiled once per vector width; the widest that the processor supports is chosen at run time.
#pragma once
#include <atomic>
#include <cstdint>

namespace focal {

enum class InstructionSet : int32_t { baseline = 0, avx2 = 1, avx512 = 2 };

// The widest instruction set of this processor, or a limited one; baseline until the library is initialised.
extern std::atomic<InstructionSet> chosen_instruction_set;
inline InstructionSet instruction_set() { return chosen_instruction_set.load(std::memory_order_relaxed); }
// For tests that compare the instruction sets on one machine: from now on no kernel uses more than `widest`.
// Do not call it while kernels run.
void limit_instruction_set(InstructionSet widest);

}  // namespace focal

// FOCAL_MULTIVERSION(void kernel(float* x, int n), body<vector_bytes>(x, n);) defines `kernel` with its body
// compiled for vector_bytes = 16, 32 (AVX2) and 64 (AVX-512). Declare the functions that the body calls
// FOCAL_INLINE, so that they are compiled for the same processor. With -ffp-contract=off all versions give
// the same bits if they add in the same order. On other processors there is one version of 16 bytes, the
// width of NEON.
#if defined(__x86_64__) && defined(__GNUC__)
#define FOCAL_VERSION(features, bytes, ...)                  \
  return [&]() __attribute__((target(features), noinline)) { \
    [[maybe_unused]] constexpr int vector_bytes = bytes;     \
    __VA_ARGS__                                              \
  }                                                          \
  ()
#define FOCAL_MULTIVERSION(signature, ...)                  \
  signature {                                               \
    switch (::focal::instruction_set()) {                   \
      case ::focal::InstructionSet::avx512:                 \
        FOCAL_VERSION("avx512f,avx2,fma", 64, __VA_ARGS__); \
      case ::focal::InstructionSet::avx2:                   \
        FOCAL_VERSION("avx2,fma", 32, __VA_ARGS__);         \
      default:                                              \
        break;                                              \
    }                                                       \
    [[maybe_unused]] constexpr int vector_bytes = 16;       \
    __VA_ARGS__                                             \
  }
#else
#define FOCAL_MULTIVERSION(signature, ...)            \
  signature {                                         \
    [[maybe_unused]] constexpr int vector_bytes = 16; \
    __VA_ARGS__                                       \
  }
#endif

#if defined(__GNUC__)
#define FOCAL_INLINE [[gnu::always_inline]] inline
#else
#define FOCAL_INLINE inline
#endif
