// Every way glTF can store a triangle mesh, against positions and triangles worked out by hand.
#include <doctest/doctest.h>

#include <filesystem>
#include <string>

#include "base/atomic_file.h"
#include "base/error.h"
#include "evaluation_data.h"
#include "gltf/gltf_builder.h"
#include "gltf/one_call.h"
#include "platform.h"
#include "temporary_folder.h"

using namespace focal;
using namespace focal_test;

namespace {

Vector3 position(const GltfMesh& mesh, int32_t vertex) { return mesh.mesh.positions.row(vertex); }

std::vector<int32_t> triangle_list(const GltfMesh& mesh) {
  return {mesh.mesh.triangles.data(), mesh.mesh.triangles.data() + mesh.mesh.triangles.size()};
}

Status status_of(std::span<const std::byte> bytes, const GltfReadParams& params = {}) {
  try {
    read_gltf_memory(bytes, params);
    return Status::ok;
  } catch (const Error& error) {
    CHECK_FALSE(error.hint().empty());
    return error.status();
  }
}

// Reads one VEC3 accessor of one triangle back.
template <class T>
MatrixX3 positions_read(const std::vector<T>& values, bool normalized) {
  GltfBuilder file;
  file.add_mesh(file.add_accessor(values, "VEC3", normalized));
  return read_gltf_memory(file.glb()).mesh.positions;
}

}  // namespace

TEST_CASE("an indexed mesh comes as it is, from .glb and from .gltf with a data URI") {
  const GltfBuilder file = tetrahedron();
  const GltfMesh mesh = read_gltf_memory(file.glb());
  CHECK(mesh.mesh.vertex_count() == 4);
  CHECK(triangle_list(mesh) == std::vector<int32_t>{0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3});
  CHECK(position(mesh, 3) == Vector3(0, 0, 1));
  CHECK(mesh.warnings.empty());
  REQUIRE(mesh.primitives.size() == 1);
  CHECK(mesh.primitives[0].node == 0);
  CHECK(mesh.primitives[0].triangle_count == 4);

  GltfBuilder flat;  // three floats (1, 2, 3), twice, and a third point
  flat.bin.resize(12);
  flat.add("bufferViews", {{"buffer", 0}, {"byteLength", 12}});
  flat.add("accessors", {{"bufferView", 0}, {"componentType", 5126}, {"type", "VEC3"}, {"count", 1}});
  flat.add("accessors", {{"componentType", 5121}, {"type", "SCALAR"}, {"count", 3}});  // zeros
  flat.add_mesh(0, 1);
  const GltfMesh decoded =
      read_gltf_memory(flat.gltf("data:application/octet-stream;base64,AACAPwAAAEAAAEBA"));
  CHECK(position(decoded, 0) == Vector3(1, 2, 3));
  CHECK(triangle_list(decoded) == std::vector<int32_t>{0, 0, 0});
}

TEST_CASE("quantised positions are scaled as KHR_mesh_quantization says") {
  CHECK(positions_read<int8_t>({-128, 127, 0, -127, 1, 2, 3, 4, 5}, false).row(0) ==
        Vector3(-128, 127, 0).transpose());
  const MatrixX3 i8 = positions_read<int8_t>({-128, 127, 0, -127, 1, 2, 3, 4, 5}, true);
  CHECK(i8.row(0) == Vector3(-1, 1, 0).transpose());
  CHECK(i8(1, 1) == 1 / 127.0);
  CHECK(positions_read<uint8_t>({255, 51, 0, 0, 0, 0, 0, 0, 0}, true)(0, 1) == 0.2);
  CHECK(positions_read<uint16_t>({65535, 13107, 0, 0, 0, 0, 0, 0, 0}, true)(0, 1) == 0.2);
  CHECK(positions_read<int16_t>({-32768, 32767, 0, 0, 0, 0, 0, 0, 0}, true)(0, 0) == -1);
  CHECK(positions_read<uint16_t>({65535, 7, 0, 0, 0, 0, 0, 0, 0}, false)(0, 0) == 65535);
}

