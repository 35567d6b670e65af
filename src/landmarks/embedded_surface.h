// A surface whose vertices lie at places of many dimensions, such as a functional map gives them: the point of it nearest to one.
#pragma once
#include <functional>
#include <vector>

#include "mesh/triangle_mesh.h"

namespace focal {

// The triangles that use each vertex.
std::vector<std::vector<int32_t>> incident_triangles(const TriangleMesh& mesh);

class EmbeddedSurface {
 public:
  // place(v): of vertex v. Both are kept by reference.
  EmbeddedSurface(const TriangleMesh& mesh, std::function<Eigen::VectorXf(int32_t)> place)
      : mesh_(mesh), place_(std::move(place)) {}

  struct Nearest {
    SurfacePoint point;
    float squared;  // distance
  };
  Nearest nearest(int32_t triangle, const Eigen::VectorXf& place) const;
  // Among the given triangles, at least one.
  SurfacePoint nearest(const std::vector<int32_t>& triangles, const Eigen::VectorXf& place) const;

 private:
  const TriangleMesh& mesh_;
  std::function<Eigen::VectorXf(int32_t)> place_;
};

}  // namespace focal
