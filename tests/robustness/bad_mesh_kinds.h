// Meshes with every defect that files are known to have, made from a number.
#pragma once
#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace focal_bad_meshes {

struct BadMesh {
  std::vector<float> positions;   // three a vertex
  std::vector<uint32_t> indices;  // three a triangle; some may name no vertex

  uint32_t vertex_count() const { return static_cast<uint32_t>(positions.size() / 3); }
  uint32_t triangle_count() const { return static_cast<uint32_t>(indices.size() / 3); }
  uint32_t add_vertex(float x, float y, float z) {
    positions.insert(positions.end(), {x, y, z});
    return vertex_count() - 1;
  }
  void add_triangle(uint32_t a, uint32_t b, uint32_t c) { indices.insert(indices.end(), {a, b, c}); }
};

class Chance {
 public:
  explicit Chance(uint64_t seed) : engine_(seed) {}
  uint32_t below(uint32_t count) { return static_cast<uint32_t>(engine_() % count); }
  uint32_t between(uint32_t low, uint32_t high) { return low + below(high - low + 1); }
  float uniform(float low = 0, float high = 1) {
    return low + (high - low) * static_cast<float>(engine_() >> 40) / 16777216.0f;
  }

 private:
  std::mt19937_64 engine_;
};

// The kinds of defects, and a mesh of one of them; the same for the same seed.
const std::vector<std::string>& kinds();
BadMesh make(size_t kind, uint64_t seed);

}  // namespace focal_bad_meshes
