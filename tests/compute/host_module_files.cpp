#include "compute/host_module_files.h"

#include <dlfcn.h>

namespace focal_test {

const std::string host_module = FOCAL_HOST_module, stale_module = FOCAL_HOST_stale_module,
                  good_driver = FOCAL_good_driver, old_driver = FOCAL_old_driver,
                  bare_driver = FOCAL_bare_driver, broken_driver = FOCAL_broken_driver;

HostFaults& module_faults() {
  void* module = dlopen(host_module.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
  return *reinterpret_cast<HostFaults* (*)()>(dlsym(module, "focal_host_faults"))();
}

}  // namespace focal_test
