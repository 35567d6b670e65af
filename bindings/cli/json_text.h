// JSON out of files that people edit and other programs write.
#pragma once
#include <nlohmann/json.hpp>
#include <string_view>

#include "command_error.h"

namespace focal_cli {

// Deep nesting is refused: the library copies and prints values by recursion, which would end on the stack's last page.
template <class Json>
Json parse_json(std::string_view text) {
  constexpr int deepest = 64;
  return Json::parse(text, [](int depth, typename Json::parse_event_t, Json&) {
    if (depth > deepest) throw CommandError("the JSON is nested too deeply", "no landmark file needs that");
    return true;
  });
}

}  // namespace focal_cli
