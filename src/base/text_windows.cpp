#include "base/text_windows.h"

#include <windows.h>

#include <limits>

#include "base/error.h"

namespace focal {
namespace {

constexpr size_t longest_plain_path = 240;  // MAX_PATH less a name as long as our temporary files'
constexpr std::wstring_view long_start = L"\\\\?\\", long_share_start = L"\\\\?\\UNC\\";

int checked_size(size_t size) {
  if (size > static_cast<size_t>(std::numeric_limits<int>::max()))
    throw Error(Status::invalid_argument, "the text is too long", "pass a shorter one");
  return static_cast<int>(size);
}

}  // namespace

std::wstring wide_text(std::string_view utf8) {
  if (utf8.empty()) return {};
  const int size = checked_size(utf8.size());
  const int length = ::MultiByteToWideChar(CP_UTF8, MB_ERR_INVALID_CHARS, utf8.data(), size, nullptr, 0);
  if (length <= 0)
    throw Error(Status::invalid_argument, "the text is not UTF-8", "pass paths and names in UTF-8");
  std::wstring wide(static_cast<size_t>(length), L'\0');
  ::MultiByteToWideChar(CP_UTF8, MB_ERR_INVALID_CHARS, utf8.data(), size, wide.data(), length);
  return wide;
}

std::string utf8_text(std::wstring_view wide) {
  if (wide.empty()) return {};
  const int size = checked_size(wide.size());
  const int length = ::WideCharToMultiByte(CP_UTF8, 0, wide.data(), size, nullptr, 0, nullptr, nullptr);
  std::string utf8(static_cast<size_t>(length), '\0');
  ::WideCharToMultiByte(CP_UTF8, 0, wide.data(), size, utf8.data(), length, nullptr, nullptr);
  return utf8;
}

std::string system_message(unsigned long error) {
  wchar_t text[512];
  constexpr DWORD flags = FORMAT_MESSAGE_FROM_SYSTEM | FORMAT_MESSAGE_IGNORE_INSERTS;
  DWORD length = 0;
  // English like focal's own messages, or the user's language where English is not installed.
  for (const DWORD language : {DWORD{MAKELANGID(LANG_ENGLISH, SUBLANG_ENGLISH_US)}, DWORD{0}})
    if (length == 0) length = ::FormatMessageW(flags, nullptr, error, language, text, 512, nullptr);
  while (length > 0 && (text[length - 1] <= L' ' || text[length - 1] == L'.')) --length;
  return length > 0 ? utf8_text({text, length}) : "Windows error " + std::to_string(error);
}

std::wstring full_path(const std::wstring& path) {
  const DWORD size = ::GetFullPathNameW(path.c_str(), 0, nullptr, nullptr);
  if (size == 0) return {};
  std::wstring full(size, L'\0');
  const DWORD length = ::GetFullPathNameW(path.c_str(), size, full.data(), nullptr);
  full.resize(length < size ? length : 0);
  return full;
}

std::wstring any_length(const std::wstring& path) {
  const auto is_separator = [&](size_t i) { return path[i] == L'\\' || path[i] == L'/'; };
  if (path.size() < longest_plain_path || path.starts_with(long_start)) return path;
  const std::wstring full = full_path(path);
  if (full.empty()) return path;
  return is_separator(0) && is_separator(1) ? std::wstring(long_share_start) + full.substr(2)
                                            : std::wstring(long_start) + full;
}

std::wstring shown_path(std::wstring path) {
  if (path.starts_with(long_share_start)) return L"\\\\" + path.substr(long_share_start.size());
  if (path.starts_with(long_start)) path.erase(0, long_start.size());
  return path;
}

}  // namespace focal
