// Section METH of model and analysis files: the names of the descriptor and the distance. Files without it
// use the first of each, the only ones of early versions.
#pragma once
#include "base/archive.h"

namespace focal {

inline constexpr const char* method_section = "METH";

// Indices into the lists of descriptors/descriptor.h and geodesics/distance.h.
struct Method {
  int32_t descriptor = 0, distance = 0;
  bool is_first() const { return descriptor == 0 && distance == 0; }
};

std::vector<std::byte> write_method(const Method& method);
// Throws unsupported when this library does not have it.
Method read_method(const Archive& archive);

}  // namespace focal
