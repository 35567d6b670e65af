// From the lattice's triangles to well-shaped ones of the wanted sizes, on the same surface.
#pragma once
#include "body.h"
#include "geometry.h"
#include "random.h"

namespace creatures {

// About `vertex_count` vertices, denser where the body asks for detail and irregular by chance elsewhere.
// Stays closed and manifold. Takes a mesh finer than its result.
Mesh remesh(const Mesh& mesh, const Body& body, int vertex_count, Random& random);

}  // namespace creatures
