#include "base/memory_budget.h"

#include <pthread.h>

#include <mutex>
#include <new>
#include <utility>

namespace focal {
namespace {

constinit std::atomic<int64_t> held{0};

// Each thread's innermost ScopedMemoryBudget. Not thread_local: the C library terminates the process when it
// cannot allocate a library's thread-local variables, at any first use of one; a pthread key allocates
// nothing or reports the failure. Created with the first budget.
class Innermost {
 public:
  ~Innermost() {  // runs when the library is unloaded
    if (made_.exchange(false)) pthread_key_delete(key_);
  }
  void make() {
    const std::scoped_lock lock(mutex_);
    if (made_) return;
    if (pthread_key_create(&key_, nullptr) != 0) throw std::bad_alloc();
    made_.store(true, std::memory_order_release);
  }
  ScopedMemoryBudget* get() const {
    return made_.load(std::memory_order_acquire) ? static_cast<ScopedMemoryBudget*>(pthread_getspecific(key_))
                                                 : nullptr;
  }
  // Allocates only for a thread's first value that is not null. If that fails, nothing changes.
  void set(ScopedMemoryBudget* scope) {
    if (made_.load(std::memory_order_acquire)) pthread_setspecific(key_, scope);
  }

 private:
  std::mutex mutex_;
  std::atomic<bool> made_{false};
  pthread_key_t key_{};
};
Innermost innermost;

}  // namespace

MemoryBudget::MemoryBudget(int64_t bytes) : limit(bytes) { innermost.make(); }

int64_t memory_held() { return held.load(std::memory_order_relaxed); }

const MemoryBudget* memory_budget() {
  const ScopedMemoryBudget* const scope = innermost.get();
  return scope ? scope->budget_ : nullptr;
}

ScopedMemoryBudget::ScopedMemoryBudget(const MemoryBudget* budget) noexcept
    : outer_(innermost.get()), budget_(budget) {
  innermost.set(this);
}

ScopedMemoryBudget::~ScopedMemoryBudget() {
  if (innermost.get() == this) innermost.set(outer_);
}

void ScopedMemoryBudget::adopt(std::shared_ptr<const MemoryBudget> budget) {
  if (!budget) return;
  ScopedMemoryBudget* const scope = innermost.get();
  if (!scope) throw std::bad_alloc();  // the constructor could not allocate
  if (scope->budget_) return;
  scope->owner_ = std::move(budget);
  scope->budget_ = scope->owner_.get();
}

bool take_memory(int64_t bytes) {
  const int64_t before = held.fetch_add(bytes, std::memory_order_relaxed);
  const MemoryBudget* const budget = memory_budget();
  if (!budget || before + bytes <= budget->limit) return true;
  give_memory(bytes);
  budget->held = before, budget->asked = bytes;
  return false;
}

void give_memory(int64_t bytes) { held.fetch_sub(bytes, std::memory_order_relaxed); }

}  // namespace focal
