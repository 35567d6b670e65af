// focal_stages MESH.glb FOLDER VERTEX...: writes what each numerical stage gives on the mesh as it is (no
// repair, no proxy) into FOLDER: eigenvalues by both methods, SI-HKS of every vertex, heat distances from the
// given vertices.
#include <iostream>
#include <numeric>

#include "descriptors/si_hks.h"
#include "geodesics/heat_method.h"
#include "gltf/document.h"
#include "operators/operators.h"
#include "raw_numbers.h"
#include "spectrum/eigenbasis.h"

using namespace focal;
using focal_test::write_raw;

namespace {

void write_stages(const TriangleMesh& mesh, const std::filesystem::path& folder,
                  const std::vector<int32_t>& sources) {
  const Execution execution;
  const Operators operators = make_operators(mesh);
  EigenParams params;
  const Eigenbasis basis = eigenbasis(operators.L, operators.mass, params, execution);
  write_raw(folder / "eigenvalues_chebyshev", basis.lambda);
  params.method = EigenMethod::spectra;
  write_raw(folder / "eigenvalues_spectra",
            eigenbasis(operators.L, operators.mass, params, execution).lambda);

  std::vector<int32_t> all(mesh.vertex_count());
  std::iota(all.begin(), all.end(), 0);
  write_raw(folder / "si_hks", si_hks(basis, operators.area, all));

  const RowMatrix distances =
      HeatMethod(mesh, operators, execution, true).distances(sources, execution).cast<double>();
  write_raw(folder / "heat", distances);
  const auto exact = distance_kinds()[1].make({mesh, {}, operators}, execution);
  write_raw(folder / "own_exact",
            exact->distances(std::span(sources).first(2), execution).cast<double>().eval());
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 4) throw std::runtime_error("usage: focal_stages MESH.glb FOLDER VERTEX...");
  write_stages(GltfDocument::open(argv[1]).mesh().mesh, argv[2], focal_test::vertices_from(3, argc, argv));
  return 0;
} catch (const std::exception& error) {
  std::cerr << "focal_stages: " << error.what() << '\n';
  return 1;
}
