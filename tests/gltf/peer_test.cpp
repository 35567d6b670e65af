// Our reader against an independent one, tinygltf, on real files: the same positions and triangles of every mesh.
#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#define TINYGLTF_NO_INCLUDE_JSON
#include <nlohmann/json.hpp>
//
#include <doctest/doctest.h>
#include <tiny_gltf.h>

#include <cstring>
#include <filesystem>

#include "evaluation_data.h"
#include "gltf/one_call.h"

namespace {

bool ignore_image(tinygltf::Image*, const int, std::string*, std::string*, int, int, const unsigned char*,
                  int, void*) {
  return true;
}

// Float positions and indices of one primitive, as tinygltf understands the file.
focal::TriangleMesh peer_primitive(const tinygltf::Model& model, const tinygltf::Primitive& primitive) {
  const auto element = [&](const tinygltf::Accessor& accessor, size_t i) {
    const auto& view = model.bufferViews[accessor.bufferView];
    return model.buffers[view.buffer].data.data() + view.byteOffset + accessor.byteOffset +
           i * accessor.ByteStride(view);
  };
  focal::TriangleMesh mesh;
  const auto& positions = model.accessors[primitive.attributes.at("POSITION")];
  mesh.positions.resize(static_cast<Eigen::Index>(positions.count), 3);
  for (size_t v = 0; v < positions.count; ++v) {
    float p[3];
    std::memcpy(p, element(positions, v), sizeof p);
    mesh.positions.row(static_cast<Eigen::Index>(v)) << p[0], p[1], p[2];
  }
  const auto& indices = model.accessors[primitive.indices];
  mesh.triangles.resize(static_cast<Eigen::Index>(indices.count / 3), 3);
  for (size_t i = 0; i < indices.count / 3 * 3; ++i) {
    uint32_t index = 0;  // little-endian: the low bytes come first
    std::memcpy(&index, element(indices, i), tinygltf::GetComponentSizeInBytes(indices.componentType));
    mesh.triangles.data()[i] = static_cast<int32_t>(index);
  }
  return mesh;
}

}  // namespace

TEST_CASE("our reader and tinygltf agree on the rigs") {
  const auto folder = focal_test::evaluation_set("rigs");
  if (!folder) return;
  int compared = 0;
  for (const auto& entry : std::filesystem::directory_iterator(*folder)) {
    if (entry.path().extension() != ".glb") continue;
    CAPTURE(entry.path().filename().string());
    tinygltf::TinyGLTF loader;
    loader.SetImageLoader(ignore_image, nullptr);
    tinygltf::Model model;
    std::string error, warning;
    REQUIRE(loader.LoadBinaryFromFile(&model, &error, &warning, entry.path().string()));
    const focal::GltfMesh ours = focal_test::read_gltf(entry.path());
    for (const auto& part : ours.primitives) {
      const auto& primitive = model.meshes[part.mesh].primitives[part.primitive];
      const auto& accessor = model.accessors[primitive.attributes.at("POSITION")];
      if (primitive.mode != TINYGLTF_MODE_TRIANGLES || primitive.indices < 0 || accessor.bufferView < 0 ||
          accessor.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT)
        continue;
      const focal::TriangleMesh peer = peer_primitive(model, primitive);
      REQUIRE(peer.vertex_count() == part.vertex_count);
      REQUIRE(peer.triangle_count() == part.triangle_count);
      double worst = 0;
      for (int32_t v = 0; v < part.vertex_count; ++v) {
        const focal::Vector3 placed =
            (part.world_transform * peer.positions.row(v).transpose().homogeneous()).head<3>();
        worst = std::max(worst, (placed - ours.mesh.positions.row(part.first_vertex + v).transpose()).norm());
      }
      CHECK(worst <= 1e-9 * (1 + ours.mesh.positions.cwiseAbs().maxCoeff()));
      if (!part.mirrored) {
        const focal::MatrixX3i triangles =
            ours.mesh.triangles.middleRows(part.first_triangle, part.triangle_count).array() -
            part.first_vertex;
        CHECK(triangles == peer.triangles);
      }
      ++compared;
    }
  }
  MESSAGE("primitives compared: " << compared);
  CHECK(compared > 50);
}
