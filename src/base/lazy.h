// A value that is created on first use.
#pragma once
#include <mutex>
#include <optional>

namespace focal {

// Thread-safe. If make() throws, the value stays empty and the next call tries again. std::call_once would
// send the exception through pthread_once of the C library, which terminates the process where the C++
// runtime is linked statically.
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
