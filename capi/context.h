// focal_context: how calls are run.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "base/lazy.h"
#include "base/memory_budget.h"
#include "base/parallel.h"
#include "compute/module_loader.h"
#include "handles.h"
#include "model/stock_models.h"

namespace focal {

struct ContextObject {
  using Handle = focal_context;
  static constexpr HandleType type = HandleType::context;

  std::shared_ptr<const Backend> backend;             // null: the CPU
  std::string cpu_reason;                             // then why
  Execution execution;                                // without a task
  std::shared_ptr<const MemoryBudget> memory_budget;  // null: none
  focal_log_fn log = nullptr;
  void* log_user_data = nullptr;
  std::string models_folder;  // of the host; empty: none

  focal_backend used_backend() const;
  const char* backend_reason() const;
  Execution execution_with(Task* task) const;
  void report(focal_log_level level, const std::string& message) const;
  void report_warnings(const std::vector<std::string>& warnings) const;
  // Looked up once.
  const std::vector<StockModel>& stock() const;

 private:
  Lazy<std::vector<StockModel>> stock_;
};

}  // namespace focal
