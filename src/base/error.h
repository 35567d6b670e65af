// The only exception type of focal. Only capi/ catches it and converts it to a focal_status.
#pragma once
#include <cstdint>
#include <stdexcept>
#include <string>

namespace focal {

// Same values as focal_status in focal.h (checked by capi/); never reused.
enum class Status : int32_t {
  ok = 0,
  invalid_argument = 1,
  invalid_mesh = 2,
  invalid_file = 3,
  io = 4,
  out_of_memory = 5,
  unsupported = 6,
  not_converged = 7,
  cancelled = 8,
  internal = 9,
  invalid_handle = 10,
  mesh_too_small = 11,
  file_not_found = 12,
  unsupported_version = 13,
  invalid_landmark = 14,
  too_few_shapes = 15,
};

// message describes the error and names the object; hint says how to fix it.
class Error : public std::runtime_error {
 public:
  Error(Status status, const std::string& message, std::string hint)
      : std::runtime_error(message), status_(status), hint_(std::move(hint)) {}
  Status status() const { return status_; }
  const std::string& hint() const { return hint_; }

 private:
  Status status_;
  std::string hint_;
};

}  // namespace focal
