// Finds, checks and opens a GPU module (see backend.h). Nothing here can fail a call: without a module that works there
// is no backend, and a sentence that says why.
#pragma once
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/parallel.h"
#include "compute/backend.h"

namespace focal {

// What a device call failed of. Whoever catches it does the whole mesh on the CPU.
struct BackendFailure : Error {
  explicit BackendFailure(const ComputeFailure& failure)
      : Error(Status::internal, failure.reason, "use the CPU backend"), lasting(failure.lasting != 0) {}
  bool lasting;
};

// An open device. Immutable but for its end: after a lasting failure it is used no more.
class Backend {
 public:
  Backend(const ComputeTable& table, void* device, std::string name)
      : table_(table), device_(device), name_(std::move(name)) {}
  ~Backend();
  Backend(const Backend&) = delete;

  const ComputeTable& table() const { return table_; }
  void* device() const { return device_; }
  bool works() const;
  // What is used and why, one sentence. The text lives as long as the backend.
  const char* reason() const;
  // Remembers it; after a lasting one the backend no longer works.
  void record(const BackendFailure& failure) const;
  // What was uploaded for an owner, made when first asked for; given up once the owner is no more.
  std::shared_ptr<void> kept(const std::weak_ptr<const void>& owner,
                             const std::function<std::shared_ptr<void>()>& make) const;
  // Throws BackendFailure when the call failed. arguments: those before the failure.
  template <class Function, class... Arguments>
  void call(Function function, Arguments... arguments) const {
    ComputeFailure failure{};
    if (function(arguments..., &failure) != 0) throw BackendFailure(failure);
  }

 private:
  const ComputeTable& table_;
  void* device_;
  std::string name_;
  mutable std::mutex mutex_;
  mutable std::string end_;  // why it ended; written once
  mutable std::vector<std::pair<std::weak_ptr<const void>, std::shared_ptr<void>>> kept_;
};

// Runs work(execution) with the backend; where that fails, once more on the CPU, from the start: what comes out is then to the
// bit what the CPU alone makes. Returns a sentence on the failure, or nothing.
std::string with_fallback(const Execution& execution, const std::function<void(const Execution&)>& work);

struct BackendFiles {
  std::string driver;  // as open_library takes it
  std::string module;  // a path
};
// libfocal_cuda.so (focal_cuda.dll) beside the library or program that holds this code, and nowhere else.
BackendFiles backend_files();

struct LoadedBackend {
  std::shared_ptr<Backend> backend;  // null: the CPU it is
  std::string reason;                // then why
};
LoadedBackend load_backend(const BackendFiles& files, int32_t device_index);

}  // namespace focal
