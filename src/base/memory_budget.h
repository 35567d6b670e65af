// The memory that the library holds in the process, and the limit for a call.
#pragma once
#include <atomic>
#include <cstdint>
#include <memory>

namespace focal {

// The budget of one context. An allocation that would exceed it fails as if no memory were left.
struct MemoryBudget {
  explicit MemoryBudget(int64_t limit);  // bytes, for everything that the library holds

  const int64_t limit;
  // Bytes requested and bytes held at the last refused allocation; 0 before the first. Any thread.
  mutable std::atomic<int64_t> asked{0}, held{0};
};

// Bytes that the library holds now, for all purposes. 0 in programs that do not allocate through
// capi/allocator.cpp.
int64_t memory_held();

// The budget of this thread's allocations; null: none.
const MemoryBudget* memory_budget();

// Sets the budget of this thread's allocations until the end of the scope; null: no budget.
class ScopedMemoryBudget {
 public:
  explicit ScopedMemoryBudget(const MemoryBudget* budget) noexcept;
  ~ScopedMemoryBudget();
  ScopedMemoryBudget(const ScopedMemoryBudget&) = delete;
  ScopedMemoryBudget& operator=(const ScopedMemoryBudget&) = delete;

  // Switches to another budget until the end of this thread's innermost scope, unless that scope has one
  // already. null is allowed. Throws std::bad_alloc.
  static void adopt(std::shared_ptr<const MemoryBudget> budget);

 private:
  friend const MemoryBudget* memory_budget();
  ScopedMemoryBudget* outer_ = nullptr;
  const MemoryBudget* budget_;
  std::shared_ptr<const MemoryBudget> owner_;
};

// For allocators: counts `bytes` more as held. Returns false and changes nothing when the budget does not
// allow it.
bool take_memory(int64_t bytes);
void give_memory(int64_t bytes);

}  // namespace focal
