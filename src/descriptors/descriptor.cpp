#include "descriptors/descriptor.h"

#include <array>

namespace focal {

#define FOCAL_DECLARE(name) DescriptorKind name##_descriptor();
#define FOCAL_MAKE(name) name##_descriptor(),
FOCAL_DESCRIPTORS(FOCAL_DECLARE)

std::span<const DescriptorKind> descriptor_kinds() {
  static const std::array all = {FOCAL_DESCRIPTORS(FOCAL_MAKE)};
  return all;
}

}  // namespace focal
