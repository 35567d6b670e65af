// Shaded triangle meshes with landmark balls, side by side, as SVG text that stays small enough for a README.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace picture {

using Point = std::array<double, 3>;

struct Mark {
  std::string name;
  Point position;
  bool uncertain = false;  // drawn hollow
  bool inside = false;     // of the surface, through which it shows in full
};

struct Figure {
  std::vector<Point> positions;
  std::vector<std::array<uint32_t, 3>> triangles;  // counter-clockwise from outside
  std::vector<Mark> marks;
  std::vector<std::array<size_t, 2>> bones = {};  // pairs of marks, joined by lines
  std::string caption;
  double yaw = 0;    // degrees the figure is turned about +Y; at 0 it looks at the viewer along +Z
  double pitch = 8;  // degrees the viewer looks down on it
  size_t triangles_drawn = 4400;  // about 65 KB of SVG
};

// Marks of the same name get the same colour in every figure. columns: figures in a row; 0: all of them.
std::string draw(const std::vector<Figure>& figures, size_t columns = 0);

}  // namespace picture
