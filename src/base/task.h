// Progress and cancellation of one long call. Written by the worker, read and cancelled from any thread.
#pragma once
#include <atomic>

namespace focal {

class Task {
 public:
  // Callable from any thread.
  void cancel() { cancelled_.store(true, std::memory_order_relaxed); }
  bool cancelled() const { return cancelled_.load(std::memory_order_relaxed); }
  double progress() const { return progress_.load(std::memory_order_relaxed); }
  const char* stage() const { return stage_.load(std::memory_order_relaxed); }

  // Called by the working thread. name must be a string literal; this stage covers [from, to] of the total
  // progress.
  void begin_stage(const char* name, double from, double to) {
    stage_.store(name, std::memory_order_relaxed);
    from_ = from, to_ = to;
    report(0);
  }
  // fraction of the current stage, 0..1; the total never decreases.
  void report(double fraction) {
    const double next = from_ + (to_ - from_) * fraction;
    if (next > progress()) progress_.store(next, std::memory_order_relaxed);
  }
  // Prepares for the next call; a cancellation from before it still counts.
  void restart() {
    progress_.store(0), stage_.store("");
    from_ = 0, to_ = 1;
  }
  void reset() {
    restart();
    cancelled_.store(false);
  }

 private:
  std::atomic<bool> cancelled_{false};
  std::atomic<double> progress_{0};
  std::atomic<const char*> stage_{""};
  double from_ = 0, to_ = 1;
};

}  // namespace focal
