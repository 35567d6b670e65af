// Aligned tables for people.
#pragma once
#include <ostream>
#include <string>
#include <vector>

namespace focal_cli {

// The first row is the head. The first column is set to the left, the others to the right.
void print_table(std::ostream& out, const std::vector<std::vector<std::string>>& rows);

// Name and value lines, the values to the left under each other.
void print_facts(std::ostream& out, const std::vector<std::pair<std::string, std::string>>& facts);

std::string fixed_text(double number, int decimals);  // "-" where it is not defined
std::string percent_text(double share, int decimals = 1);
std::string bytes_text(double bytes);

}  // namespace focal_cli
