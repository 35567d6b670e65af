// A mesh and its vote maps as the report page shows them. See shown_mesh.h.
#include "shown_mesh.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "landmark_text.h"
#include "marked_mesh.h"

namespace focal_cli {
namespace {

constexpr double page_bytes = 14e6;  // for the meshes of a page
constexpr size_t max_shown_vertices = 6000, min_shown_vertices = 400;

// The triangles over one vertex a position: exporters split vertices along seams, and a seam would show as a crease.
std::vector<uint32_t> welded(const focal_mesh* mesh) {
  const focal_mesh_info info = info_of(mesh);
  const uint32_t* corners = focal_mesh_triangles(mesh);
  std::vector<uint32_t> triangles(corners, corners + 3 * info.triangle_count);
  const size_t count = info.vertex_count;
  std::vector<uint32_t> group(count), first(count, ~0u);
  meshopt_generateVertexRemap(group.data(), nullptr, count, focal_mesh_positions(mesh), count,
                              3 * sizeof(float));
  for (uint32_t v = 0; v < count; ++v) {
    if (first[group[v]] == ~0u) first[group[v]] = v;
  }
  for (uint32_t& corner : triangles) corner = first[group[corner]];
  return triangles;
}

size_t distinct(std::vector<uint32_t> values) {
  std::sort(values.begin(), values.end());
  return static_cast<size_t>(std::unique(values.begin(), values.end()) - values.begin());
}

std::vector<uint32_t> decimated(const focal_mesh* mesh, const std::vector<uint32_t>& triangles,
                                size_t vertices, size_t most_vertices) {
  const size_t target =
      3 * static_cast<size_t>(static_cast<double>(triangles.size() / 3) * static_cast<double>(most_vertices) /
                              static_cast<double>(vertices));
  std::vector<uint32_t> kept(triangles.size());
  const float* positions = focal_mesh_positions(mesh);
  const size_t count = info_of(mesh).vertex_count, stride = 3 * sizeof(float);
  size_t size = meshopt_simplify(kept.data(), triangles.data(), triangles.size(), positions, count, stride,
                                 target, 1.0f, 0, nullptr);
  if (size > target + target / 4) {  // many small pieces: their shape has to give
    size = meshopt_simplifySloppy(kept.data(), triangles.data(), triangles.size(), positions, count, stride,
                                  target, 1.0f, nullptr);
  }
  kept.resize(size);
  return kept;
}

std::string little_endian(std::span<const uint32_t> numbers, size_t bytes) {
  std::string packed;
  for (const uint32_t number : numbers) {
    for (size_t i = 0; i < bytes; ++i) packed += static_cast<char>(number >> (8 * i) & 0xff);
  }
  return packed;
}

struct Box {
  std::array<float, 3> low{}, extent{};
  float size = 1;  // the longest extent
};

Box box_of(const focal_mesh* mesh, const ShownMesh& shown) {
  Box box;
  const float* positions = focal_mesh_positions(mesh);
  for (size_t axis = 0; axis < 3 && !shown.vertices.empty(); ++axis) {
    const auto [low, high] =
        std::minmax_element(shown.vertices.begin(), shown.vertices.end(), [&](uint32_t a, uint32_t b) {
          return positions[3 * size_t{a} + axis] < positions[3 * size_t{b} + axis];
        });
    box.low[axis] = positions[3 * size_t{*low} + axis];
    box.extent[axis] = positions[3 * size_t{*high} + axis] - box.low[axis];
  }
  const float size = *std::max_element(box.extent.begin(), box.extent.end());
  box.size = size > 0 ? size : 1;
  return box;
}

std::string packed_positions(const focal_mesh* mesh, const ShownMesh& shown, const Box& box) {
  std::vector<uint32_t> steps;
  const float* positions = focal_mesh_positions(mesh);
  for (const uint32_t v : shown.vertices) {
    for (size_t axis = 0; axis < 3; ++axis) {
      const float share = (positions[3 * size_t{v} + axis] - box.low[axis]) / box.size;
      steps.push_back(static_cast<uint32_t>(std::lround(65535 * std::clamp(share, 0.0f, 1.0f))));
    }
  }
  return base64(little_endian(steps, 2));
}

Json packed_votes(const focal_mesh* mesh, const ShownMesh& shown, const focal_detection* detection,
                  const std::set<std::string>& counted) {
  Json packed = Json::object();
  std::vector<float> votes(info_of(mesh).vertex_count);
  auto landmark = initialised(focal_landmark_init);
  for (uint32_t i = 0; i < focal_detection_landmark_count(detection); ++i) {
    check(focal_detection_get_landmark(detection, i, &landmark));
    if (!counted.contains(landmark.name)) continue;
    check(focal_detection_votes(detection, i, votes.size(), votes.data()));
    std::string bytes;
    for (const uint32_t v : shown.vertices) {
      bytes += static_cast<char>(static_cast<uint8_t>(std::lround(255 * std::clamp(votes[v], 0.0f, 1.0f))));
    }
    packed[landmark.name] = base64(bytes);
  }
  return packed;
}

}  // namespace

ShownMesh shown_mesh(const focal_mesh* mesh, size_t most_vertices) {
  ShownMesh shown{{}, welded(mesh)};
  const size_t vertices = distinct(shown.triangles);
  if (vertices > most_vertices) shown.triangles = decimated(mesh, shown.triangles, vertices, most_vertices);
  std::vector<uint32_t> place(info_of(mesh).vertex_count, ~0u);
  for (uint32_t& corner : shown.triangles) {
    if (place[corner] == ~0u) {
      place[corner] = static_cast<uint32_t>(shown.vertices.size());
      shown.vertices.push_back(corner);
    }
    corner = place[corner];
  }
  return shown;
}

Json shown_mesh_json(const focal_mesh* mesh, const ShownMesh& shown, const focal_detection* detection,
                     const std::set<std::string>& counted) {
  const Box box = box_of(mesh, shown);
  const size_t index_bytes = shown.vertices.size() <= 65536 ? 2 : 4;
  const focal_mesh_info info = info_of(mesh);
  return {{"vertices", shown.vertices.size()},
          {"decimated", 3 * info.triangle_count > shown.triangles.size()},
          {"low", triple(box.low.data())},
          {"extent", triple(box.extent.data())},
          {"size", tidy(box.size)},
          {"positions", packed_positions(mesh, shown, box)},
          {"index_bytes", index_bytes},
          {"triangles", base64(little_endian(shown.triangles, index_bytes))},
          {"votes", packed_votes(mesh, shown, detection, counted)}};
}

size_t shown_vertices_for(size_t meshes, size_t landmarks) {
  // A vertex: three 16-bit steps, two triangles of three 16-bit corners, a byte a landmark; base64 takes 4 for 3.
  const double vertex_bytes = (6.0 + 12.0 + static_cast<double>(landmarks)) * 4 / 3;
  const double most = page_bytes / vertex_bytes / std::max(1.0, static_cast<double>(meshes));
  return static_cast<size_t>(std::clamp(most, double{min_shown_vertices}, double{max_shown_vertices}));
}

std::string base64(std::string_view bytes) {
  static constexpr char base64_digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t group = 0;
    for (size_t k = 0; k < 3; ++k)
      group = group << 8 | (i + k < bytes.size() ? static_cast<uint8_t>(bytes[i + k]) : 0u);
    for (size_t k = 0; k < 4; ++k)
      text += i + k <= bytes.size() ? base64_digits[group >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

}  // namespace focal_cli
