// The module played by the host: loaded by name like the real one, with the same table.
#include "device/table.h"
#include "host_queue.h"

extern "C" __attribute__((visibility("default"))) const focal::ComputeTable* focal_compute_entry(
    uint32_t version) {
#ifdef STALE
  return version ? nullptr : focal::TableOf<focal_test::HostQueue>::table();
#else
  return version == focal::compute_version ? focal::TableOf<focal_test::HostQueue>::table() : nullptr;
#endif
}

extern "C" __attribute__((visibility("default"))) focal_test::HostFaults* focal_host_faults() {
  return &focal_test::host_faults;
}
