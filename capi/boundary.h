// The one place where C++ meets C: every exported function runs its body in here.
#pragma once
#include <cfenv>
#include <utility>

#include "base/memory_budget.h"
#include "focal/focal.h"

namespace focal {

// Default rounding, no flushing of denormals and no traps inside; the host's settings again outside.
class DefaultFloatEnvironment {
 public:
  DefaultFloatEnvironment() noexcept;
  ~DefaultFloatEnvironment();
  DefaultFloatEnvironment(const DefaultFloatEnvironment&) = delete;
  DefaultFloatEnvironment& operator=(const DefaultFloatEnvironment&) = delete;

 private:
  std::fenv_t host_;
};

// Call it inside a catch block: keeps message and hint for focal_last_error and returns the status.
focal_status record_current_exception() noexcept;

const char* last_error() noexcept;

// body() throws on failure.
template <class Body>
focal_status guarded(Body&& body) noexcept {
  const DefaultFloatEnvironment environment;
  const ScopedMemoryBudget memory(nullptr);  // resolve() finds the budget
  try {
    std::forward<Body>(body)();
    return FOCAL_OK;
  } catch (...) {
    return record_current_exception();
  }
}

// For getters: what body() returns, or 0 (NULL) after a failure.
template <class Value, class Body>
Value guarded_value(Body&& body) noexcept {
  Value value{};
  guarded([&] { value = static_cast<Value>(std::forward<Body>(body)()); });
  return value;
}

}  // namespace focal
