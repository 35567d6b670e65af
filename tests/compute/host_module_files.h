// Where the module and the drivers that are none lie, and the module's faults.
#pragma once
#include <string>

#include "compute/host_faults.h"
#include "compute/module_loader.h"

namespace focal_test {

extern const std::string host_module, stale_module, good_driver, old_driver, bare_driver, broken_driver;

// Of the loaded module, which is another library than the tests.
HostFaults& module_faults();

inline std::shared_ptr<focal::Backend> host_backend() {
  return focal::load_backend({good_driver, host_module}, 0).backend;
}

}  // namespace focal_test
