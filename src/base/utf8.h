// Text in UTF-8.
#pragma once
#include <string_view>

namespace focal {

// Whether it is well-formed: no overlong forms, no surrogates, at most U+10FFFF.
bool is_utf8(std::string_view text);

}  // namespace focal
