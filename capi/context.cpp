// How calls are run.
#include <algorithm>
#include <utility>

#include "arguments.h"
#include "base/library_folder.h"
#include "boundary.h"
#include "objects.h"
#include "structs.h"

FOCAL_STRUCT(focal_context_params, 48);
static_assert(sizeof(void*) != 8 || (sizeof(focal_context_params) == 64 &&
                                     offsetof(focal_context_params, memory_budget_bytes) == 48 &&
                                     offsetof(focal_context_params, models_folder) == 56));

namespace focal {
namespace {

// The host's threads may have any floating-point settings, so each body sets its own.
void run_body(void* body_data, int64_t index) {
  const DefaultFloatEnvironment environment;
  (*static_cast<const std::function<void(int64_t)>*>(body_data))(index);
}

auto adapt_parallel_for(focal_parallel_for_fn parallel_for, void* user_data) {
  return [=](int64_t count, const std::function<void(int64_t)>& body) {
    parallel_for(user_data, count, run_body, const_cast<std::function<void(int64_t)>*>(&body));
  };
}

std::shared_ptr<ContextObject> make_context(const focal_context_params& params) {
  check_range("focal_context_params.backend", params.backend, FOCAL_BACKEND_AUTO, FOCAL_BACKEND_CUDA);
  check_range("focal_context_params.device_index", params.device_index, 0, 1023);
  check_range("focal_context_params.thread_count", params.thread_count, 0, 1024);
  auto context = std::make_shared<ContextObject>();
  if (params.backend == FOCAL_BACKEND_CPU) {
    context->cpu_reason = "the CPU was asked for";
  } else {
    LoadedBackend loaded = load_backend(backend_files(), params.device_index);
    context->backend = std::move(loaded.backend), context->cpu_reason = std::move(loaded.reason);
    context->execution.backend = context->backend.get();
  }
  context->execution.thread_count = params.thread_count;
  if (params.memory_budget_bytes > 0) {
    const uint64_t limit = std::min<uint64_t>(params.memory_budget_bytes, INT64_MAX);
    context->memory_budget = std::make_shared<const MemoryBudget>(static_cast<int64_t>(limit));
  }
  if (params.parallel_for)
    context->execution.host_parallel_for =
        adapt_parallel_for(params.parallel_for, params.parallel_for_user_data);
  context->log = params.log;
  context->log_user_data = params.log_user_data;
  if (params.models_folder) context->models_folder = params.models_folder;
  return context;
}

}  // namespace

focal_backend ContextObject::used_backend() const {
  return backend && backend->works() ? FOCAL_BACKEND_CUDA : FOCAL_BACKEND_CPU;
}

const char* ContextObject::backend_reason() const { return backend ? backend->reason() : cpu_reason.c_str(); }

Execution ContextObject::execution_with(Task* task) const {
  Execution with_task = execution;
  with_task.task = task;
  with_task.check_cancelled();
  return with_task;
}

const std::vector<StockModel>& ContextObject::stock() const {
  return stock_.get([&] { return stock_models_in(stock_folders(models_folder, library_folder())); });
}

void ContextObject::report(focal_log_level level, const std::string& message) const {
  if (log) log(log_user_data, level, message.c_str());
}

void ContextObject::report_warnings(const std::vector<std::string>& warnings) const {
  for (const std::string& warning : warnings) report(FOCAL_LOG_WARNING, warning);
}

}  // namespace focal

using namespace focal;

focal_status focal_context_create(const focal_context_params* params, focal_context** out_context) {
  return guarded([&] {
    require(out_context, "out_context");
    const focal_context_params how = read_struct(params);
    const auto context = make_context(how);
    const bool missed = how.backend == FOCAL_BACKEND_CUDA && !context->backend;
    context->report(missed ? FOCAL_LOG_WARNING : FOCAL_LOG_INFO, context->backend_reason());
    *out_context = publish(context);
  });
}

focal_status focal_context_destroy(focal_context* context) {
  return remove_handle(context, HandleType::context);
}

focal_backend focal_context_backend(const focal_context* context) {
  return guarded_value<focal_backend>([&] { return resolve<ContextObject>(context)->used_backend(); });
}

const char* focal_context_backend_reason(const focal_context* context) {
  return guarded_value<const char*>([&] { return resolve<ContextObject>(context)->backend_reason(); });
}

uint64_t focal_context_memory_held(const focal_context* context) {
  return guarded_value<uint64_t>([&] {
    resolve<ContextObject>(context);
    return std::max<int64_t>(memory_held(), 0);
  });
}

int32_t focal_context_thread_count(const focal_context* context) {
  return guarded_value<int32_t>([&] { return resolve<ContextObject>(context)->execution.threads(); });
}
