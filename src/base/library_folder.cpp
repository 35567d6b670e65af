#include "base/library_folder.h"

#include <dlfcn.h>

namespace focal {

std::filesystem::path library_folder() {
  Dl_info here{};
  if (!dladdr(reinterpret_cast<const void*>(&library_folder), &here) || !here.dli_fname) return {};
  std::error_code error;
  const std::filesystem::path file = std::filesystem::absolute(here.dli_fname, error);
  return error ? std::filesystem::path{} : file.parent_path();
}

}  // namespace focal
