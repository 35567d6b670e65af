// The operations of the module that the host plays: compiled once for the good and the stale module.
#include "device/table.h"
#include "host_queue.h"

namespace focal_test {

const focal::ComputeTable* host_table() { return focal::TableOf<HostQueue>::table(); }

}  // namespace focal_test
