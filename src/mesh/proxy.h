// A simplified copy of a few thousand vertices of a surface of any size. All analysis uses it, so that the
// cost hardly grows with the size of the mesh, and different triangulations of one shape become more similar.
#pragma once
#include <memory>
#include <vector>

#include "base/parallel.h"
#include "mesh/prepare.h"

namespace focal {

struct Proxy {
  std::shared_ptr<const PreparedMesh> full;
  // Its source is in full's surface coordinates; or full itself.
  std::shared_ptr<const PreparedMesh> coarse;

  int32_t filled_holes = 0;  // holes of the full surface that are closed on the coarse one

  bool is_full() const { return coarse == full; }
  // Caller's units per unit of the coarse surface.
  double scale() const { return is_full() ? full->scale : full->scale * coarse->scale; }
};

// vertices: approximate number of the proxy's vertices; 0, or at least the surface's number: the surface
// itself. may_mend: wrap the surface where mesh->is_wrapped, otherwise close its holes first (see
// fill_holes). Points of a patch or a bridge are moved to the nearest of the full surface, so no result is
// inside a hole; a surface without holes is not affected.
Proxy make_proxy(std::shared_ptr<const PreparedMesh> mesh, int32_t vertices, const Execution& execution = {},
                 bool may_mend = false);

// Nearest points on the other surface, on the side with a similar normal. On full->surface and
// coarse->surface.
std::vector<SurfacePoint> to_coarse(const Proxy& proxy, std::span<const SurfacePoint> full_points);
std::vector<SurfacePoint> to_full(const Proxy& proxy, std::span<const SurfacePoint> coarse_points,
                                  const Execution& execution = {});

// For every vertex of the full surface its position on the coarse one, to transfer vote maps.
std::vector<SurfacePoint> coarse_place_of_vertices(const Proxy& proxy, const Execution& execution);

}  // namespace focal
