// focal_context: how calls are run.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "base/memory_budget.h"
#include "base/parallel.h"
#include "handles.h"

namespace focal {

struct ContextObject {
  using Handle = focal_context;
  static constexpr HandleType type = HandleType::context;

  focal_backend backend = FOCAL_BACKEND_CPU;
  std::string backend_reason;
  Execution execution;                                // without a task
  std::shared_ptr<const MemoryBudget> memory_budget;  // null: none
  focal_log_fn log = nullptr;
  void* log_user_data = nullptr;

  Execution execution_with(Task* task) const;
  void report(focal_log_level level, const std::string& message) const;
  void report_warnings(const std::vector<std::string>& warnings) const;
};

}  // namespace focal
