#include <windows.h>

#include "base/library_folder.h"
#include "base/text_windows.h"

namespace focal {

std::string library_folder() {
  HMODULE here = nullptr;
  constexpr DWORD flags =
      GET_MODULE_HANDLE_EX_FLAG_FROM_ADDRESS | GET_MODULE_HANDLE_EX_FLAG_UNCHANGED_REFCOUNT;
  if (!::GetModuleHandleExW(flags, reinterpret_cast<const wchar_t*>(&library_folder), &here)) return {};
  constexpr size_t longest_path = 32768;
  for (std::wstring file(256, L'\0'); file.size() <= longest_path; file.resize(2 * file.size())) {
    const DWORD length = ::GetModuleFileNameW(here, file.data(), static_cast<DWORD>(file.size()));
    if (length == 0) return {};
    if (length == file.size()) continue;  // it was cut off
    file.resize(length);
    const size_t end = file.find_last_of(L"\\/");
    return end == std::wstring::npos ? "." : utf8_text(shown_path(file.substr(0, end)));
  }
  return {};
}

}  // namespace focal
