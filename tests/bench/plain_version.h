// Included before every file of the library that the instruction counts run: kernels exist in one version only, that of
// the oldest processor, so that the counts do not depend on the processor that counts.
#pragma once
#include "base/multiversion.h"

#undef FOCAL_MULTIVERSION
#define FOCAL_MULTIVERSION(signature, ...)            \
  signature {                                         \
    [[maybe_unused]] constexpr int vector_bytes = 16; \
    __VA_ARGS__                                       \
  }
