// A value made when first asked for.
#pragma once
#include <mutex>
#include <optional>

namespace focal {

// Any thread may ask. A make() that throws leaves the value unmade, for the next call to try again: std::call_once
// would send the exception through pthread_once of the C library, which ends the process where the C++ runtime is
// linked statically.
template <class T>
class Lazy {
 public:
  template <class Make>
  const T& get(Make&& make) const {
    const std::scoped_lock lock(mutex_);
    if (!value_) value_.emplace(make());
    return *value_;
  }

 private:
  mutable std::mutex mutex_;
  mutable std::optional<T> value_;
};

}  // namespace focal
