// Marked shapes to learn from and to spoil: faust5k where the evaluation sets are at hand, else sample humanoids.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mesh/triangle_mesh.h"
#include "model/training_set.h"

namespace focal_robustness {

struct Shape {
  std::string name;
  focal::TriangleMesh mesh;
  std::vector<std::optional<focal::SurfacePoint>> marks;  // on mesh
  std::vector<int32_t> dense;  // vertices that are the same points of the body on every shape; may be empty
};

struct Shapes {
  std::string set;
  std::vector<std::string> landmark_names;
  std::vector<Shape> training, judged;
  int32_t landmark(const std::string& name) const;  // -1: there is none of that name
};

enum class Split {
  test,       // learn from the train split, judge on the test split
  validation  // learn from the train split, judge on other meshes of its people (`extra`): to choose by
};

// limit: judge at most so many meshes, spread over the split.
Shapes load_shapes(Split split, int32_t limit);

focal::MarkedShape prepared(const Shape& shape);
// As a caller of the C ABI gives it.
focal::TriangleMesh in_single_precision(focal::TriangleMesh mesh);

}  // namespace focal_robustness
