// The module's one exported function.
#include "device/table.h"
#include "queue.h"

extern "C" __attribute__((visibility("default"))) const focal::ComputeTable* focal_compute_entry(
    uint32_t version) {
  return version == focal::compute_version ? focal::TableOf<focal::CudaQueue>::table() : nullptr;
}
