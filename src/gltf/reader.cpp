// glTF in: preflight, then primitives one by one into one mesh.
#include "gltf/reader.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include "base/atomic_file.h"
#include "base/error.h"
#include "gltf/accessor.h"
#include "gltf/fields.h"
#include "gltf/preflight.h"
#include "gltf/scene.h"

namespace focal {
namespace {

using nlohmann::json;

enum Mode : int64_t { kTriangles = 4, kStrip = 5, kFan = 6 };

// A primitive that will be read, with its sizes known from the JSON alone.
struct Part {
  const json* primitive;
  int64_t mode;
  int64_t corners;  // entries of the index list, or vertices without one
  GltfPrimitive range;
};

std::string name_of(int32_t mesh, int32_t primitive) {
  return "mesh " + std::to_string(mesh) + ", primitive " + std::to_string(primitive);
}

int64_t accessor_count(const json& root, int64_t accessor) {
  return element_of(list(root, "accessors")[static_cast<size_t>(accessor)], {"accessors", accessor}).count;
}

// Draco keeps the data in an extension and leaves the accessors without any: they would read as zeros.
void refuse_draco(const json& root, const json& primitive, int64_t positions) {
  if (!extension(primitive, "KHR_draco_mesh_compression") ||
      member(list(root, "accessors")[static_cast<size_t>(positions)], "bufferView"))
    return;
  throw Error(Status::unsupported, "the mesh is compressed with Draco",
              "decompress it first, for example with `gltf-transform copy in.glb out.glb`, or export it with "
              "compression off");
}

void require(bool within, const char* what, int64_t limit) {
  if (!within)
    throw Error(Status::unsupported, "glTF with more than " + std::to_string(limit) + " " + what,
                "decimate the model or raise the limit");
}

// What is to be read and where it goes, from the JSON alone, so that the totals are checked before memory is taken.
class Plan {
 public:
  Plan(const json& root, const GltfLimits& limits)
      : root_(root),
        most_vertices_(std::min<int64_t>(limits.vertices, std::numeric_limits<int32_t>::max())),
        most_triangles_(std::min<int64_t>(limits.triangles, std::numeric_limits<int32_t>::max())) {}

  void add(const MeshPlacement& placement) {
    const json& primitives = list(root_, "meshes")[static_cast<size_t>(placement.mesh)]["primitives"];
    const int64_t first = triangles_;
    for (size_t p = 0; p < primitives.size(); ++p) {
      const int64_t mode = checked_integer(primitives[p], "mode", kTriangles);
      const bool is_surface = mode >= kTriangles && member(primitives[p]["attributes"], "POSITION");
      if (is_surface)
        add(placement, primitives[p], static_cast<int32_t>(p), mode);
      else
        ++skipped_;
    }
    pieces_.push_back({placement.name, static_cast<int32_t>(first), static_cast<int32_t>(triangles_ - first),
                       placement.is_character});
  }
  const std::vector<Part>& parts() const { return parts_; }
  std::vector<MeshPiece> take_pieces() { return std::move(pieces_); }
  int64_t vertices() const { return vertices_; }
  int64_t triangles() const { return triangles_; }
  int64_t skipped() const { return skipped_; }

 private:
  void add(const MeshPlacement& placement, const json& primitive, int32_t index, int64_t mode) {
    const auto positions = primitive["attributes"]["POSITION"].get<int64_t>();
    refuse_draco(root_, primitive, positions);
    const int64_t vertex_count = accessor_count(root_, positions);
    const json* indices = member(primitive, "indices");
    const int64_t corners = indices ? accessor_count(root_, indices->get<int64_t>()) : vertex_count;
    const int64_t triangle_count = mode == kTriangles ? corners / 3 : std::max<int64_t>(corners - 2, 0);
    require(vertex_count <= most_vertices_ - vertices_, "vertices", most_vertices_);
    require(triangle_count <= most_triangles_ - triangles_, "triangles", most_triangles_);
    const GltfPrimitive range{.mesh = placement.mesh,
                              .primitive = index,
                              .node = placement.node,
                              .first_vertex = static_cast<int32_t>(vertices_),
                              .vertex_count = static_cast<int32_t>(vertex_count),
                              .first_triangle = static_cast<int32_t>(triangles_),
                              .triangle_count = static_cast<int32_t>(triangle_count),
                              .world_transform = placement.world_transform,
                              .mirrored = placement.mirrored};
    parts_.push_back({&primitive, mode, corners, range});
    vertices_ += vertex_count;
    triangles_ += triangle_count;
  }

