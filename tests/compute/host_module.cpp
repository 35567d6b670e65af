// The module played by the host: loaded by name like the real one, with the same table.
#include <cstdint>

#include "compute/backend.h"
#include "host_faults.h"

namespace focal_test {
const focal::ComputeTable* host_table();
}

extern "C" __attribute__((visibility("default"))) const focal::ComputeTable* focal_compute_entry(
    uint32_t version) {
#ifdef STALE
  return version ? nullptr : focal_test::host_table();
#else
  return version == focal::compute_version ? focal_test::host_table() : nullptr;
#endif
}

extern "C" __attribute__((visibility("default"))) focal_test::HostFaults* focal_host_faults() {
  return &focal_test::host_faults;
}
