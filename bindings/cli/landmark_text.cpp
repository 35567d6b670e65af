// What the line-based landmark formats share: lines, cells and numbers, the same in every locale.
#include "landmark_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "command_error.h"

namespace focal_cli {
namespace {

template <typename Number>
std::string shortest_text(Number number) {
  char digits[64];
  const auto end = std::to_chars(digits, digits + sizeof digits, number).ptr;
  return std::string(digits, end);
}

}  // namespace

std::string_view trimmed(std::string_view text) {
  const size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::vector<std::string_view> lines_of(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const size_t end = std::min(text.find('\n'), text.size());
    const auto line = text.substr(0, end);
    if (!trimmed(line).empty()) lines.push_back(line.substr(0, line.find_last_not_of(" \r") + 1));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

std::vector<std::string> split_csv_line(std::string_view line, char separator) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (c == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"') {
      cells.back() += line[++i];
    } else if (c == '"') {
      quoted = !quoted;
    } else if (c == separator && !quoted) {
      cells.emplace_back();
    } else {
      cells.back() += c;
    }
  }
  return cells;
}

std::string csv_cell(std::string_view text) {
  if (text.find_first_of(",\"\n\r") == std::string_view::npos) return std::string(text);
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

double number_of(std::string_view text) {
  text = trimmed(text);
  double number = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (code != std::errc() || end != text.data() + text.size() || !std::isfinite(number)) {
    throw CommandError("'" + std::string(text) + "' is not a number", "write numbers with a decimal point");
  }
  return number;
}

std::string text_of(double number) { return shortest_text(number); }
std::string text_of(float number) { return shortest_text(number); }

double tidy(float number) { return std::isfinite(number) ? number_of(shortest_text(number)) : number; }

const Position& position_of(const Landmark& mark) {
  if (mark.position) return *mark.position;
  throw CommandError("landmark '" + mark.name + "' has no position, and the target format holds nothing else",
                     "use a file whose landmarks have positions");
}

}  // namespace focal_cli
