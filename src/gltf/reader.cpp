// Merges the meshes that a file shows into one, primitive by primitive.
#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <utility>

#include "base/error.h"
#include "gltf/accessor.h"
#include "gltf/opened.h"
#include "gltf/scene.h"

namespace focal {
namespace {

// A primitive to be read, with its sizes known from the JSON alone.
struct Part {
  const tiny::Primitive* primitive;
  int64_t corners;                     // entries of the index list, or vertices without one
  const std::vector<double>* weights;  // default weights of its morph targets in the file
  GltfPrimitive range;
};

std::string name_of(const GltfPrimitive& range) {
  return "mesh " + std::to_string(range.mesh) + ", primitive " + std::to_string(range.primitive);
}

// Draco stores the data in an extension and leaves the accessors empty: they would read as zeros.
void refuse_draco(const tiny::Model& model, const tiny::Primitive& primitive,
                  const tiny::Accessor& positions) {
  if (!extension(primitive.extensions, "KHR_draco_mesh_compression") || has_view(model, positions)) return;
  throw Error(Status::unsupported, "the mesh is compressed with Draco",
              "decompress it first, for example with `gltf-transform copy in.glb out.glb`, or export it with "
              "compression off");
}

void require(bool within, const char* what, int64_t limit) {
  if (!within)
    throw Error(Status::unsupported, "glTF with more than " + std::to_string(limit) + " " + what,
                "decimate the model or raise the limit");
}

// Plans what to read and where it goes, from the JSON alone, so that the totals are checked before memory is
// allocated.
class Plan {
 public:
  Plan(const tiny::Model& model, const GltfLimits& limits)
      : model_(model),
        max_vertices_(std::min<int64_t>(limits.vertices, std::numeric_limits<int32_t>::max())),
        max_triangles_(std::min<int64_t>(limits.triangles, std::numeric_limits<int32_t>::max())) {}

  void add(const MeshPlacement& placement) {
    const auto& primitives = model_.meshes[static_cast<size_t>(placement.mesh)].primitives;
    const int64_t first = triangles_;
    empty_meshes_ += primitives.empty();
    for (size_t p = 0; p < primitives.size(); ++p) {
      const auto positions = primitives[p].attributes.find("POSITION");
      if (primitives[p].mode < TINYGLTF_MODE_TRIANGLES || positions == primitives[p].attributes.end())
        ++skipped_;
      else
        add(placement, primitives[p], static_cast<int32_t>(p), positions->second);
    }
    pieces_.push_back({placement.name, static_cast<int32_t>(first), static_cast<int32_t>(triangles_ - first),
                       placement.is_character});
  }
  const std::vector<Part>& parts() const { return parts_; }
  std::vector<MeshPiece> take_pieces() { return std::move(pieces_); }
  int64_t vertices() const { return vertices_; }
  int64_t triangles() const { return triangles_; }
  void warn(std::vector<std::string>& warnings) const;

 private:
  void add(const MeshPlacement& placement, const tiny::Primitive& primitive, int32_t index, int accessor);
  const std::vector<double>& weights_of(const MeshPlacement& placement) const;

