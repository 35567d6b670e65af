// focal_task: progress and cancellation of one call at a time.
#pragma once
#include <atomic>
#include <exception>
#include <memory>

#include "base/task.h"
#include "handles.h"

namespace focal {

struct TaskObject {
  using Handle = focal_task;
  static constexpr HandleType type = HandleType::task;

  Task task;
  std::atomic<bool> busy{false};
};

// Holds the caller's task, which may be NULL, for one call. Unless an exception ends it, the task says then that all is done.
class TaskLease {
 public:
  // Throws invalid_handle; invalid_argument when another call has it; cancelled when it was cancelled before.
  explicit TaskLease(focal_task* handle);
  ~TaskLease();
  TaskLease(const TaskLease&) = delete;
  TaskLease& operator=(const TaskLease&) = delete;

  Task* task() const { return object_ ? &object_->task : nullptr; }

 private:
  std::shared_ptr<TaskObject> object_;
  int exceptions_ = std::uncaught_exceptions();
};

}  // namespace focal
