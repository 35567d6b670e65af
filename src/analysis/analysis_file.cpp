#include "analysis/analysis_file.h"

#include <limits>

#include "base/archive.h"
#include "base/crc32c.h"
#include "descriptors/descriptor.h"
#include "model/method_section.h"

namespace focal {
namespace {

constexpr ArchiveKind kind{"FOCALANA", "analysis", 1, 2};
constexpr const char* described_section = "DSCR";
constexpr int32_t most = std::numeric_limits<int32_t>::max();
constexpr double farthest = 1e9;  // coordinates of a surface of area 1

uint32_t checksum(const TriangleMesh& mesh) {
  const auto bytes = [](const auto& matrix) {
    return std::as_bytes(std::span(matrix.data(), matrix.size()));
  };
  return crc32c(bytes(mesh.triangles), crc32c(bytes(mesh.positions)));
}

std::vector<std::byte> info_section(const SurfaceAnalysis& analysis) {
  ByteWriter out;
  out.u32(checksum(analysis.proxy.full->surface));
  out.i32(analysis.params.proxy_vertices);
  out.i32(analysis.params.eigenpair_count);
  out.u8(analysis.params.paper_exact);
  out.i32(analysis.proxy.filled_holes);
  return out.take();
}

// Stores the proxy itself: decimating again could differ by a rounding error on another machine.
std::vector<std::byte> proxy_section(const Proxy& proxy) {
  ByteWriter out;
  const bool own = !proxy.is_full();
  const TriangleMesh& mesh = proxy.coarse->source;
  out.u32(own ? static_cast<uint32_t>(mesh.vertex_count()) : 0);
  out.u32(own ? static_cast<uint32_t>(mesh.triangle_count()) : 0);
  for (Eigen::Index i = 0; own && i < mesh.positions.size(); ++i) out.f64(mesh.positions.data()[i]);
  for (Eigen::Index i = 0; own && i < mesh.triangles.size(); ++i) out.i32(mesh.triangles.data()[i]);
  return out.take();
}

Proxy read_proxy(ByteReader in, std::shared_ptr<const PreparedMesh> full) {
  TriangleMesh mesh;
  const int32_t vertices = in.count("vertex count", 3 * 64), triangles = in.count("triangle count", 3 * 32);
  mesh.positions.resize(vertices, 3), mesh.triangles.resize(triangles, 3);
  for (Eigen::Index i = 0; i < mesh.positions.size(); ++i)
    mesh.positions.data()[i] = in.f64("position", -farthest, farthest);
  for (Eigen::Index i = 0; i < mesh.triangles.size(); ++i)
    mesh.triangles.data()[i] = in.i32("corner", 0, vertices - 1);
  in.expect_end();
  if (vertices == 0) return {full, full};
  return {full,
          std::make_shared<const PreparedMesh>(
              prepare(std::move(mesh), {.analysed = AnalysedSurface::as_it_is, .repair_orientation = false})),
          0};
}

void write_described(ByteWriter& out, const std::vector<int32_t>& vertices, const RowMatrixf& descriptors) {
  out.u32(static_cast<uint32_t>(vertices.size()));
  for (const int32_t v : vertices) out.i32(v);
  out.f32s({descriptors.data(), static_cast<size_t>(descriptors.size())});
}

std::vector<std::byte> samples_section(const SurfaceAnalysis& analysis) {
  ByteWriter out;
  write_described(out, analysis.samples, analysis.descriptors);
  out.u8(!analysis.distances.steps.empty());
  for (const uint16_t step : analysis.distances.steps) out.u16(step);
  return out.take();
}

// Vertices, and their descriptors.
void read_described(ByteReader& in, const char* what, const SurfaceAnalysis& analysis,
                    std::vector<int32_t>& vertices, RowMatrixf& descriptors) {
  const int32_t n = analysis.surface().vertex_count();
  const int32_t dimension = descriptor_kinds()[analysis.params.descriptor].dimension;
  const int32_t count =
      in.count((std::string(what) + " count").c_str(), 32 + 32 * static_cast<uint64_t>(dimension), 1, n);
  for (int32_t i = 0; i < count; ++i) vertices.push_back(in.i32(what, 0, n - 1));
  const auto values = in.f32s("descriptor", static_cast<size_t>(count) * dimension, -1e9F, 1e9F);
  descriptors = Eigen::Map<const RowMatrixf>(values.data(), count, dimension);
}

void read_samples(ByteReader in, SurfaceAnalysis& analysis) {
  read_described(in, "sample", analysis, analysis.samples, analysis.descriptors);
  const int32_t n = analysis.surface().vertex_count();
  if (in.u8("distances kept")) {
    constexpr int lanes = Distance::lanes;
    const size_t blocks = (analysis.samples.size() + lanes - 1) / lanes;
    const size_t entries = blocks * lanes * static_cast<size_t>(n);
    const auto bytes = in.raw("distances", 2 * entries);
    analysis.distances = {analysis.metric->distance_bound() / 65535, n, {}};
    analysis.distances.steps.resize(entries);
    for (size_t i = 0; i < entries; ++i)
      analysis.distances.steps[i] = static_cast<uint16_t>(std::to_integer<unsigned>(bytes[2 * i]) |
                                                          std::to_integer<unsigned>(bytes[2 * i + 1]) << 8);
  }
  in.expect_end();
}

std::vector<std::byte> eigenfunctions_section(const RowMatrixf& Phi) {
  ByteWriter out;
  out.u32(static_cast<uint32_t>(Phi.cols()));
  out.f32s({Phi.data(), static_cast<size_t>(Phi.size())});
  return out.take();
}

RowMatrixf read_eigenfunctions(ByteReader in, int32_t vertices) {
  const int32_t count = in.count("eigenfunction count", 32 * static_cast<uint64_t>(vertices), 1, vertices);
  const auto values = in.f32s("eigenfunction", static_cast<size_t>(vertices) * count, -1e9F, 1e9F);
  in.expect_end();
  return Eigen::Map<const RowMatrixf>(values.data(), vertices, count);
}

}  // namespace

std::vector<std::byte> serialise(const SurfaceAnalysis& analysis) {
  std::vector<ArchiveSection> sections = {{"INFO", info_section(analysis)},
                                          {"PRXY", proxy_section(analysis.proxy)},
                                          {"EIGN", eigenfunctions_section(analysis.eigenfunctions)},
                                          {"SMPL", samples_section(analysis)}};
  if (const DescribedVertices& spread = analysis.described; !spread.vertices.empty()) {
    ByteWriter out;
    write_described(out, spread.vertices, spread.descriptors);
    sections.push_back({described_section, out.take()});
  }
  if (const Method method{analysis.params.descriptor, analysis.params.distance}; !method.is_first())
    sections.push_back({method_section, write_method(method)});
  return write_archive(kind, sections);
}

SurfaceAnalysis parse_analysis(std::span<const std::byte> file, std::shared_ptr<const PreparedMesh> mesh,
                               const Execution& execution) {
  const Archive archive(kind, file);
  ByteReader info = archive.section("INFO");
  SurfaceAnalysis analysis;
  if (info.u32("checksum of the mesh") != checksum(mesh->surface))
    info.fail("the analysis is of another mesh");
  analysis.params.proxy_vertices = info.i32("proxy vertices", 0, most);
  analysis.params.eigenpair_count = info.i32("eigenpair count", 1, most);
  analysis.params.paper_exact = info.u8("to the letter") != 0;
  const int32_t filled_holes = info.i32("filled holes", 0, most);
  info.expect_end();
  const Method method = read_method(archive);
  analysis.params.descriptor = method.descriptor, analysis.params.distance = method.distance;
  analysis.proxy = read_proxy(archive.section("PRXY"), std::move(mesh));
  analysis.proxy.filled_holes = filled_holes;
  make_solvers(analysis, execution);
  describe_relief(analysis, execution);
  analysis.eigenfunctions = read_eigenfunctions(archive.section("EIGN"), analysis.surface().vertex_count());
  read_samples(archive.section("SMPL"), analysis);
  if (archive.has(described_section)) {  // since version 1.2
    ByteReader in = archive.section(described_section);
    read_described(in, "described vertex", analysis, analysis.described.vertices,
                   analysis.described.descriptors);
    in.expect_end();
  }
  return analysis;
}

}  // namespace focal
