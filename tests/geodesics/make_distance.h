// A distance of a mesh by its name.
#pragma once
#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string_view>

#include "geodesics/distance.h"

namespace focal_test {

inline std::shared_ptr<const focal::Distance> distance_named(
    std::string_view name, const focal::TriangleMesh& mesh,
    std::span<const std::pair<int32_t, int32_t>> bridges = {}) {
  for (const focal::DistanceKind& kind : focal::distance_kinds())
    if (kind.name == name) return kind.make({mesh, bridges, focal::make_operators(mesh, bridges), false}, {});
  throw std::runtime_error("no such distance");
}

}  // namespace focal_test