TEST_CASE("strips and fans turn into triangles of one orientation") {
  const std::vector<float> points = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0};
  GltfBuilder file;
  const int positions = file.add_accessor(points, "VEC3");
  file.add_mesh(positions, -1, 5);
  file.add_mesh(positions, -1, 6);
  file.add_mesh(positions, -1, 1);  // lines
  const GltfMesh mesh = read_gltf_memory(file.glb());
  CHECK(triangle_list(mesh) == std::vector<int32_t>{0, 1, 2, 1, 3, 2, 2, 3, 4, 6, 7, 5, 7, 8, 5, 8, 9, 5});
  CHECK(mesh.warnings.size() == 2);  // lines skipped; no node shows a mesh
  for (int t = 0; t < 3; ++t) {
    const auto row = mesh.mesh.triangles.row(t);
    const Vector3 a = position(mesh, row(0)), b = position(mesh, row(1)), c = position(mesh, row(2));
    CHECK((b - a).cross(c - a).z() > 0);
  }
}

TEST_CASE("a sparse accessor replaces entries, with and without a base") {
  for (const bool with_base : {true, false}) {
    GltfBuilder file = tetrahedron();
    json& accessor = file.root["accessors"][0];
    if (!with_base) accessor.erase("bufferView");
    const int where = file.add_view(std::vector<uint8_t>{1, 3});
    const int what = file.add_view(std::vector<float>{5, 6, 7, 8, 9, 10});
    accessor["sparse"] = {{"count", 2},
                          {"indices", {{"bufferView", where}, {"componentType", 5121}}},
                          {"values", {{"bufferView", what}}}};
    const GltfMesh mesh = read_gltf_memory(file.glb());
    CHECK(position(mesh, 1) == Vector3(5, 6, 7));
    CHECK(position(mesh, 3) == Vector3(8, 9, 10));
    CHECK(position(mesh, 2) == (with_base ? Vector3(0, 1, 0) : Vector3(0, 0, 0)));
    file.bin[file.root["bufferViews"][size_t(where)]["byteOffset"].get<size_t>()] = std::byte(4);
    CHECK(status_of(file.glb()) == Status::invalid_file);
  }
}

TEST_CASE("interleaved attributes are read with their stride") {
  GltfBuilder file;
  const int view = file.add_view(std::vector<float>{9, 1, 2, 3, 9, 4, 5, 6, 9, 7, 8, 9});
  file.root["bufferViews"][0]["byteStride"] = 16;
  file.add(
      "accessors",
      {{"bufferView", view}, {"byteOffset", 4}, {"componentType", 5126}, {"type", "VEC3"}, {"count", 3}});
  file.add_mesh(0);
  CHECK(position(read_gltf_memory(file.glb()), 2) == Vector3(7, 8, 9));
  file.root["accessors"][0]["byteOffset"] = 8;  // the last entry now ends 4 bytes behind the view
  CHECK(status_of(file.glb()) == Status::invalid_file);
}

TEST_CASE("node transforms multiply from the root, and a mirror keeps triangles facing outside") {
  GltfBuilder file = tetrahedron();
  file.root["nodes"] = json::array();
  file.root["scenes"] = json::array();
  const double half = std::sqrt(0.5);  // a quarter turn around z: x goes to y
  const int parent = file.add_node({{"translation", {10, 0, 0}}, {"rotation", {0, 0, half, half}}});
  file.add_node({{"scale", {-2, 3, 4}}, {"mesh", 0}}, parent);
  const GltfMesh mesh = read_gltf_memory(file.glb());
  CHECK((position(mesh, 1) - Vector3(10, -2, 0)).norm() < 1e-12);
  CHECK((position(mesh, 2) - Vector3(7, 0, 0)).norm() < 1e-12);
  CHECK((position(mesh, 3) - Vector3(10, 0, 4)).norm() < 1e-12);
  CHECK(mesh.primitives[0].mirrored);
  CHECK(triangle_list(mesh) == std::vector<int32_t>{0, 1, 2, 0, 3, 1, 0, 2, 3, 1, 3, 2});
  double volume = 0;
  for (int32_t t = 0; t < 4; ++t) {
    const auto row = mesh.mesh.triangles.row(t);
    volume += position(mesh, row(0)).dot(position(mesh, row(1)).cross(position(mesh, row(2)))) / 6;
  }
  CHECK(volume == doctest::Approx(24 / 6.0));

  file.root["nodes"][1] = {{"mesh", 0}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1}}};
  CHECK((position(read_gltf_memory(file.glb()), 0) - Vector3(4, 5, 7)).norm() < 1e-12);
}

