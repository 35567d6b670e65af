#include "compute/module_loader.h"

#include "base/library_folder.h"
#include "base/shared_library.h"
#include "base/system.h"

namespace focal {
namespace {

constexpr int oldest_driver = 12000;  // as cuDriverGetVersion counts: the one that came with CUDA 12.0

template <class Function>
Function find(void* library, const char* name) {
  return reinterpret_cast<Function>(find_symbol(library, name));
}

// Asks the driver itself, so that a module is only opened where it has something to run on. Empty: all is well.
std::string driver_problem(const std::string& path, int32_t device_index) {
  std::string why;
  void* driver = open_library(path, why);
  if (!driver) return "there is no NVIDIA driver (" + why + ")";
  const auto init = find<int (*)(unsigned)>(driver, "cuInit");
  const auto version_of = find<int (*)(int*)>(driver, "cuDriverGetVersion");
  const auto count_of = find<int (*)(int*)>(driver, "cuDeviceGetCount");
  if (!init || !version_of || !count_of) return "the NVIDIA driver lacks functions that are needed";
  int version = 0, count = 0;
  if (version_of(&version) != 0 || version < oldest_driver)
    return "the NVIDIA driver is too old: it knows CUDA " + std::to_string(version / 1000) + "." +
           std::to_string(version % 1000 / 10) + ", needed is 12.0";
  if (const int error = init(0))
    return "the NVIDIA driver does not start (error " + std::to_string(error) + ")";
  if (count_of(&count) != 0 || count == 0) return "there is no CUDA device";
  if (device_index >= count)
    return "there is no CUDA device " + std::to_string(device_index) + ", only " + std::to_string(count);
  return {};
}

const ComputeTable* table_of(void* module, std::string& why) {
  const auto entry = find<ComputeEntry>(module, compute_entry_name);
  const ComputeTable* table = entry ? entry(compute_version) : nullptr;
  if (!table || table->version != compute_version || table->struct_size != sizeof(ComputeTable)) {
    why = "the GPU module belongs to another version of focal";
    return nullptr;
  }
  return table;
}

std::string or_cpu(const std::string& why) { return why + ", so the CPU is used"; }

}  // namespace

Backend::~Backend() {
  kept_.clear();
  table_.device_close(device_);
}

bool Backend::works() const {
  const std::scoped_lock lock(mutex_);
  return end_.empty();
}

const char* Backend::reason() const {
  const std::scoped_lock lock(mutex_);
  return end_.empty() ? name_.c_str() : end_.c_str();
}

void Backend::record(const BackendFailure& failure) const {
  const std::scoped_lock lock(mutex_);
  if (failure.lasting && end_.empty())
    end_ = or_cpu(std::string("the GPU failed for good (") + failure.what() + ")");
}

std::shared_ptr<void> Backend::kept(const std::weak_ptr<const void>& owner,
                                    const std::function<std::shared_ptr<void>()>& make) const {
  const std::scoped_lock lock(mutex_);
  std::erase_if(kept_, [](const auto& entry) { return entry.first.expired(); });
  for (const auto& [of, value] : kept_)
    if (!of.owner_before(owner) && !owner.owner_before(of)) return value;
  std::shared_ptr<void> made = make();
  if (!owner.expired()) kept_.emplace_back(owner, made);
  return made;
}

std::string with_fallback(const Execution& execution, const std::function<void(const Execution&)>& work) {
  Execution on_cpu = execution;
  on_cpu.backend = nullptr;
  if (!execution.backend || !execution.backend->works()) return work(on_cpu), "";
  try {
    return work(execution), "";
  } catch (const BackendFailure& failure) {
    execution.backend->record(failure);
    work(on_cpu);
    return std::string("the GPU failed (") + failure.what() + "), so the CPU did this mesh";
  }
}

BackendFiles backend_files() {
  BackendFiles files;
  files.driver = nvidia_driver_file;
  if (const std::string folder = library_folder(); !folder.empty())
    files.module = folder + "/" + library_file_name("focal_cuda");
  return files;
}

LoadedBackend load_backend(const BackendFiles& files, int32_t device_index) {
  if (files.module.empty() || !is_regular_file(files.module))
    return {nullptr, or_cpu("there is no GPU module beside the library")};
  if (const std::string problem = driver_problem(files.driver, device_index); !problem.empty())
    return {nullptr, or_cpu(problem)};
  std::string why;
  void* module = open_library(files.module, why);
  if (!module) return {nullptr, or_cpu("the GPU module cannot be loaded (" + why + ")")};
  const ComputeTable* table = table_of(module, why);
  if (!table) return {nullptr, or_cpu(why)};
  void* device = nullptr;
  char name[160] = {};
  ComputeFailure failure{};
  if (table->device_open(device_index, &device, name, sizeof name, &failure) != 0)
    return {nullptr, or_cpu("the GPU cannot be used (" + std::string(failure.reason) + ")")};
  std::unique_ptr<void, void (*)(void*)> opened(device, table->device_close);
  auto backend = std::make_shared<Backend>(*table, device, "the GPU is used: " + std::string(name));
  opened.release();
  return {std::move(backend), {}};
}

}  // namespace focal
