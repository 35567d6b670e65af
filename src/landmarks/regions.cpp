#include "landmarks/regions.h"

#include <algorithm>
#include <limits>

#include "operators/operators.h"

namespace focal {

DistanceFields::DistanceFields(Proxy proxy, const Execution& execution) : proxy_(std::move(proxy)) {
  const PreparedMesh& coarse = *proxy_.coarse;
  const auto bridges = bridges_of(coarse);
  heat_ =
      HeatMethod(coarse.surface, make_operators(coarse.surface, bridges, true), execution, false, bridges);
  places_ = coarse_place_of_vertices(proxy_, execution);
}

std::vector<float> DistanceFields::from(const SurfacePoint& source_point, const Execution& execution) const {
  const SurfacePoint start = to_surface(*proxy_.full, source_point);
  const auto coarse_start = to_coarse(proxy_, {&start, 1});
  const RowMatrixf field = heat_.distances(coarse_start, execution);
  const MatrixX3i& triangles = proxy_.coarse->surface.triangles;
  const auto& surface_vertex = proxy_.full->surface_vertex;
  std::vector<float> result(surface_vertex.size(), std::numeric_limits<float>::infinity());
  for (size_t v = 0; v < result.size(); ++v) {
    if (surface_vertex[v] < 0) continue;
    const SurfacePoint& place = places_[surface_vertex[v]];
    double distance = 0;
    for (int i = 0; i < 3; ++i) distance += place.barycentric[i] * field(0, triangles(place.triangle, i));
    result[v] = static_cast<float>(proxy_.scale() * distance);
  }
  return result;
}

std::vector<float> membership(const std::vector<float>& distances, double radius, double border) {
  std::vector<float> result;
  for (const float distance : distances)
    result.push_back(static_cast<float>(std::clamp((radius - distance) / border + 0.5, 0.0, 1.0)));
  return result;
}

}  // namespace focal
