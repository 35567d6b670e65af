#include "base/system.h"

#include <dirent.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <cstdlib>
#include <memory>

namespace focal {

uint64_t peak_memory_bytes() {
  rusage usage{};
  if (getrusage(RUSAGE_SELF, &usage) != 0) return 0;
#if defined(__APPLE__)
  return static_cast<uint64_t>(usage.ru_maxrss);
#else
  return static_cast<uint64_t>(usage.ru_maxrss) * 1024;
#endif
}

std::string environment_variable(const char* name) {
  const char* const value = std::getenv(name);
  return value ? value : "";
}

const char list_separator = ':';

bool is_regular_file(const std::string& path) {
  struct stat found;
  return ::stat(path.c_str(), &found) == 0 && S_ISREG(found.st_mode);
}

std::vector<std::string> regular_files_in(const std::string& folder) {
  std::vector<std::string> names;
  const std::unique_ptr<DIR, int (*)(DIR*)> listing(::opendir(folder.c_str()), ::closedir);
  if (!listing) return names;
  while (const dirent* entry = ::readdir(listing.get()))
    if (is_regular_file(folder + "/" + entry->d_name)) names.emplace_back(entry->d_name);
  return names;
}

}  // namespace focal
