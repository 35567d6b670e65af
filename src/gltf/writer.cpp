// Creates a small GLB.
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/error.h"
#include "gltf/accessor_writer.h"
#include "gltf/container.h"
#include "gltf/document.h"

namespace focal {
namespace {

using Json = OrderedJson;

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
      // NaN becomes 0.
      const float value = colours(vertex, k) > 0 ? std::min(colours(vertex, k), 1.0f) : 0.0f;
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
    throw Error(Status::invalid_mesh, "a triangle refers to a vertex that does not exist",
                "check the indices");
  if (colours.size() != 0 && (colours.rows() != mesh.vertex_count() || colours.cols() != 3))
    throw Error(Status::invalid_argument, "the colours are not one row of three per vertex",
                "pass n x 3 colours");
}

template <class T>
std::vector<T> values_of(const auto& matrix) {
  return std::vector<T>(matrix.data(), matrix.data() + matrix.size());
}

Json& appended(Json& root, const char* list) { return root[list][append_element(root, list)]; }

void put_material(Json& root) {
  Json& material = appended(root, "materials");
  Json& surface = new_object(material["pbrMetallicRoughness"]);
  surface["metallicFactor"] = 0, surface["roughnessFactor"] = 0.8;
  material["doubleSided"] = true;
}

}  // namespace

std::vector<std::byte> write_glb(const TriangleMesh& mesh, const RowMatrixf& colours,
                                 const std::string& name) {
  const RowMatrixf positions = mesh.positions.cast<float>();
  check(mesh, positions, colours);
  const Vector3 low = positions.colwise().minCoeff().cast<double>();
  const Vector3 high = positions.colwise().maxCoeff().cast<double>();
  OrderedJsonDocument document;
  Json& root = new_object(document.root());
  root.get_ref<Json::object_t&>().reserve(16);
  Json& asset = new_object(root["asset"]);
  asset["version"] = "2.0", asset["generator"] = "focal";
  root["scene"] = 0;
  new_list(appended(root, "scenes")["nodes"]).push_back(0);
  Json& node = appended(root, "nodes");
  node["name"] = name, node["mesh"] = 0;
  AccessorWriter data(root, {}, true);
  const size_t indices = data.add(values_of<uint32_t>(mesh.triangles), 1, ViewTarget::indices);
  const size_t vertices = data.add(values_of<float>(positions), 3, ViewTarget::vertices);
  data.put_bounds(vertices, std::span(low.data(), 3), std::span(high.data(), 3));
  const size_t normals = data.add(values_of<float>(smooth_normals(mesh)), 3, ViewTarget::vertices);
  Json& element = appended(root, "meshes");
  element["name"] = name;
  Json& primitive =
      (new_list(element["primitives"]).emplace_back(nullptr), new_object(element["primitives"][0]));
  Json& attributes = new_object(primitive["attributes"]);
  attributes["POSITION"] = vertices, attributes["NORMAL"] = normals;
  primitive["indices"] = indices, primitive["material"] = 0;
  if (colours.size() != 0) {
    const size_t accessor = data.add(colour_bytes(colours), 4, ViewTarget::vertices);
    data.accessor(accessor)["normalized"] = true;
    attributes["COLOR_0"] = accessor;
  }
  put_material(root);
  const std::vector<std::byte> bin = data.finish();
  return glb_bytes(root.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace), bin_chunk(bin));
}

}  // namespace focal
