#include "base/reserved_names.h"

#include <array>

namespace focal {
namespace {

constexpr std::wstring_view separators = L"\\/";

wchar_t upper(wchar_t c) { return c >= L'a' && c <= L'z' ? static_cast<wchar_t>(c - L'a' + L'A') : c; }

bool equals(std::wstring_view text, std::wstring_view upper_case) {
  if (text.size() != upper_case.size()) return false;
  for (size_t i = 0; i < text.size(); ++i)
    if (upper(text[i]) != upper_case[i]) return false;
  return true;
}

}  // namespace

bool is_device_name(std::wstring_view name) {
  name = name.substr(0, name.find_first_of(L".:"));
  while (name.ends_with(L' ')) name.remove_suffix(1);
  constexpr std::array<std::wstring_view, 6> devices{L"CON", L"PRN", L"AUX", L"NUL", L"CONIN$", L"CONOUT$"};
  for (const std::wstring_view device : devices)
    if (equals(name, device)) return true;
  if (name.size() != 4) return false;
  constexpr std::wstring_view digits = L"0123456789\u00b9\u00b2\u00b3";  // superscripts count as digits there
  const std::wstring_view start = name.substr(0, 3);
  return (equals(start, L"COM") || equals(start, L"LPT")) && digits.find(name[3]) != std::wstring_view::npos;
}

bool is_plain_relative_path(std::wstring_view path) {
  // A colon: a drive, which need not be the current one's root, or a stream of a file.
  if (path.empty() || path.find(L':') != std::wstring_view::npos) return false;
  if (separators.find(path.front()) != std::wstring_view::npos) return false;
  for (;;) {
    const size_t end = path.find_first_of(separators);
    const std::wstring_view part = path.substr(0, end);
    const bool is_last = end == std::wstring_view::npos;
    // Windows drops dots and spaces at the end of a name, so "..." and ".. " may lead up.
    const bool changes = part.ends_with(L'.') || part.ends_with(L' ');
    if ((changes && (part != L"." || is_last)) || is_device_name(part)) return false;
    if (is_last) return !part.empty();
    path.remove_prefix(end + 1);
  }
}

}  // namespace focal
