#include "base/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "base/error.h"
#include "base/memory_budget.h"

namespace focal {
namespace {

// Joins the threads on every exit path, also when starting a later thread failed.
struct JoiningThreads {
  std::vector<std::thread> threads;
  ~JoiningThreads() {
    for (auto& thread : threads) thread.join();
  }
};

}  // namespace

int Execution::threads() const {
  if (thread_count > 0) return thread_count;
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

void Execution::check_cancelled() const {
  if (task && task->cancelled())
    throw Error(Status::cancelled, "the task was cancelled", "start the call again to have its result");
}

void parallel_for(const Execution& execution, int64_t count, const std::function<void(int64_t)>& body) {
  std::atomic<int64_t> next{0};
  std::atomic<bool> failed{false};
  std::exception_ptr failure;
  std::mutex mutex;
  const MemoryBudget* const budget = memory_budget();
  const auto guarded = [&](int64_t i) noexcept {
    if (failed.load(std::memory_order_relaxed)) return;
    try {
      execution.check_cancelled();
      body(i);
    } catch (...) {
      const std::scoped_lock lock(mutex);
      if (!failure) failure = std::current_exception();
      failed = true;
    }
  };
  if (execution.host_parallel_for && count > 1) {
    execution.host_parallel_for(count, [&](int64_t i) {  // host threads have no budget set
      const ScopedMemoryBudget kept(budget);
      guarded(i);
    });
  } else {
    const auto work = [&]() noexcept {
      const ScopedMemoryBudget kept(budget);
      for (int64_t i; (i = next.fetch_add(1)) < count;) guarded(i);
    };
    JoiningThreads helpers;
    const int64_t extra = std::min<int64_t>(execution.threads(), count) - 1;
    try {
      for (int64_t t = 0; t < extra; ++t) helpers.threads.emplace_back(work);
    } catch (const std::exception&) {
      // Too few threads or too little memory to start more: the running ones do all the work.
    }
    work();
  }
  if (failure) std::rethrow_exception(failure);
}

void parallel_for_ranges(const Execution& execution, int64_t count, int64_t grain,
                         const std::function<void(int64_t, int64_t)>& body) {
  const int64_t ranges = (count + grain - 1) / grain;
  parallel_for(execution, ranges, [&](int64_t r) { body(r * grain, std::min(count, (r + 1) * grain)); });
}

}  // namespace focal
