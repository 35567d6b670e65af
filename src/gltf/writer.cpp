// A small GLB from scratch.
#include "gltf/writer.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "base/error.h"
#include "gltf/glb.h"

namespace focal {
namespace {

template <class T>
void append(std::vector<std::byte>& bytes, const T* values, size_t count) {
  const auto data = std::as_bytes(std::span(values, count));
  bytes.insert(bytes.end(), data.begin(), data.end());
}

// A vertex of no triangle gets any unit vector.
RowMatrixf smooth_normals(const TriangleMesh& mesh) {
  MatrixX3 sums = area_normals(mesh);
  for (Eigen::Index vertex = 0; vertex < sums.rows(); ++vertex) {
    const Vector3 unit = Vector3(sums.row(vertex)).stableNormalized();
    const bool usable = unit.allFinite() && std::abs(unit.norm() - 1) < 1e-6;
    sums.row(vertex) = (usable ? unit : Vector3(0, 0, 1)).transpose();
  }
  return sums.cast<float>();
}

std::vector<uint8_t> colour_bytes(const RowMatrixf& colours) {
  std::vector<uint8_t> bytes;
  bytes.reserve(static_cast<size_t>(colours.rows()) * 4);
  for (Eigen::Index vertex = 0; vertex < colours.rows(); ++vertex) {
    for (int k = 0; k < 3; ++k) {
      const float value =
          colours(vertex, k) > 0 ? std::min(colours(vertex, k), 1.0f) : 0.0f;  // NaN becomes 0
      bytes.push_back(static_cast<uint8_t>(std::lround(value * 255)));
    }
    bytes.push_back(255);
  }
  return bytes;
}

void check(const TriangleMesh& mesh, const RowMatrixf& positions, const RowMatrixf& colours) {
  if (mesh.triangle_count() == 0)
    throw Error(Status::invalid_mesh, "there are no triangles to write", "pass a mesh with triangles");
  if (!positions.allFinite())
    throw Error(Status::invalid_mesh, "a position is not finite in single precision", "scale the mesh");
  if (mesh.triangles.minCoeff() < 0 || mesh.triangles.maxCoeff() >= mesh.vertex_count())
    throw Error(Status::invalid_mesh, "a triangle refers to a vertex that is not there", "check the indices");
  if (colours.size() != 0 && (colours.rows() != mesh.vertex_count() || colours.cols() != 3))
    throw Error(Status::invalid_argument, "the colours are not one row of three a vertex",
                "pass n x 3 colours");
}

// Collects attributes, each in a view and an accessor of its own.
struct Attributes {
  std::vector<std::byte> data;
  std::string views, accessors;

  template <class T>
  void add(const T* values, size_t count, const char* target, const std::string& accessor) {
    const char* const comma = views.empty() ? "" : ",";
    const std::string index = std::to_string(view_count++);
    views += std::string(comma) + R"({"buffer":0,"byteOffset":)" + std::to_string(data.size()) +
             R"(,"byteLength":)" + std::to_string(count * sizeof(T)) + R"(,"target":)" + target + "}";
    accessors += std::string(comma) + R"({"bufferView":)" + index + "," + accessor + "}";
    append(data, values, count);
  }
  int view_count = 0;
};

}  // namespace

std::vector<std::byte> write_glb(const TriangleMesh& mesh, const RowMatrixf& colours,
                                 const std::string& name) {
  const RowMatrixf positions = mesh.positions.cast<float>();
  check(mesh, positions, colours);
  const RowMatrixf normals = smooth_normals(mesh);
  const Vector3 low = positions.colwise().minCoeff().cast<double>();
  const Vector3 high = positions.colwise().maxCoeff().cast<double>();
  const std::string vertices = R"(,"count":)" + std::to_string(mesh.vertex_count());
  constexpr const char *kVertexTarget = "34962", *kIndexTarget = "34963";

  Attributes out;
  out.add(mesh.triangles.data(), static_cast<size_t>(mesh.triangles.size()), kIndexTarget,
          R"("componentType":5125,"type":"SCALAR","count":)" + std::to_string(mesh.triangles.size()));
  out.add(positions.data(), static_cast<size_t>(positions.size()), kVertexTarget,
          R"("componentType":5126,"type":"VEC3")" + vertices + R"(,"min":)" + json_array(low) + R"(,"max":)" +
              json_array(high));
  out.add(normals.data(), static_cast<size_t>(normals.size()), kVertexTarget,
          R"("componentType":5126,"type":"VEC3")" + vertices);
  std::string attributes = R"("POSITION":1,"NORMAL":2)";
  if (colours.size() != 0) {
    const auto bytes = colour_bytes(colours);
    out.add(bytes.data(), bytes.size(), kVertexTarget,
            R"("componentType":5121,"normalized":true,"type":"VEC4")" + vertices);
    attributes += R"(,"COLOR_0":3)";
  }
  const std::string json =
      R"({"asset":{"version":"2.0","generator":"focal"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"name":)" +
      json_string(name) + R"(,"mesh":0}],"meshes":[{"name":)" + json_string(name) +
      R"(,"primitives":[{"attributes":{)" + attributes +
      R"(},"indices":0,"material":0}]}],"materials":[{"pbrMetallicRoughness":{"metallicFactor":0,"roughnessFactor":0.8},)"
      R"("doubleSided":true}],"accessors":[)" +
      out.accessors + R"(],"bufferViews":[)" + out.views + R"(],"buffers":[{"byteLength":)" +
      std::to_string(out.data.size()) + "}]}";
  return glb_bytes(json, bin_chunk(out.data));
}

}  // namespace focal
