// A figure brought into its panel: few triangles, turned towards the viewer, in units of the drawing.
#pragma once
#include <vector>

#include "drawing.h"

namespace picture {

struct Patch {
  std::array<Point, 3> corners;  // x right, y down, z towards the viewer
  double shade;                  // 0 dark .. 1 bright
};

struct Panel {
  std::vector<Patch> patches;  // those that face the viewer
  std::vector<Point> marks;    // in the figure's order
};

// The turn that shows the most marks, among those from which the figure still looks at the viewer.
double best_yaw(const Figure& figure);

Panel fit_into_panel(const Figure& figure, double width, double height);

// Whether a patch lies clearly nearer to the viewer than the mark.
bool is_hidden(const Panel& panel, size_t mark);

}  // namespace picture
