// What the fuzz targets have in common: each is a program with libFuzzer's entry, linked to libFuzzer or to driver.cpp.
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <span>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size);

namespace fuzz {

using Bytes = std::vector<std::byte>;

// A promise; breaking it ends the program, which the fuzzer reports with the input.
inline void insist(bool holds, const char* promise) {
  if (holds) return;
  std::fprintf(stderr, "broken promise: %s\n", promise);
  std::abort();
}

}  // namespace fuzz
