// What became of a landmark: the stages that find it and the files that name it share this.
#pragma once
#include <cstdint>

namespace focal {

enum class LandmarkStatus : int32_t { found = 0, uncertain = 1, absent = 2 };

// As files have it: "found".
constexpr const char* name_of(LandmarkStatus status) {
  return status == LandmarkStatus::found       ? "found"
         : status == LandmarkStatus::uncertain ? "uncertain"
                                               : "absent";
}

}  // namespace focal
