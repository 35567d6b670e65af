// Shared libraries that are opened while the program runs.
#pragma once
#include <string>

namespace focal {

// The file name of a library of ours: "libNAME.so" on Linux.
std::string library_file_name(const std::string& name);
// The library of NVIDIA's driver, as open_library takes it.
extern const char* const nvidia_driver_file;

// A path, or the name of a library of the system. It stays in the process: a driver does not like to be unloaded. Returns null and
// sets `why` on failure.
void* open_library(const std::string& path, std::string& why);
void* find_symbol(void* library, const char* name);  // null: it has no such symbol

}  // namespace focal
