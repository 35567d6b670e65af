// Marked shapes: what training starts from.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mesh/prepare.h"

namespace focal {

struct MarkedShape {
  std::shared_ptr<const PreparedMesh> mesh;
  std::vector<std::optional<SurfacePoint>>
      marks;  // on mesh->surface; one a landmark name; empty: absent here
};

struct TrainingSet {
  std::vector<std::string> landmark_names;
  std::vector<MarkedShape> shapes;
};

}  // namespace focal
