// How a stage runs: its threads, and the task that can cancel it. Passed by const reference through every
// stage.
#pragma once
#include <cstdint>
#include <functional>

#include "base/task.h"

namespace focal {

class Backend;

struct Execution {
  int thread_count = 0;  // 0: one per core
  Task* task = nullptr;  // may be null
  // False inside a body of parallel_for: cancellable, but the outer loop reports the progress.
  bool reports = true;
  // The host's own parallel loop, or empty: runs body(i) for i in [0, count) in any order and returns when
  // all are done.
  std::function<void(int64_t count, const std::function<void(int64_t)>& body)> host_parallel_for;
  const Backend* backend = nullptr;  // see compute/module_loader.h; null: the CPU

  int threads() const;
  // For stages inside a body of parallel_for: one thread, no progress of their own.
  Execution inner() const {
    return {.thread_count = 1, .task = task, .reports = false, .host_parallel_for = {}, .backend = nullptr};
  }
  // Throws Error{cancelled} when the task was cancelled. Call it at least every few milliseconds of work.
  void check_cancelled() const;
  void begin_stage(const char* name, double from, double to) const {
    if (task && reports) task->begin_stage(name, from, to);
  }
  void report(double fraction) const {
    if (task && reports) task->report(fraction);
  }
};

// Runs body(i) for every i in [0, count) on execution.threads() threads, started and joined inside the call.
// The order is not defined, so a body must write only data that belongs to i; results are then the same bits
// for any number of threads. Checks for cancellation before each i; rethrows the first exception of a body.
void parallel_for(const Execution& execution, int64_t count, const std::function<void(int64_t)>& body);

// The same over [0, count) split into ranges of at most `grain`.
void parallel_for_ranges(const Execution& execution, int64_t count, int64_t grain,
                         const std::function<void(int64_t begin, int64_t end)>& body);

}  // namespace focal
