// The result for a landmark, shared by detection and the file formats.
#pragma once
#include <cstdint>

namespace focal {

enum class LandmarkStatus : int32_t { found = 0, uncertain = 1, absent = 2 };

// The name in files: "found".
constexpr const char* name_of(LandmarkStatus status) {
  return status == LandmarkStatus::found       ? "found"
         : status == LandmarkStatus::uncertain ? "uncertain"
                                               : "absent";
}

}  // namespace focal
