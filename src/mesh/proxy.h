// A stand-in of a few thousand vertices for a surface of any size. Everything is analysed on it, so that the cost hardly
// grows with the size of the mesh, and two triangulations of one shape look more alike on it.
#pragma once
#include <memory>
#include <vector>

#include "base/parallel.h"
#include "mesh/prepare.h"

namespace focal {

struct Proxy {
  std::shared_ptr<const PreparedMesh> full;
  std::shared_ptr<const PreparedMesh>
      coarse;  // its source lies in full's surface coordinates; or full itself

  int32_t filled_holes = 0;  // holes of the full surface that are closed on the coarse one

  bool is_full() const { return coarse == full; }
  // Caller's units per unit of the coarse surface.
  double scale() const { return is_full() ? full->scale : full->scale * coarse->scale; }
};

// vertices: of the proxy, about; 0, or no fewer than the surface has: the surface itself.
// may_mend: the surface is wrapped where mesh->is_wrapped; else its holes are closed first (see fill_holes). Points of a patch or a
// bridge go over to the nearest of the full surface, so nothing is ever found in a hole; a surface without holes is treated as if they
// stayed.
Proxy make_proxy(std::shared_ptr<const PreparedMesh> mesh, int32_t vertices, const Execution& execution = {},
                 bool may_mend = false);

// Nearest points on the other surface, on the side that faces the same way. On full->surface and coarse->surface.
std::vector<SurfacePoint> to_coarse(const Proxy& proxy, std::span<const SurfacePoint> full_points);
std::vector<SurfacePoint> to_full(const Proxy& proxy, std::span<const SurfacePoint> coarse_points,
                                  const Execution& execution = {});

// For every vertex of the full surface its place on the coarse one: carries vote maps over.
std::vector<SurfacePoint> coarse_place_of_vertices(const Proxy& proxy, const Execution& execution);

}  // namespace focal
