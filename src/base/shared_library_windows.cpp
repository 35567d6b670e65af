#include <windows.h>

#include "base/shared_library.h"
#include "base/text_windows.h"

namespace focal {

std::string library_file_name(const std::string& name) { return name + ".dll"; }

const char* const nvidia_driver_file = "nvcuda.dll";

void* open_library(const std::string& path, std::string& why) {
  // Never from the current folder, nor the PATH: whoever can write there could run code in the host.
  const bool is_path = path.find_first_of("\\/") != std::string::npos;
  const DWORD where = is_path ? LOAD_LIBRARY_SEARCH_DLL_LOAD_DIR | LOAD_LIBRARY_SEARCH_DEFAULT_DIRS
                              : LOAD_LIBRARY_SEARCH_SYSTEM32;
  std::wstring file = wide_text(path);
  if (is_path) file = full_path(file);  // only such a one is not searched for
  void* const library = ::LoadLibraryExW(file.c_str(), nullptr, where);
  if (!library) why = path + ": " + system_message(::GetLastError());
  return library;
}

void* find_symbol(void* library, const char* name) {
  return reinterpret_cast<void*>(::GetProcAddress(static_cast<HMODULE>(library), name));
}

}  // namespace focal
