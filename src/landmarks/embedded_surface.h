// A surface embedded in many dimensions, for example by a functional map, with nearest-point queries.
#pragma once
#include <functional>
#include <vector>

#include "mesh/triangle_mesh.h"

namespace focal {

// For each vertex the triangles that use it.
std::vector<std::vector<int32_t>> incident_triangles(const TriangleMesh& mesh);

class EmbeddedSurface {
 public:
  // place(v): coordinates of vertex v. Both arguments are kept by reference.
  EmbeddedSurface(const TriangleMesh& mesh, std::function<Eigen::VectorXf(int32_t)> place)
      : mesh_(mesh), place_(std::move(place)) {}

  struct Nearest {
    SurfacePoint point;
    float squared;  // distance
  };
  Nearest nearest(int32_t triangle, const Eigen::VectorXf& place) const;
  // Nearest point on the given triangles, at least one.
  SurfacePoint nearest(const std::vector<int32_t>& triangles, const Eigen::VectorXf& place) const;

 private:
  const TriangleMesh& mesh_;
  std::function<Eigen::VectorXf(int32_t)> place_;
};

}  // namespace focal
