// Whatever is missing, stale or broken: the CPU it is, and the reason says why.
#include "compute/module_loader.h"

#include <doctest/doctest.h>

#include "base/atomic_file.h"
#include "base/shared_library.h"
#include "compute/host_module_files.h"
#include "temporary_folder.h"

using namespace focal;
using namespace focal_test;

namespace {

void check_refused(const BackendFiles& files, const std::string& why, int32_t device = 0) {
  const LoadedBackend loaded = load_backend(files, device);
  CHECK_FALSE(loaded.backend);
  CHECK_MESSAGE(loaded.reason.find(why) != std::string::npos, loaded.reason);
  CHECK(loaded.reason.find("so the CPU is used") != std::string::npos);
}

}  // namespace

TEST_CASE("a module and a driver that fit make a backend") {
  const LoadedBackend loaded = load_backend({good_driver, host_module}, 0);
  REQUIRE(loaded.backend);
  CHECK(loaded.backend->works());
  CHECK(std::string(loaded.backend->reason()) == "the GPU is used: a device played by the host");
}

TEST_CASE("what is missing is named") {
  check_refused({good_driver, "/nowhere/libfocal_cuda.so"}, "there is no GPU module");
  check_refused({good_driver, ""}, "there is no GPU module");
  check_refused({"libcuda_that_is_missing.so.1", host_module},
                "there is no NVIDIA driver (libcuda_that_is_missing");
  check_refused({host_module, host_module}, "lacks functions");
  check_refused({old_driver, host_module}, "too old: it knows CUDA 11.8, needed is 12.0");
  check_refused({bare_driver, host_module}, "there is no CUDA device");
  check_refused({good_driver, host_module}, "there is no CUDA device 3, only 1", 3);
  check_refused({broken_driver, host_module}, "does not start (error 999)");
  check_refused({good_driver, good_driver}, "another version of focal");
  check_refused({good_driver, stale_module}, "another version of focal");
  const TemporaryFolder folder;
  const std::string no_library = focal::text_of(folder.path / "module.bin");
  focal::write_file_atomically(folder.path / "module.bin", {});
  check_refused({good_driver, no_library}, "cannot be loaded");
}

TEST_CASE("a device that cannot be opened") {
  module_faults().opening = true;
  check_refused({good_driver, host_module}, "told to stay shut");
  module_faults().opening = false;
}

TEST_CASE("only a lasting failure ends a backend, and its reason stays the first") {
  const auto backend = host_backend();
  ComputeFailure failure{0, "out of device memory"};
  backend->record(BackendFailure(failure));
  CHECK(backend->works());
  failure = {1, "an illegal address"};
  const std::string before = backend->reason();
  const char* text = backend->reason();
  backend->record(BackendFailure(failure));
  CHECK_FALSE(backend->works());
  CHECK(backend->reason() == std::string("the GPU failed for good (an illegal address), so the CPU is used"));
  failure = {1, "another"};
  backend->record(BackendFailure(failure));
  CHECK(std::string(backend->reason()).find("illegal") != std::string::npos);
  CHECK(text == before);  // what was handed out before is still there
}

TEST_CASE("the module is looked for beside the library") {
  CHECK(backend_files().module.ends_with("/" + library_file_name("focal_cuda")));
  CHECK(backend_files().driver == nvidia_driver_file);
}
