// What the line-based landmark formats share: lines, cells and numbers, the same in every locale.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "landmark_files.h"

namespace focal_cli {

std::string_view trimmed(std::string_view text);
std::vector<std::string_view> lines_of(
    std::string_view text);  // without empty ones, line ends and byte-order mark
std::vector<std::string> split_csv_line(std::string_view line, char separator = ',');  // RFC 4180 quotes
std::string csv_cell(std::string_view text);  // quoted where it must be

double number_of(std::string_view text);  // throws CommandError unless all of it is one finite number
std::string text_of(double number);       // as few digits as bring the same number back
std::string text_of(float number);
double tidy(float number);  // the double with the float's shortest digits: 0.1, not 0.10000000149

// The position, or a CommandError that the target format needs one.
const Position& position_of(const Landmark& mark);

}  // namespace focal_cli
