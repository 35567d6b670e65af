#include "arguments.h"
#include "boundary.h"
#include "objects.h"

namespace focal {
namespace {

void claim(TaskObject& object) {
  if (object.busy.exchange(true))
    throw Error(Status::invalid_argument, "the focal_task is in use by a call that still runs",
                "make one focal_task for each call");
}

}  // namespace

TaskLease::TaskLease(focal_task* handle) {
  if (!handle) return;
  auto object = resolve<TaskObject>(handle);
  claim(*object);
  object_ = std::move(object);
  object_->task.restart();
}

TaskLease::~TaskLease() {
  if (!object_) return;
  if (std::uncaught_exceptions() == exceptions_) object_->task.begin_stage("done", 1, 1);
  object_->busy = false;
}

}  // namespace focal

using namespace focal;

focal_status focal_task_create(focal_task** out_task) {
  return guarded([&] {
    require(out_task, "out_task");
    *out_task = publish(std::make_shared<TaskObject>());
  });
}

focal_status focal_task_destroy(focal_task* task) { return remove_handle(task, HandleType::task); }

focal_status focal_task_cancel(focal_task* task) {
  return guarded([&] { resolve<TaskObject>(task)->task.cancel(); });
}

focal_status focal_task_reset(focal_task* task) {
  return guarded([&] {
    const auto object = resolve<TaskObject>(task);
    claim(*object);
    object->task.reset();
    object->busy = false;
  });
}

double focal_task_progress(const focal_task* task) {
  return guarded_value<double>([&] { return resolve<TaskObject>(task)->task.progress(); });
}

const char* focal_task_stage(const focal_task* task) {
  return guarded_value<const char*>([&] { return resolve<TaskObject>(task)->task.stage(); });
}

int32_t focal_task_is_cancelled(const focal_task* task) {
  return guarded_value<int32_t>([&] { return resolve<TaskObject>(task)->task.cancelled(); });
}
