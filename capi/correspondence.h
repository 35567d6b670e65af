// focal_correspondence: a point of one detected mesh for every vertex of another.
#pragma once
#include <memory>

#include "correspondence/dense_map.h"
#include "detection.h"
#include "handles.h"

namespace focal {

struct CorrespondenceObject {
  using Handle = focal_correspondence;
  static constexpr HandleType type = HandleType::correspondence;

  std::shared_ptr<const MeshObject> from, to;
  DenseMap map;
};

}  // namespace focal
