#include "structs.h"

#include <charconv>
#include <iterator>

namespace focal {
namespace {

// std::to_string and streams would ask the locale.
std::string text_of(double value) {
  char text[32];
  return {text, std::to_chars(text, std::end(text), value).ptr};
}

}  // namespace

void check_range(const char* name, double value, double low, double high) {
  if (value >= low && value <= high) return;
  throw Error(Status::invalid_argument, std::string(name) + " is " + text_of(value),
              "choose a value from " + text_of(low) + " to " + text_of(high));
}

void check_flag(const char* name, int32_t value) { check_range(name, value, 0, 1); }

void check_reserved(const char* name, int64_t value) {
  if (value != 0)
    throw Error(Status::unsupported, std::string(name) + " sets a reserved field",
                "fill the struct with its *_init and leave reserved fields 0");
}

}  // namespace focal
