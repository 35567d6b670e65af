// How the device that the host plays is made to fail.
#pragma once
#include <atomic>
#include <cstdint>

namespace focal_test {

// Counted down at each allocation, launch and download of all queues; the one that reaches 0 fails, and a download brings no
// numbers. Negative: none does.
struct HostFaults {
  std::atomic<int64_t> allocation{-1}, launch{-1}, download{-1};
  std::atomic<bool> lasting{false}, opening{false};
  std::atomic<int64_t> allocations{0}, launches{0}, downloads{0},
      live{0};  // counted; live: bytes not yet released
};
inline HostFaults host_faults;

}  // namespace focal_test
