// What a verb throws when its work fails: main prints message and hint on stderr and exits with 1.
#pragma once
#include <stdexcept>
#include <string>

namespace focal_cli {

struct CommandError : std::runtime_error {
  CommandError(const std::string& message, std::string hint_text)
      : std::runtime_error(message), hint(std::move(hint_text)) {}
  std::string hint;  // what to do about it; may be empty when the message says it already
};

}  // namespace focal_cli