TEST_CASE("meshes come in scene order, every instance; the default scene decides") {
  GltfBuilder file = tetrahedron();
  file.add_mesh(0, 1);
  file.add_mesh(0, 1);
  file.root["nodes"] = json::parse(
      R"([{"mesh":1,"translation":[1,0,0],"children":[2]},{"mesh":0},{"mesh":2},{"mesh":1},{"mesh":0,"translation":[9,9,9]}])");
  file.root["scenes"] = json::parse(R"([{"nodes":[4]},{"nodes":[0,3,1]}])");
  file.root["scene"] = 1;
  const GltfMesh mesh = read_gltf_memory(file.glb());
  REQUIRE(mesh.primitives.size() == 4);
  CHECK(mesh.primitives[0].mesh == 1);
  CHECK(mesh.primitives[1].mesh == 2);
  CHECK(mesh.primitives[1].first_vertex == 4);
  CHECK(mesh.primitives[1].first_triangle == 4);
  CHECK(position(mesh, 4) == Vector3(1, 0, 0));  // the child moved with its parent
  CHECK(mesh.primitives[2].mesh == 1);           // once more
  CHECK(mesh.primitives[2].node == 3);
  CHECK(mesh.primitives[2].first_vertex == 8);
  CHECK(position(mesh, 8) == Vector3(0, 0, 0));
  CHECK(mesh.primitives[3].mesh == 0);
  CHECK(mesh.primitives[3].node == 1);
  CHECK(mesh.pieces.size() == 4);
  CHECK(mesh.warnings.empty());

  file.root.erase("scene");  // all scenes then
  CHECK(read_gltf_memory(file.glb()).primitives[0].node == 4);
  file.root.erase("scenes");  // all nodes then
  CHECK(read_gltf_memory(file.glb()).primitives.size() == 5);
  file.root.erase("nodes");  // all meshes then
  CHECK(read_gltf_memory(file.glb()).primitives[2].node == -1);
}

TEST_CASE("a skinned mesh is placed by its joints, not by its node") {
  GltfBuilder file = tetrahedron();
  file.root["nodes"][0]["translation"] = {100, 0, 0};  // to be ignored
  file.root["nodes"][0]["skin"] = 0;
  const int hip = file.add_node({{"translation", {0, 5, 0}}});
  const int knee = file.add_node({{"translation", {0, 1, 0}}}, hip);
  // Bind matrices such that the character stands 3 higher than its stored positions.
  const auto lowered = [](float y) {
    return std::vector<float>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, y, 0, 1};
  };
  std::vector<float> matrices = lowered(-3);
  const std::vector<float> of_hip = lowered(-2);
  matrices.insert(matrices.end(), of_hip.begin(), of_hip.end());
  const int accessor = file.add_accessor(matrices, "MAT4");
  file.add("skins", {{"joints", {knee, hip}}, {"inverseBindMatrices", accessor}});
  GltfMesh mesh = read_gltf_memory(file.glb());
  CHECK(position(mesh, 1) == Vector3(1, 3, 0));
  CHECK(mesh.warnings.empty());
  file.root["nodes"][size_t(knee)]["translation"] = {0, 2, 0};  // the knee stretched: no longer the bind pose
  mesh = read_gltf_memory(file.glb());
  CHECK(position(mesh, 1) == Vector3(1, 3, 0));
  CHECK(mesh.warnings.size() == 1);
}

