// focal_detection: landmarks found on one mesh.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "handles.h"
#include "landmarks/detect.h"
#include "mesh.h"
#include "model.h"

namespace focal {

struct DetectionObject {
  using Handle = focal_detection;
  static constexpr HandleType type = HandleType::detection;

  std::shared_ptr<const ModelObject> model;
  std::shared_ptr<const MeshObject> mesh;
  Detection detection;
  std::vector<std::string> warnings;  // the mesh's, then the detection's own
};

}  // namespace focal
