// Inner loops compiled once for each vector width; the loader picks the widest that the processor has.
#pragma once
#include <cstdint>  // any libc header, for __GLIBC__: the choice needs its indirect functions

// FOCAL_MULTIVERSION(void kernel(float* x, int n), body<vector_bytes>(x, n);) defines `kernel`, its body
// compiled with vector_bytes = 16, 32 (AVX2) and 64 (AVX-512). Give what the body calls FOCAL_INLINE, so that
// it is compiled for the same processor. With -ffp-contract=off all versions give the same bits, if they add
// in the same order. Only callers in the same file get the choice, so a kernel belongs in an anonymous
// namespace. Sanitizers cannot run while the loader chooses: there, and on other systems, only one version
// exists.
#if defined(__x86_64__) && defined(__GLIBC__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define FOCAL_MULTIVERSION(signature, ...)            \
  [[gnu::target("default")]] signature {              \
    [[maybe_unused]] constexpr int vector_bytes = 16; \
    __VA_ARGS__                                       \
  }                                                   \
  [[gnu::target("avx2,fma")]] signature {             \
    [[maybe_unused]] constexpr int vector_bytes = 32; \
    __VA_ARGS__                                       \
  }                                                   \
  [[gnu::target("avx512f,fma")]] signature {          \
    [[maybe_unused]] constexpr int vector_bytes = 64; \
    __VA_ARGS__                                       \
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
