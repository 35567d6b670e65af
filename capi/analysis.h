// focal_analysis: what is computed of a mesh before any model is asked.
#pragma once
#include <memory>

#include "analysis/surface_analysis.h"
#include "handles.h"
#include "mesh.h"

namespace focal {

struct AnalysisObject {
  using Handle = focal_analysis;
  static constexpr HandleType type = HandleType::analysis;

  std::shared_ptr<const MeshObject> mesh;
  SurfaceAnalysis analysis;
};

}  // namespace focal