  const tiny::Model& model_;
  int64_t max_vertices_, max_triangles_;
  int64_t vertices_ = 0, triangles_ = 0, skipped_ = 0, empty_ = 0, empty_meshes_ = 0;
  std::vector<Part> parts_;
  std::vector<MeshPiece> pieces_;
};

void Plan::warn(std::vector<std::string>& warnings) const {
  if (skipped_ > 0)
    warnings.push_back(std::to_string(skipped_) +
                       " primitives of points or lines, or without positions, were skipped");
  if (empty_ > 0) warnings.push_back(std::to_string(empty_) + " empty primitives were left out");
  if (empty_meshes_ > 0)
    warnings.push_back(std::to_string(empty_meshes_) + " meshes without primitives were left out");
}

const std::vector<double>& Plan::weights_of(const MeshPlacement& placement) const {
  static const std::vector<double> none;
  const auto& own = placement.node < 0 ? none : model_.nodes[static_cast<size_t>(placement.node)].weights;
  return own.empty() ? model_.meshes[static_cast<size_t>(placement.mesh)].weights : own;
}

void Plan::add(const MeshPlacement& placement, const tiny::Primitive& primitive, int32_t index,
               int accessor) {
  const tiny::Accessor& positions = model_.accessors[static_cast<size_t>(accessor)];
  refuse_draco(model_, primitive, positions);
  const auto vertex_count = static_cast<int64_t>(positions.count);
  const bool is_indexed = primitive.indices >= 0;
  const int64_t corners =
      is_indexed ? static_cast<int64_t>(model_.accessors[static_cast<size_t>(primitive.indices)].count)
                 : vertex_count;
  if (vertex_count == 0 || corners == 0) {
    ++empty_;
    return;
  }
  const int64_t triangle_count =
      primitive.mode == TINYGLTF_MODE_TRIANGLES ? corners / 3 : std::max<int64_t>(corners - 2, 0);
  require(vertex_count <= max_vertices_ - vertices_, "vertices", max_vertices_);
  require(triangle_count <= max_triangles_ - triangles_, "triangles", max_triangles_);
  const GltfPrimitive range{.mesh = placement.mesh,
                            .primitive = index,
                            .node = placement.node,
                            .first_vertex = static_cast<int32_t>(vertices_),
                            .vertex_count = static_cast<int32_t>(vertex_count),
                            .first_triangle = static_cast<int32_t>(triangles_),
                            .triangle_count = static_cast<int32_t>(triangle_count),
                            .world_transform = placement.world_transform,
                            .mirrored = placement.mirrored,
                            .skin = placement.skin,
                            .joint = placement.joint,
                            .is_posed = placement.is_posed};
  parts_.push_back({&primitive, corners, &weights_of(placement), range});
  vertices_ += vertex_count;
  triangles_ += triangle_count;
}

// In the mesh's own coordinates, with its morph targets applied.
RowMatrix shape_of(const GltfView& view, GltfBuffers& buffers, const Part& part) {
  RowMatrix local = read_accessor(view, buffers, part.primitive->attributes.at("POSITION"));
  const auto& targets = part.primitive->targets;
  for (size_t t = 0; t < std::min(targets.size(), part.weights->size()); ++t) {
    const auto offsets = targets[t].find("POSITION");
    if (const double weight = (*part.weights)[t]; weight != 0 && offsets != targets[t].end())
      local += weight * read_accessor(view, buffers, offsets->second);
  }
  return local;
}

void read_positions(const GltfView& view, GltfBuffers& buffers, const Part& part, bool lenient,
                    MatrixX3& positions) {
  const RowMatrix local = shape_of(view, buffers, part);
  const auto linear = part.range.world_transform.topLeftCorner<3, 3>();
  const auto offset = part.range.world_transform.topRightCorner<3, 1>();
  auto world = positions.middleRows(part.range.first_vertex, part.range.vertex_count);
  world = (local * linear.transpose()).rowwise() + offset.transpose();
  if (part.range.is_posed) {
    const auto transforms = vertex_transforms(view, buffers, part.range);
    for (Eigen::Index v = 0; v < world.rows(); ++v)
      world.row(v) = (transforms[v] * local.row(v).transpose().homogeneous()).head<3>().transpose();
  }
  for (Eigen::Index vertex = 0; vertex < world.rows(); ++vertex) {
    if (world.row(vertex).cast<float>().allFinite())
      continue;  // in single precision, as callers and files get it
    if (!lenient)
      throw Error(
          Status::invalid_mesh,
          name_of(part.range) + ": vertex " + std::to_string(vertex) + " has a position that is not finite",
          "repair the mesh in the program it was made with");
    world.row(vertex).setConstant(std::numeric_limits<double>::quiet_NaN());
  }
}

void read_triangles(const GltfView& view, GltfBuffers& buffers, const Part& part, bool lenient,
                    MatrixX3i& triangles) {
  const bool is_indexed = part.primitive->indices >= 0;
  RowMatrix corners;
  if (is_indexed) corners = read_accessor(view, buffers, part.primitive->indices);
  const auto corner = [&](int64_t i) { return is_indexed ? static_cast<int64_t>(corners(i)) : i; };
  for (int64_t t = 0; t < part.range.triangle_count; ++t) {
    std::array<int64_t, 3> at{3 * t, 3 * t + 1, 3 * t + 2};
    if (part.primitive->mode == TINYGLTF_MODE_TRIANGLE_STRIP) at = {t, t + 1 + t % 2, t + 2 - t % 2};
    if (part.primitive->mode == TINYGLTF_MODE_TRIANGLE_FAN) at = {t + 1, t + 2, 0};
    if (part.range.mirrored) std::swap(at[1], at[2]);
    for (int k = 0; k < 3; ++k) {
      const int64_t vertex = corner(at[static_cast<size_t>(k)]);
      const bool exists = vertex < part.range.vertex_count;
      if (!exists && !lenient)
        throw Error(Status::invalid_mesh,
                    name_of(part.range) + ": triangle " + std::to_string(t) + " refers to vertex " +
                        std::to_string(vertex) + " of " + std::to_string(part.range.vertex_count),
                    "export the mesh again");
      triangles(part.range.first_triangle + t, k) =
          exists ? static_cast<int32_t>(part.range.first_vertex + vertex) : -1;
    }
  }
}

}  // namespace

GltfMesh GltfDocument::mesh() const {
  const GltfReadParams& params = opened_->params;
  const GltfView& view = opened_->view;
  GltfBuffers buffers = opened_->buffers();
  GltfMesh result;
  Plan plan(view.model, params.limits);
  ShownMeshes shown = placed_meshes(view, buffers, params.hidden_too, result.warnings);
  for (const MeshPlacement& placement : shown.placements) plan.add(placement);
  result.hidden = std::move(shown.hidden);
  result.pieces = plan.take_pieces();
  plan.warn(result.warnings);
  result.mesh.positions.resize(plan.vertices(), 3);
  result.mesh.triangles.resize(plan.triangles(), 3);
  for (const Part& part : plan.parts()) {
    if (part.primitive->mode == TINYGLTF_MODE_TRIANGLES && part.corners % 3 != 0)
      result.warnings.push_back(name_of(part.range) +
                                ": the number of corners is not a multiple of three; the rest was left out");
    read_positions(view, buffers, part, params.lenient, result.mesh.positions);
    read_triangles(view, buffers, part, params.lenient, result.mesh.triangles);
    result.primitives.push_back(part.range);
  }
  // Reported last, since an unreadable buffer is the better explanation.
  if (result.mesh.triangle_count() == 0)
    throw Error(Status::invalid_mesh, "the file has no triangles", "pass a file with a triangle mesh");
  return result;
}

}  // namespace focal
