// Curves with axes, as SVG text.
#pragma once
#include <array>
#include <string>
#include <vector>

namespace paper {

struct Curve {
  std::string name;
  std::string paint;  // a colour of CSS
  std::vector<std::array<double, 2>> points;
  bool dots = false;  // drawn as points, not as a line
};

// y runs from 0, or from the lowest value when that is negative.
std::string chart(const std::string& title, const std::string& x, const std::string& y,
                  const std::vector<Curve>& curves);

}  // namespace paper
