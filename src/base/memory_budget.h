// What the library holds of the process's memory, and what a call may make of it.
#pragma once
#include <atomic>
#include <cstdint>
#include <memory>

namespace focal {

// Of one context. Calls that would take the library beyond it are refused memory, as if there were no more.
struct MemoryBudget {
  explicit MemoryBudget(int64_t limit);  // bytes, of all that the library holds

  const int64_t limit;
  // What was asked for when it was last refused, and what was held then; 0 when it never was. Any thread.
  mutable std::atomic<int64_t> asked{0}, held{0};
};

// Bytes that the library holds now, whatever for. 0 in programs that do not allocate through capi/allocator.cpp.
int64_t memory_held();

// The budget that this thread's allocations keep to; null: none.
const MemoryBudget* memory_budget();

// Allocations of this thread keep to the budget, null: to none, until the end of the scope.
class ScopedMemoryBudget {
 public:
  explicit ScopedMemoryBudget(const MemoryBudget* budget) noexcept;
  ~ScopedMemoryBudget();
  ScopedMemoryBudget(const ScopedMemoryBudget&) = delete;
  ScopedMemoryBudget& operator=(const ScopedMemoryBudget&) = delete;

  // To this one instead, to the end of this thread's innermost scope, unless that has one. null is fine. Throws
  // std::bad_alloc.
  static void adopt(std::shared_ptr<const MemoryBudget> budget);

 private:
  friend const MemoryBudget* memory_budget();
  ScopedMemoryBudget* outer_ = nullptr;
  const MemoryBudget* budget_;
  std::shared_ptr<const MemoryBudget> owner_;
};

// For allocators: `bytes` more are held; false, and nothing has changed, when the budget does not allow them.
bool take_memory(int64_t bytes);
void give_memory(int64_t bytes);

// What another library allocates for us. Throws std::bad_alloc when the budget does not allow it.
class ExternalAllocation {
 public:
  explicit ExternalAllocation(int64_t bytes);
  ~ExternalAllocation() { give_memory(bytes_); }
  ExternalAllocation(const ExternalAllocation&) = delete;
  ExternalAllocation& operator=(const ExternalAllocation&) = delete;

 private:
  int64_t bytes_;
};

}  // namespace focal
