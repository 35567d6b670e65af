// Where the bytes come from: data URIs, names of files, compressed views; each bound of theirs exactly.
#include "gltf/buffers.h"

#include <doctest/doctest.h>
#include <meshoptimizer.h>

#include <Eigen/Geometry>
#include <string>

#include "gltf/gltf_builder.h"
#include "gltf/text.h"

using namespace focal;
using namespace focal_test;

namespace {

// A file whose views are compressed: their data lies in buffer 0, buffer 1 is what stands in for it.
struct Compressed {
  GltfBuilder file;

  Compressed() {
    file.root["extensionsRequired"] = {"EXT_meshopt_compression"};
    file.root["buffers"] = {{{"byteLength", 0}}, {{"byteLength", 100'000}}};
  }
  int add(const std::vector<uint8_t>& data, const char* mode, size_t count, size_t stride,
          const char* filter = nullptr) {
    const int view = file.add_view(data);
    json& element = file.root["bufferViews"][static_cast<size_t>(view)];
    json& extension = element["extensions"]["EXT_meshopt_compression"];
    extension = element;
    extension.erase("extensions");
    extension["mode"] = mode, extension["count"] = count, extension["byteStride"] = stride;
    if (filter) extension["filter"] = filter;
    element["buffer"] = 1, element["byteOffset"] = 0, element["byteLength"] = count * stride;
    return view;
  }
  template <class T>
  int add_vertices(const std::vector<T>& entries, size_t stride, const char* filter = nullptr) {
    const size_t count = entries.size() * sizeof(T) / stride;
    std::vector<uint8_t> packed(meshopt_encodeVertexBufferBound(count, stride));
    packed.resize(meshopt_encodeVertexBuffer(packed.data(), packed.size(), entries.data(), count, stride));
    return add(packed, "ATTRIBUTES", count, stride, filter);
  }
  // Positions of that view, every three a triangle.
  void show(int view, int component_type, size_t count, size_t stride = 0) {
    if (stride) file.root["bufferViews"][static_cast<size_t>(view)]["byteStride"] = stride;
    file.add_mesh(file.add("accessors", {{"bufferView", view},
                                         {"componentType", component_type},
                                         {"normalized", component_type != 5126},
                                         {"type", "VEC3"},
                                         {"count", count}}));
  }
  json& extension() { return file.root["bufferViews"][0]["extensions"]["EXT_meshopt_compression"]; }
  std::vector<std::byte> glb() {
    file.root["buffers"][0]["byteLength"] = file.bin.size();
    return glb_bytes(file.root.dump(), bin_chunk(file.bin));
  }
};

std::vector<float> grid() {  // of 10 x 10
  std::vector<float> points;
  for (int i = 0; i < 100; ++i)
    for (const float value : {float(i % 10), float(i / 10), 0.5f * float(i)}) points.push_back(value);
  return points;
}

Compressed compressed_grid() {
  Compressed file;
  std::vector<uint32_t> faces;
  for (uint32_t i = 0; i < 90; ++i)
    if (i % 10 != 9)
      for (const uint32_t corner : {i, i + 1, i + 10}) faces.push_back(corner);
  std::vector<uint8_t> packed(meshopt_encodeIndexBufferBound(faces.size(), 100));
  packed.resize(meshopt_encodeIndexBuffer(packed.data(), packed.size(), faces.data(), faces.size()));
  file.show(file.add_vertices(grid(), 12), 5126, 100);
  const int indices = file.add(packed, "TRIANGLES", faces.size(), 4);
  file.file.root["meshes"][0]["primitives"][0]["indices"] = file.file.add(
      "accessors",
      {{"bufferView", indices}, {"componentType", 5125}, {"type", "SCALAR"}, {"count", faces.size()}});
  return file;
}

void check_error(const std::string& error, const char* part) {
  CAPTURE(error);
  CHECK(error.find(part) != std::string::npos);
}

std::string data_uri(std::span<const std::byte> bytes) {
  return "data:application/octet-stream;base64," + base64(bytes);
}

}  // namespace

TEST_CASE("EXT_meshopt_compression is decoded") {
  const GltfMesh mesh = read_gltf_memory(compressed_grid().glb());
  CHECK(Vector3(mesh.mesh.positions.row(57)) == Vector3(7, 5, 28.5));
  REQUIRE(mesh.mesh.triangle_count() == 81);
  for (int32_t t = 0; t < 81; ++t) {  // the codec may turn a triangle's corners
    const auto row = mesh.mesh.triangles.row(t);
    CHECK(row.minCoeff() == t + t / 9);
    CHECK(row.sum() == 3 * (t + t / 9) + 11);
  }
}

TEST_CASE("a list of indices that is no list of triangles is decoded as a sequence") {
  const std::vector<uint32_t> strip = {7, 0, 3, 2, 9};
  std::vector<uint8_t> packed(meshopt_encodeIndexSequenceBound(5, 10));
  packed.resize(meshopt_encodeIndexSequence(packed.data(), packed.size(), strip.data(), 5));
  Compressed file = compressed_grid();
  const int view = file.add(packed, "INDICES", 5, 2);
  file.file.add("accessors",
                {{"bufferView", view}, {"componentType", 5123}, {"type", "SCALAR"}, {"count", 5}});
  json& primitive = file.file.root["meshes"][0]["primitives"][0];
  primitive["indices"] = 2, primitive["mode"] = 5;
  const TriangleMesh mesh = read_gltf_memory(file.glb()).mesh;
  CHECK(mesh.triangles == MatrixX3i{{7, 0, 3}, {0, 2, 3}, {3, 2, 9}});
}

TEST_CASE("the filters of compressed views give back unit vectors, rotations and numbers") {
  std::vector<float> unit, turns;
  for (int i = 0; i < 6; ++i) {
    const Vector3 axis = Vector3(i - 2.2, 0.7 * i - 1, 1.5 - 0.4 * i).normalized();
    for (const double x : {axis.x(), axis.y(), axis.z(), 0.0}) unit.push_back(static_cast<float>(x));
    const Eigen::Quaterniond q(
        Eigen::AngleAxisd(0.3 + 0.2 * i, axis));  // w is the largest: it stays positive
    for (const double x : q.coeffs()) turns.push_back(static_cast<float>(x));
  }
  const auto positions = [](const std::vector<float>& values, int type, size_t stride, const char* filter,
                            auto encode) {
    std::vector<uint8_t> encoded(6 * stride);
    encode(encoded.data(), values);
    Compressed file;
    file.show(file.add_vertices(encoded, stride, filter), type, 6, stride);
    return read_gltf_memory(file.glb()).mesh.positions;
  };
  const auto expected = [](const std::vector<float>& values, int width) {
    return MatrixX3(Eigen::Map<const RowMatrixf>(values.data(), 6, width).leftCols(3).cast<double>());
  };
  const auto oct = [](int stride) {
    return [stride](uint8_t* out, const std::vector<float>& in) {
      meshopt_encodeFilterOct(out, 6, static_cast<size_t>(stride), stride * 2, in.data());
    };
  };
  CHECK((positions(unit, 5120, 4, "OCTAHEDRAL", oct(4)) - expected(unit, 4)).cwiseAbs().maxCoeff() < 0.02);
  CHECK((positions(unit, 5122, 8, "OCTAHEDRAL", oct(8)) - expected(unit, 4)).cwiseAbs().maxCoeff() < 1e-4);
  CHECK((positions(turns, 5122, 8, "QUATERNION",
                   [](uint8_t* out, const auto& in) { meshopt_encodeFilterQuat(out, 6, 8, 16, in.data()); }) -
         expected(turns, 4))
            .cwiseAbs()
            .maxCoeff() < 1e-4);
  std::vector<float> numbers = grid();
  numbers.resize(18);
  CHECK((positions(numbers, 5126, 12, "EXPONENTIAL",
                   [](uint8_t* out, const auto& in) { meshopt_encodeFilterExp(out, 6, 12, 15, in.data()); }) -
         expected(numbers, 3))
            .cwiseAbs()
            .maxCoeff() < 1e-3);
}

TEST_CASE("a compressed view announces what it can hold") {
  struct Change {
    size_t count, stride;
    const char* message;
  };
  for (const Change& change :
       {Change{1200, 0, "byteStride is 0, outside 1 to 256"}, Change{1200, 1, "cannot be decoded"},
        Change{100, 256, "cannot be decoded"}, Change{100, 257, "byteStride is 257, outside 1 to 256"},
        Change{0, 12, "count is 0, outside 1"},
        Change{1, 12, "accessors[0].count is 100, reaching beyond"}}) {
    Compressed file = compressed_grid();
    file.extension()["count"] = change.count, file.extension()["byteStride"] = change.stride;
    file.file.root["bufferViews"][0]["byteLength"] = std::max<size_t>(1, change.count * change.stride);
    check_error(error_of(file.glb()), change.message);
  }
  Compressed file = compressed_grid();
  file.file.root["bufferViews"][0]["byteLength"] = 1201;
  check_error(error_of(file.glb()), "decodes to another length than the view has");
  for (const size_t count : {256, 257}) {  // 1024 bytes from one, and more than that
    file.extension()["byteLength"] = 3, file.extension()["count"] = count;
    file.file.root["bufferViews"][0]["byteLength"] = 12 * count;
    check_error(error_of(file.glb()),
                count == 256 ? "cannot be decoded" : "announces more data than it can hold");
  }
}

TEST_CASE("modes and filters that do not suit the view are refused") {
  const auto error_with = [](size_t view, const char* key, const json& value) {
    Compressed file = compressed_grid();
    file.file.root["bufferViews"][view]["extensions"]["EXT_meshopt_compression"][key] = value;
    return error_of(file.glb());
  };
  CHECK(error_with(0, "filter", "NONE") == "");
  for (const char* mode : {"TRIANGLES", "INDICES", "SOMETHING"})
    check_error(error_with(0, "mode", mode), "cannot be decoded");
  for (const char* filter : {"OCTAHEDRAL", "QUATERNION", "SOMETHING"})
    check_error(error_with(0, "filter", filter), "cannot be decoded");
  check_error(error_with(1, "mode", "ATTRIBUTES"), "cannot be decoded");
  check_error(error_with(1, "mode", nullptr), "mode is not a string");
  Compressed file = compressed_grid();
  file.extension().erase("mode");
  check_error(error_of(file.glb()), "cannot be decoded");
  file = compressed_grid();
  file.extension()["byteLength"] = 50;  // cut
  check_error(error_of(file.glb()), "cannot be decoded");
}

TEST_CASE("what is decoded has a limit in all, exactly") {
  const auto bytes = compressed_grid().glb();
  CHECK(error_of(bytes, {.decoded_bytes = 1200 + 243 * 4}) == "");
  check_error(error_of(bytes, {.decoded_bytes = 1200 + 243 * 4 - 1}), "after decoding");
  const GltfBuilder file = tetrahedron();
  const std::string uri = data_uri(file.bin);
  const auto size = static_cast<int64_t>(uri.size() / 4 * 3);
  CHECK(error_of(file.gltf(uri), {.decoded_bytes = size}) == "");
  check_error(error_of(file.gltf(uri), {.decoded_bytes = size - 1}), "after decoding");
}

TEST_CASE("a URI is data or the name of a file") {
  const GltfBuilder file = tetrahedron();
  for (const char* uri : {"", "a%00b", "C:/a.bin", "C:\\a.bin", "http://x/a.bin"}) {
    CAPTURE(uri);
    check_error(error_of(file.gltf(uri)), "is neither data nor the name of a file beside this one");
  }
  check_error(error_of(file.gltf("a%20b.bin")), "lies in another file, 'a b.bin'");
  check_error(error_of(file.gltf("10% a%2.bin")), "lies in another file, '10% a%2.bin'");
  check_error(error_of(file.gltf("b\\a.bin")), "lies in another file, 'b/a.bin'");
  check_error(error_of(file.gltf("data:;base64,!!!!")), "is not a well-formed base64 data URI");
  check_error(error_of(file.gltf("data:;base64,AAAA")), "is 72, but the buffer has 3 bytes");
}
