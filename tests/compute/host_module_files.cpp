#include "compute/host_module_files.h"

#include "base/shared_library.h"

namespace focal_test {

const std::string host_module = FOCAL_HOST_module, stale_module = FOCAL_HOST_stale_module,
                  good_driver = FOCAL_good_driver, old_driver = FOCAL_old_driver,
                  bare_driver = FOCAL_bare_driver, broken_driver = FOCAL_broken_driver;

HostFaults& module_faults() {
  std::string why;
  void* module = focal::open_library(host_module, why);
  return *reinterpret_cast<HostFaults* (*)()>(focal::find_symbol(module, "focal_host_faults"))();
}

}  // namespace focal_test