TEST_CASE("files beside the .gltf are read only when allowed, and only inside its folder") {
  const TemporaryFolder temporary;
  const std::filesystem::path& folder = temporary.path;
  const GltfBuilder file = tetrahedron();
  const auto status = [&](const std::string& uri, bool allow) {
    write_file_atomically(folder / "mesh.gltf", file.gltf(uri));
    try {
      return read_gltf(folder / "mesh.gltf", {.limits = {}, .allow_external_files = allow})
                         .mesh.vertex_count() == 4
                 ? Status::ok
                 : Status::internal;
    } catch (const Error& error) {
      return error.status();
    }
  };
  write_file_atomically(folder / "my data.bin", file.bin);
  REQUIRE(focal_test::make_pipe(folder / "pipe"));
  CHECK(status("my%20data.bin", true) == Status::ok);
  CHECK(status("my%20data.bin", false) == Status::unsupported);
  CHECK(status("missing.bin", true) == Status::file_not_found);
  CHECK(status("pipe", true) == Status::invalid_file);
  CHECK(status("../../../../etc/passwd", true) == Status::invalid_file);
  CHECK(status("%2e%2e/x", true) == Status::invalid_file);
  CHECK(status("/dev/zero", true) == Status::invalid_file);
  CHECK(status("file:///etc/passwd", true) == Status::invalid_file);
}

TEST_CASE("each kind of damage has its status") {
  const GltfBuilder good = tetrahedron();
  const auto changed = [&](auto&& change) {
    GltfBuilder file = good;
    change(file);
    return status_of(file.glb());
  };
  const auto patched = [&](const char* pointer, json value) {
    return changed([&](GltfBuilder& file) { file.root[json::json_pointer(pointer)] = std::move(value); });
  };
  CHECK(status_of(good.glb()) == Status::ok);
  CHECK_THROWS_AS(read_gltf("/no/such/file.glb"), Error);
  CHECK(status_of({}) == Status::invalid_file);
  CHECK(status_of(bytes_of("hello")) == Status::invalid_file);
  CHECK(patched("/accessors/0/count", 5) == Status::invalid_file);
  CHECK(patched("/accessors/0/count", 4611686018427387904) == Status::invalid_file);
  CHECK(patched("/accessors/0/byteOffset", -12) == Status::invalid_file);
  CHECK(patched("/accessors/0/byteOffset", 18446744073709551604u) == Status::invalid_file);
  CHECK(patched("/accessors/0/type", "VEC4") == Status::invalid_file);
  CHECK(patched("/accessors/0/bufferView", 7) == Status::invalid_file);
  CHECK(patched("/bufferViews/0/byteLength", 1e9) == Status::invalid_file);
  CHECK(patched("/bufferViews/0/byteStride", 8) == Status::invalid_file);
  CHECK(patched("/nodes/0/children", {0}) == Status::invalid_file);
  CHECK(patched("/nodes/0/matrix", {1, 2}) == Status::invalid_file);
  CHECK(patched("/nodes/0/mesh", -1) == Status::invalid_file);
  CHECK(patched("/meshes/0/primitives/0/attributes/NORMAL", 99) == Status::invalid_file);
  CHECK(patched("/meshes/0/primitives/0/indices", "x") == Status::invalid_file);
  CHECK(patched("/scene", 3) == Status::invalid_file);
  CHECK(patched("/asset/version", "1.0") == Status::unsupported);
  CHECK(patched("/extensionsRequired", {"VENDOR_secret"}) == Status::unsupported);
  CHECK(patched("/meshes/0/primitives/0/mode", 0) == Status::invalid_mesh);
  CHECK(patched("/nodes/0/scale", {1e30, 1e30, 1e30}) == Status::ok);
  CHECK(patched("/nodes/0/scale", {1e300, 1e300, 1e300}) == Status::invalid_mesh);  // no float holds it
  CHECK(patched("/nodes/0/matrix", {1e300, 0, 0, 0, 0, 1e300, 0, 0, 0, 0, 1e300, 0, 1e308, 0, 0, 1}) ==
        Status::invalid_mesh);
  CHECK(changed([](GltfBuilder& file) {
          const float nan = std::numeric_limits<float>::quiet_NaN();
          std::memcpy(file.bin.data() + 4, &nan, sizeof nan);
        }) == Status::invalid_mesh);
  CHECK(changed([](GltfBuilder& file) { file.bin[48 + 6] = std::byte(4); }) == Status::invalid_mesh);
  CHECK(status_of(good.glb(), {.limits = {.vertices = 3}}) == Status::unsupported);
  CHECK(status_of(good.glb(), {.limits = {.triangles = 3}}) == Status::unsupported);
  CHECK(status_of(good.glb(), {.limits = {.json_bytes = 100}}) == Status::unsupported);
}

