// Meshes made worse on purpose. See damage.h.
#include "damage.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>

namespace paper {
namespace {

Shape decimated(const Shape& shape, double share) {
  Shape result;
  const size_t count = shape.positions.size() / 3;
  const auto target = 3 * static_cast<size_t>(share * static_cast<double>(shape.indices.size() / 3));
  std::vector<uint32_t> kept(shape.indices.size());
  kept.resize(meshopt_simplify(kept.data(), shape.indices.data(), kept.size(), shape.positions.data(), count,
                               3 * sizeof(float), target, 1.0f, 0, nullptr));
  std::vector<uint32_t> place(count, ~0u);
  for (const uint32_t corner : kept) {
    if (place[corner] == ~0u) {
      place[corner] = static_cast<uint32_t>(result.positions.size() / 3);
      const float* p = &shape.positions[3 * size_t{corner}];
      result.positions.insert(result.positions.end(), p, p + 3);
    }
    result.indices.push_back(place[corner]);
  }
  return result;
}

Shape refined(const Shape& shape) {
  Shape result{shape.positions, {}};
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
  const auto middle = [&](uint32_t a, uint32_t b) {
    const auto [known, is_new] =
        middles.try_emplace(std::minmax(a, b), static_cast<uint32_t>(result.positions.size() / 3));
    for (size_t k = 0; k < 3 && is_new; ++k) {
      result.positions.push_back((shape.positions[3 * size_t{a} + k] + shape.positions[3 * size_t{b} + k]) /
                                 2);
    }
    return known->second;
  };
  for (size_t i = 0; i < shape.indices.size(); i += 3) {
    const uint32_t a = shape.indices[i], b = shape.indices[i + 1], c = shape.indices[i + 2];
    const uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    const uint32_t four[] = {a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca};
    result.indices.insert(result.indices.end(), std::begin(four), std::end(four));
  }
  return result;
}

}  // namespace

Shape shape_of(const focal::Mesh& mesh) {
  const focal_mesh_info info = mesh.info();
  return {{mesh.positions(), mesh.positions() + 3 * info.vertex_count},
          {mesh.triangles(), mesh.triangles() + 3 * info.triangle_count}};
}

focal::Mesh mesh_of(const focal::Context& context, const Shape& shape) {
  auto desc = focal::init(focal_mesh_desc_init);
  desc.positions = shape.positions.data();
  desc.vertex_count = shape.positions.size() / 3;
  desc.indices = shape.indices.data();
  desc.index_count = shape.indices.size();
  return focal::Mesh(context, desc);
}

Shape with_noise(Shape shape, double length, uint32_t seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> normal(0, static_cast<float>(length));
  for (float& x : shape.positions) x += normal(random);
  return shape;
}

Shape with_holes(Shape shape, size_t holes, uint32_t seed) {
  std::mt19937 random(seed);
  std::set<uint32_t> centres;
  while (centres.size() < holes) centres.insert(random() % static_cast<uint32_t>(shape.positions.size() / 3));
  std::vector<uint32_t> kept;
  for (size_t i = 0; i < shape.indices.size(); i += 3) {
    const auto corner = shape.indices.begin() + static_cast<std::ptrdiff_t>(i);
    if (std::none_of(corner, corner + 3, [&](uint32_t v) { return centres.contains(v); })) {
      kept.insert(kept.end(), corner, corner + 3);
    }
  }
  shape.indices = std::move(kept);
  return shape;
}

Shape scaled(Shape shape, const std::array<double, 3>& factors) {
  for (size_t i = 0; i < shape.positions.size(); ++i)
    shape.positions[i] *= static_cast<float>(factors[i % 3]);
  return shape;
}

Shape resampled(const Shape& shape, size_t vertices) {
  const auto wanted = static_cast<double>(vertices);
  const auto count = [](const Shape& s) { return static_cast<double>(s.positions.size() / 3); };
  Shape result = shape;
  while (count(result) < 0.9 * wanted) result = refined(result);
  return count(result) > 1.1 * wanted ? decimated(result, wanted / count(result)) : result;
}

Shape cut_off(Shape shape, const std::vector<float>& distances, double radius) {
  std::vector<uint32_t> kept;
  for (size_t i = 0; i < shape.indices.size(); i += 3) {
    const auto corner = shape.indices.begin() + static_cast<std::ptrdiff_t>(i);
    if (std::none_of(corner, corner + 3, [&](uint32_t v) { return distances[v] < radius; }))
      kept.insert(kept.end(), corner, corner + 3);
  }
  shape.indices = std::move(kept);
  return shape;
}

double mean_edge(const Shape& shape) {
  double sum = 0;
  for (size_t i = 0; i < shape.indices.size(); ++i) {
    const float* a = &shape.positions[3 * size_t{shape.indices[i]}];
    const float* b = &shape.positions[3 * size_t{shape.indices[i % 3 == 2 ? i - 2 : i + 1]}];
    sum += std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
  }
  return sum / static_cast<double>(shape.indices.size());
}

}  // namespace paper
