#define PSAPI_VERSION 2  // K32GetProcessMemoryInfo, in KERNEL32
#include <windows.h>

#include "base/system.h"
// after windows.h
#include <psapi.h>

#include <memory>

#include "base/text_windows.h"

namespace focal {

uint64_t peak_memory_bytes() {
  PROCESS_MEMORY_COUNTERS counters{};
  if (!::GetProcessMemoryInfo(::GetCurrentProcess(), &counters, sizeof counters)) return 0;
  return counters.PeakWorkingSetSize;
}

std::string environment_variable(const char* name) {
  const std::wstring wide = wide_text(name);
  std::wstring value(::GetEnvironmentVariableW(wide.c_str(), nullptr, 0), L'\0');
  if (value.empty()) return {};
  value.resize(::GetEnvironmentVariableW(wide.c_str(), value.data(), static_cast<DWORD>(value.size())));
  return utf8_text(value);
}

const char list_separator = ';';

bool is_regular_file(const std::string& path) {
  const DWORD attributes = ::GetFileAttributesW(any_length(wide_text(path)).c_str());
  return attributes != INVALID_FILE_ATTRIBUTES &&
         !(attributes & (FILE_ATTRIBUTE_DIRECTORY | FILE_ATTRIBUTE_DEVICE));
}

std::vector<std::string> regular_files_in(const std::string& folder) {
  std::vector<std::string> names;
  WIN32_FIND_DATAW entry;
  const HANDLE listing = ::FindFirstFileW(any_length(wide_text(folder + "\\*")).c_str(), &entry);
  if (listing == INVALID_HANDLE_VALUE) return names;
  const std::unique_ptr<void, BOOL (*)(HANDLE)> closer(listing,
                                                       [](HANDLE open) { return ::FindClose(open); });
  do
    if (!(entry.dwFileAttributes & (FILE_ATTRIBUTE_DIRECTORY | FILE_ATTRIBUTE_DEVICE)))
      names.push_back(utf8_text(entry.cFileName));
  while (::FindNextFileW(listing, &entry));
  return names;
}

}  // namespace focal
