// Meshes made worse on purpose: noise, holes, other sizes, other resolutions, missing parts.
#pragma once
#include <array>
#include <cstdint>
#include <focal/focal.hpp>
#include <vector>

namespace paper {

struct Shape {
  std::vector<float> positions;   // x, y, z of each vertex
  std::vector<uint32_t> indices;  // three a triangle
};

Shape shape_of(const focal::Mesh& mesh);
focal::Mesh mesh_of(const focal::Context& context, const Shape& shape);

Shape with_noise(Shape shape, double length, uint32_t seed);  // normally distributed in every coordinate
Shape with_holes(Shape shape, size_t holes, uint32_t seed);   // each the triangles around one vertex
Shape scaled(Shape shape, const std::array<double, 3>& factors);
// About so many vertices: triangles are cut into four until there are as many, and decimated when there are more.
Shape resampled(const Shape& shape, size_t vertices);
// The triangles whose corners all lie farther away; vertices keep their numbers.
Shape cut_off(Shape shape, const std::vector<float>& distances, double radius);
double mean_edge(const Shape& shape);

}  // namespace paper
