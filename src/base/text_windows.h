// Text and errors of Windows: UTF-16 there, UTF-8 here.
#pragma once
#include <string>
#include <string_view>

namespace focal {

// Throws invalid_argument if the text is not UTF-8.
std::wstring wide_text(std::string_view utf8);
// Unpaired surrogates become U+FFFD.
std::string utf8_text(std::wstring_view wide);

// What Windows says about an error code, in UTF-8.
std::string system_message(unsigned long error);

// Absolute, with backslashes and without "."; empty on failure.
std::wstring full_path(const std::wstring& path);
// The path as system calls accept it at any length: a long one becomes absolute and starts with \\?\, which lifts the limit of 260
// characters without a setting of the user's.
std::wstring any_length(const std::wstring& path);
// Without that start.
std::wstring shown_path(std::wstring path);

}  // namespace focal
