#include "base/library_folder.h"

#include <dlfcn.h>

namespace focal {

std::string library_folder() {
  Dl_info here{};
  if (!dladdr(reinterpret_cast<const void*>(&library_folder), &here) || !here.dli_fname) return {};
  const std::string file = here.dli_fname;
  const size_t end = file.rfind('/');
  return end == std::string::npos ? "." : file.substr(0, end);
}

}  // namespace focal
