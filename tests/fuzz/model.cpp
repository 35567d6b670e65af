// Any bytes as a model or as an analysis, as they are and with their checksums made right: refused, or as good as any other.
#include <algorithm>
#include <memory>

#include "analysis/analysis_file.h"
#include "base/error.h"
#include "base/signed_archive.h"
#include "fuzz.h"
#include "model/model_file.h"
#include "seeds.h"

using namespace focal;

namespace {

void check(const Error& error) {
  fuzz::insist(error.status() == Status::invalid_file || error.status() == Status::unsupported_version,
               "a damaged file is called so");
  fuzz::insist(!error.hint().empty(), "an error has a hint");
}

void read_model(std::span<const std::byte> file) {
  try {
    const LandmarkModel model = parse_model(file);
    const std::vector<float> descriptor(1000, 0.1F);
    for (const auto& forest : model.forests)
      for (const auto& tree : forest.trees) {
        const auto leaf = static_cast<size_t>(tree.leaf_of(descriptor.data()));
        fuzz::insist(leaf < (tree.leaf_mean.empty() ? tree.leaf_start.size() - 1 : tree.leaf_mean.size()),
                     "leaves exist");
        for (const int32_t sample : tree.leaf_samples)
          fuzz::insist(sample >= 0 && sample < model.targets.rows(), "samples exist");
      }
    parse_model(serialise(model));  // what was accepted is written as a file that is accepted
  } catch (const Error& error) {
    check(error);
  }
}

void read_analysis(std::span<const std::byte> file) {
  static const auto mesh = fuzz::small_mesh();
  try {
    const SurfaceAnalysis analysis = parse_analysis(file, mesh, {});
    for (const int32_t sample : analysis.samples)
      fuzz::insist(sample >= 0 && sample < analysis.surface().vertex_count(), "samples exist");
    fuzz::insist(analysis.descriptors.allFinite() && analysis.eigenfunctions.allFinite(),
                 "numbers are finite");
  } catch (const Error& error) {
    check(error);
  }
}

}  // namespace

int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const auto file = std::as_bytes(std::span(data, size));
  fuzz::Bytes made_right(file.begin(), file.end());
  focal_test::sign(made_right);
  read_model(file);
  read_model(made_right);
  read_analysis(made_right);
  return 0;
}
