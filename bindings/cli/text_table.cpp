// Aligned tables for people.
#include "text_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace focal_cli {
namespace {

// Characters, not bytes: names may be in any script.
size_t width_of(const std::string& text) {
  return static_cast<size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

std::string padding(const std::string& text, size_t width) {
  return std::string(width - std::min(width, width_of(text)), ' ');
}

}  // namespace

void print_table(std::ostream& out, const std::vector<std::vector<std::string>>& rows) {
  std::vector<size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], width_of(row[i]));
  }
  size_t total = 0;
  for (const size_t width : widths) total += width + 2;
  for (const auto& row : rows) {
    std::string line;
    for (size_t i = 0; i < row.size(); ++i) {
      const std::string space = padding(row[i], widths[i]);
      line += i == 0 ? row[i] + space : "  " + space + row[i];
    }
    line.erase(line.find_last_not_of(' ') + 1);
    out << line << "\n";
    if (&row == &rows.front()) out << std::string(total - 2, '-') << "\n";
  }
}

void print_facts(std::ostream& out, const std::vector<std::pair<std::string, std::string>>& facts) {
  size_t width = 0;
  for (const auto& [name, value] : facts) width = std::max(width, width_of(name));
  for (const auto& [name, value] : facts) out << name << padding(name, width + 2) << value << "\n";
}

std::string fixed_text(double number, int decimals) {
  if (std::isnan(number)) return "-";
  char digits[512];
  const auto end =
      std::to_chars(digits, digits + sizeof digits, number, std::chars_format::fixed, decimals).ptr;
  return std::string(digits, end);
}

std::string percent_text(double share, int decimals) {
  return std::isnan(share) ? "-" : fixed_text(100 * share, decimals) + " %";
}

std::string bytes_text(double bytes) {
  const char* units[] = {"B", "KB", "MB", "GB"};
  size_t unit = 0;
  for (; bytes >= 1000 && unit < 3; ++unit) bytes /= 1000;
  return fixed_text(bytes, unit == 0 ? 0 : 1) + " " + units[unit];
}

}  // namespace focal_cli
