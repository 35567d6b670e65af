// The backend under test, and the surfaces that all stages are tried on.
#pragma once
#include <memory>

#include "compute/host_queue.h"
#include "compute/module_loader.h"

namespace focal_test {

#ifdef FOCAL_SANITIZED  // many times slower: the same code, on less, where landmarks are not as sure
inline constexpr bool sanitized = true;
#else
inline constexpr bool sanitized = false;
#endif

inline focal::BackendFiles files;
inline std::shared_ptr<focal::Backend> backend;

HostFaults* faults();  // the counters of a module that can be told to fail, or null

}  // namespace focal_test
