// focal_blob: a block of bytes the caller reads.
#pragma once
#include <cstddef>
#include <vector>

#include "handles.h"

namespace focal {

struct BlobObject {
  using Handle = focal_blob;
  static constexpr HandleType type = HandleType::blob;

  std::vector<std::byte> bytes;
};

}  // namespace focal