TEST_CASE("Draco is named, with the way out") {
  GltfBuilder file = tetrahedron();
  file.root["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  try {
    read_gltf_memory(file.glb());
    CHECK(false);
  } catch (const Error& error) {
    CHECK(error.status() == Status::unsupported);
    CHECK(error.hint().find("decompress") != std::string::npos);
  }
  file.root.erase("extensionsRequired");
  file.root["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", 0}};
  CHECK(status_of(file.glb()) == Status::ok);  // plain accessors beside it are used
  file.root["accessors"][0].erase("bufferView");
  CHECK(status_of(file.glb()) == Status::unsupported);
}

TEST_CASE("a chain of 200,000 nodes, and as many siblings, are read without recursion or delay") {
  for (const bool chain : {true, false}) {
    std::string nodes, children;
    const int count = 200'000;
    for (int i = 0; i < count; ++i) {
      nodes += i ? "," : "";
      if (chain)
        nodes += i + 1 < count ? R"({"children":[)" + std::to_string(i + 1) + "]}" : R"({"mesh":0})";
      else
        nodes += R"({"mesh":0})", children += (i ? "," : "") + std::to_string(i);
    }
    const std::string text =
        R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[)" + (chain ? "0" : children) +
        R"(]}],"nodes":[)" + nodes +
        R"(],"accessors":[{"componentType":5126,"type":"VEC3","count":3}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}]})";
    CHECK(read_gltf_memory(bytes_of(text)).mesh.vertex_count() == (chain ? 3 : 3 * count));
  }
}

TEST_CASE("the rigged characters have the counts their index says") {
  const auto folder = evaluation_set("rigs");
  if (!folder) return;
  const json index = read_json(*folder / "set.json");
  for (const json& file : index["files"]) {
    CAPTURE(file["mesh"]);
    const GltfMesh mesh = read_gltf(*folder / file["mesh"].get<std::string>());
    CHECK(mesh.mesh.vertex_count() == file["vertices"]);
    CHECK(mesh.mesh.triangle_count() == file["triangles"]);
    CHECK(mesh.primitives.size() == file["primitives"]);
    CHECK(mesh.mesh.positions.allFinite());
  }
}

TEST_CASE("a plain mesh comes as the trusting test reader sees it") {
  const auto folder = evaluation_set("hand");
  if (!folder) return;
  for (const auto& entry : std::filesystem::directory_iterator(*folder)) {
    if (entry.path().extension() != ".glb") continue;
    const GltfMesh mesh = read_gltf(entry.path());
    const TriangleMesh plain = read_evaluation_mesh(entry.path());
    CHECK(mesh.mesh.positions == plain.positions);
    CHECK(mesh.mesh.triangles == plain.triangles);
  }
}
