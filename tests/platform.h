// What the tests do in a way of its own on each platform.
#pragma once
#include <cstdlib>
#include <filesystem>
#include <string>
#ifndef _WIN32
#include <sys/stat.h>
#endif

namespace focal_test {

inline void set_variable(const char* name, const std::string& value) {  // empty: not set any more
#ifdef _WIN32
  _putenv_s(name, value.c_str());
#else
  value.empty() ? unsetenv(name) : setenv(name, value.c_str(), 1);
#endif
}

// Something in a folder that is no file and would block whoever opens it: a pipe; on Windows, which has none in folders, a folder.
inline bool make_pipe(const std::filesystem::path& path) {
#ifdef _WIN32
  return std::filesystem::create_directory(path);
#else
  return ::mkfifo(path.c_str(), 0600) == 0;
#endif
}

}  // namespace focal_test
