#include "base/shared_library.h"

#include <dlfcn.h>

namespace focal {

std::string library_file_name(const std::string& name) { return "lib" + name + ".so"; }

const char* const nvidia_driver_file = "libcuda.so.1";

void* open_library(const std::string& path, std::string& why) {
  void* library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
  if (!library) {
    const char* error = dlerror();
    why = error ? error : "it cannot be opened";
    dlerror();  // gives the text back
  }
  return library;
}

void* find_symbol(void* library, const char* name) { return dlsym(library, name); }

}  // namespace focal
