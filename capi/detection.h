// focal_detection: landmarks found on one mesh.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "base/lazy.h"
#include "handles.h"
#include "landmarks/detect.h"
#include "landmarks/regions.h"
#include "mesh.h"
#include "model.h"
#include "output_file.h"

namespace focal {

struct DetectionObject {
  using Handle = focal_detection;
  static constexpr HandleType type = HandleType::detection;

  std::shared_ptr<const ModelObject> model;
  std::shared_ptr<const MeshObject> mesh;
  Detection detection;
  std::vector<std::string> warnings;  // the mesh's, then the detection's own

  // Landmarks x vertices of the mesh's surface, carried over from the proxy when first asked for. Any thread.
  const RowMatrixf& full_votes() const;

  // Made when first asked for. Any thread.
  const DistanceFields& distance_fields(const Execution& execution) const;

 private:
  Lazy<RowMatrixf> votes_;
  Lazy<DistanceFields> distances_;
};

void put_landmarks(const DetectionObject& object, SourceFile& source);

}  // namespace focal