  const json& root_;
  int64_t most_vertices_, most_triangles_;
  int64_t vertices_ = 0, triangles_ = 0, skipped_ = 0;
  std::vector<Part> parts_;
  std::vector<MeshPiece> pieces_;
};

void read_positions(const json& root, GltfBuffers& buffers, const Part& part, bool lenient,
                    MatrixX3& positions) {
  const RowMatrix local =
      read_accessor(root, buffers, (*part.primitive)["attributes"]["POSITION"].get<int64_t>());
  const auto linear = part.range.world_transform.topLeftCorner<3, 3>();
  const auto offset = part.range.world_transform.topRightCorner<3, 1>();
  auto world = positions.middleRows(part.range.first_vertex, part.range.vertex_count);
  world = (local * linear.transpose()).rowwise() + offset.transpose();
  for (Eigen::Index vertex = 0; vertex < world.rows(); ++vertex) {
    if (world.row(vertex).cast<float>().allFinite()) continue;  // as callers and files get it
    if (!lenient)
      throw Error(Status::invalid_mesh,
                  name_of(part.range.mesh, part.range.primitive) + ": vertex " + std::to_string(vertex) +
                      " lies at a position that is not finite",
                  "repair the mesh in the program it was made with");
    world.row(vertex).setConstant(std::numeric_limits<double>::quiet_NaN());
  }
}

void read_triangles(const json& root, GltfBuffers& buffers, const Part& part, bool lenient,
                    MatrixX3i& triangles) {
  const json* indices = member(*part.primitive, "indices");
  RowMatrix corners;
  if (indices) corners = read_accessor(root, buffers, indices->get<int64_t>());
  const auto corner = [&](int64_t i) { return indices ? static_cast<int64_t>(corners(i)) : i; };
  for (int64_t t = 0; t < part.range.triangle_count; ++t) {
    std::array<int64_t, 3> at{3 * t, 3 * t + 1, 3 * t + 2};
    if (part.mode == kStrip) at = {t, t + 1 + t % 2, t + 2 - t % 2};
    if (part.mode == kFan) at = {t + 1, t + 2, 0};
    if (part.range.mirrored) std::swap(at[1], at[2]);
    for (int k = 0; k < 3; ++k) {
      const int64_t vertex = corner(at[static_cast<size_t>(k)]);
      const bool exists = vertex < part.range.vertex_count;
      if (!exists && !lenient)
        throw Error(Status::invalid_mesh,
                    name_of(part.range.mesh, part.range.primitive) + ": triangle " + std::to_string(t) +
                        " refers to vertex " + std::to_string(vertex) + " of " +
                        std::to_string(part.range.vertex_count),
                    "export the mesh again");
      triangles(part.range.first_triangle + t, k) =
          exists ? static_cast<int32_t>(part.range.first_vertex + vertex) : -1;
    }
  }
}

GltfMesh read(std::span<const std::byte> bytes, const GltfReadParams& params,
              std::optional<std::filesystem::path> folder) {
  const GltfLimits& limits = params.limits;
  const GltfContainer container = open_container(bytes, limits);
  const JsonDocument document = parse_gltf(container, limits);
  const json& root = document.root();
  GltfBuffers buffers(root, container, limits, std::move(folder));
  GltfMesh result;
  Plan plan(root, limits);
  ShownMeshes shown = placed_meshes(root, buffers, params.hidden_too, result.warnings);
  for (const MeshPlacement& placement : shown.placements) plan.add(placement);
  result.hidden = std::move(shown.hidden);
  result.pieces = plan.take_pieces();
  if (plan.skipped() > 0)
    result.warnings.push_back(std::to_string(plan.skipped()) +
                              " primitives of points or lines, or without positions, were skipped");
  result.mesh.positions.resize(plan.vertices(), 3);
  result.mesh.triangles.resize(plan.triangles(), 3);
  for (const Part& part : plan.parts()) {
    if (part.mode == kTriangles && part.corners % 3 != 0)
      result.warnings.push_back(name_of(part.range.mesh, part.range.primitive) +
                                ": the number of corners is no multiple of three; the rest was left out");
    read_positions(root, buffers, part, params.lenient, result.mesh.positions);
    read_triangles(root, buffers, part, params.lenient, result.mesh.triangles);
    result.primitives.push_back(part.range);
  }
  // Said last, since a buffer that cannot be read is the better explanation.
  if (result.mesh.triangle_count() == 0)
    throw Error(Status::invalid_mesh, "the file holds no triangles", "pass a file with a triangle mesh");
  return result;
}

}  // namespace

GltfMesh read_gltf(const std::filesystem::path& path, const GltfReadParams& params) {
  const auto bytes = read_file(path, params.limits.file_bytes);
  std::optional<std::filesystem::path> folder;
  if (params.allow_external_files) folder = path.parent_path();
  return read(bytes, params, std::move(folder));
}

GltfMesh read_gltf_memory(std::span<const std::byte> bytes, const GltfReadParams& params) {
  return read(bytes, params, std::nullopt);
}

}  // namespace focal
