// An analysis comes back from its bytes, for its own mesh alone; each bound of the file exactly.
#include "analysis/analysis_file.h"

#include <doctest/doctest.h>

#include "base/error.h"
#include "base/signed_archive.h"
#include "surfaces.h"

using namespace focal;
using focal_test::number_at, focal_test::patched;

namespace {

using Bytes = std::vector<std::byte>;

std::shared_ptr<const PreparedMesh> ball(double radius = 1) {
  TriangleMesh mesh = focal_test::sphere(3);
  mesh.positions.col(0) *= radius;
  return std::make_shared<const PreparedMesh>(prepare(std::move(mesh)));
}

SurfaceAnalysis analysed(int32_t proxy_vertices = 0, bool keep = true) {
  SurfaceAnalysis analysis = analyse_surface(ball(),
                                             {.proxy_vertices = proxy_vertices,
                                              .eigenpair_count = 12,
                                              .sampling_rate = 1,
                                              .max_samples = 40,
                                              .max_described = keep ? 100 : 0},
                                             {});
  if (keep) keep_distances(analysis, {});
  return analysis;
}

std::string error_of(const Bytes& file, std::shared_ptr<const PreparedMesh> mesh = ball()) {
  try {
    parse_analysis(file, std::move(mesh), {});
    return "";
  } catch (const Error& error) {
    CHECK(error.status() == Status::invalid_file);
    return error.what();
  }
}

void check_error(const std::string& error, const char* part) {
  CAPTURE(error);
  CHECK(error.find(part) != std::string::npos);
}

}  // namespace

TEST_CASE(
    "an analysis comes back from its bytes as it was, on a proxy and without, with distances and without") {
  for (const int32_t proxy_vertices : {0, 120})
    for (const bool keep : {false, true}) {
      const SurfaceAnalysis analysis = analysed(proxy_vertices, keep);
      const SurfaceAnalysis back = parse_analysis(serialise(analysis), ball(), {});
      CHECK(back.proxy.is_full() == (proxy_vertices == 0));
      CHECK(back.surface().positions == analysis.surface().positions);
      CHECK(back.surface().triangles == analysis.surface().triangles);
      CHECK(back.params.eigenpair_count == 12);
      CHECK(back.params.proxy_vertices == proxy_vertices);
      CHECK(back.samples == analysis.samples);
      CHECK(back.descriptors == analysis.descriptors);
      CHECK(back.described.vertices == analysis.described.vertices);
      CHECK(back.described.descriptors == analysis.described.descriptors);
      CHECK(back.described.vertices.empty() != keep);
      CHECK(back.eigenfunctions == analysis.eigenfunctions);
      CHECK(back.distances.steps == analysis.distances.steps);
      CHECK(back.distances.steps.empty() != keep);
    }
}

TEST_CASE("an analysis is of one mesh") {
  const Bytes file = serialise(analysed());
  CHECK(error_of(file) == "");
  check_error(error_of(file, ball(1.5)), "the analysis is of another mesh");
}

TEST_CASE("each number of an analysis has its bounds") {
  const Bytes file = serialise(analysed());
  constexpr auto minus_one = UINT32_MAX;
  CHECK(error_of(patched(file, "INFO", 4, 0)) == "");
  check_error(error_of(patched(file, "INFO", 4, minus_one)), "INFO: proxy vertices");
  CHECK(error_of(patched(file, "INFO", 8, 1)) == "");
  check_error(error_of(patched(file, "INFO", 8, 0)), "INFO: eigenpair count");
  CHECK(error_of(patched(file, "INFO", 13, 0)) == "");
  check_error(error_of(patched(file, "INFO", 13, minus_one)), "INFO: filled holes");
  for (const uint32_t vertex : {0, 257}) CHECK(error_of(patched(file, "SMPL", 4, vertex)) == "");
  check_error(error_of(patched(file, "SMPL", 4, 258)), "SMPL: sample is out of range");
  check_error(error_of(patched(file, "SMPL", 4, minus_one)), "SMPL: sample is out of range");
  check_error(error_of(patched(file, "SMPL", 0, 0)), "SMPL: sample count");
  check_error(error_of(patched(file, "SMPL", 0, 259)), "SMPL: sample count");
  CHECK(error_of(patched(file, "DSCR", 4, 257)) == "");
  check_error(error_of(patched(file, "DSCR", 4, 258)), "DSCR: described vertex is out of range");
  check_error(error_of(patched(file, "DSCR", 0, 0)), "DSCR: described vertex count");
  check_error(error_of(patched(file, "EIGN", 0, 0)), "EIGN: eigenfunction count");
  check_error(error_of(patched(file, "EIGN", 0, 13)), "EIGN: eigenfunction count is larger than the section");
  SurfaceAnalysis least = analysed(0, false);
  least.samples.resize(1), least.descriptors = least.descriptors.topRows(1).eval();
  least.eigenfunctions = least.eigenfunctions.leftCols(1).eval();
  CHECK(error_of(serialise(least)) == "");
}

TEST_CASE("the corners of a proxy are vertices of its own") {
  const Bytes file = serialise(analysed(120));
  size_t entry = 32;
  while (std::memcmp(&file.at(entry), "PRXY", 4) != 0) entry += 24;
  const auto vertices = static_cast<uint32_t>(number_at(file, number_at(file, entry + 8, 8), 4));
  REQUIRE(vertices > 50);
  const size_t first_corner = 8 + 24 * vertices;
  check_error(error_of(patched(file, "PRXY", first_corner, vertices)), "PRXY: corner is out of range");
  check_error(error_of(patched(file, "PRXY", first_corner, UINT32_MAX)), "PRXY: corner is out of range");
  check_error(error_of(patched(file, "PRXY", 0, UINT32_MAX)), "PRXY: vertex count");
  check_error(error_of(patched(file, "PRXY", 4, 1u << 30)),
              "PRXY: triangle count is larger than the section");
}
