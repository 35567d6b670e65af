// Progress of long calls on a terminal, and Ctrl-C as a clean cancel.
#pragma once
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <string>
#include <thread>

#include "handles.h"

namespace focal_cli {

// Lives for the length of a verb. A thread of its own watches the running task: it draws one line with stage,
// percentage and remaining time when stderr is a terminal, and cancels the task on the first Ctrl-C (or
// SIGTERM); the second Ctrl-C ends the process at once.
class Progress {
 public:
  explicit Progress(bool quiet);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // The task for the next long call, which is part `index` of `count` equal ones. It lives until the next
  // begin. Throws CommandError when Ctrl-C has been pressed.
  focal_task* begin(const std::string& what, size_t index = 0, size_t count = 1);
  void clear();  // wipes the line, before other text is printed

 private:
  void watch();
  void draw();

  const bool draws_;
  std::mutex mutex_;
  std::condition_variable wake_;
  bool done_ = false;
  bool drawn_ = false;
  Task task_;
  std::string what_;
  size_t index_ = 0, count_ = 1;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::thread watcher_;
};

}  // namespace focal_cli
