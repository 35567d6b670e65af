// What the forest knows of a sample, row by row.
#include "landmarks/features.h"

#include <doctest/doctest.h>

#include "descriptors/bulge.h"
#include "descriptors/descriptor.h"
#include "surfaces.h"

using namespace focal;
using namespace focal_test;

namespace {

SurfaceAnalysis analysed(TriangleMesh mesh) {
  return analyse_surface(std::make_shared<PreparedMesh>(prepare(std::move(mesh))),
                         {.eigenpair_count = 30, .sampling_rate = 0.1, .seed = 3}, {});
}

TrainParams with(bool bulge, bool oriented) {
  TrainParams params;
  params.bulge = bulge, params.oriented = oriented;
  return params;
}

}  // namespace

TEST_CASE("features: as many as model files have room for, those of preset paper are the signature") {
  for (size_t d = 0; d < descriptor_kinds().size(); ++d) {
    TrainParams params = with(true, true);
    params.descriptor = static_cast<int32_t>(d);
    CHECK(feature_count(params) <= max_components);
    params.preset = Preset::paper;
    CHECK(feature_count(params) == descriptor_kinds()[d].dimension);
  }
}

TEST_CASE("features: the signature, how the surface bulges, where the sample lies and faces") {
  const SurfaceAnalysis analysis = analysed(with_radius(sphere(3), lump));
  const int32_t count = 20;
  for (const bool bulge : {false, true})
    for (const bool oriented : {false, true}) {
      const TrainParams params = with(bulge, oriented);
      const RowMatrixf features = features_of(analysis, count, params, Matrix3::Identity());
      REQUIRE(features.rows() == count);
      REQUIRE(features.cols() == feature_count(params));
      CHECK(features.allFinite());
      const Eigen::Index signature = analysis.descriptors.cols();
      CHECK(features.leftCols(signature) == analysis.descriptors.topRows(count));
      const auto radii = static_cast<Eigen::Index>(bulge_radii.size());
      for (int32_t s = 0; s < count; ++s) {
        const int32_t v = analysis.samples[s];
        if (bulge) CHECK(features.row(s).segment(signature, radii) == analysis.bulge.row(v));
        if (oriented) {
          CHECK((features.row(s).tail(3) - analysis.normals.row(v).cast<float>()).norm() < 1e-5F);
          // All places are given from one centre.
          const auto place = [&](int32_t i) { return features.row(i).tail(6).head(3).eval(); };
          const auto at = [&](int32_t i) -> Eigen::RowVector3f {
            return analysis.surface().positions.row(analysis.samples[i]).cast<float>();
          };
          CHECK((place(s) - place(0) - (at(s) - at(0))).norm() < 1e-5F);
        }
      }
    }
}

TEST_CASE("features: a body that is turned has the same in its own frame, and others in that of the file") {
  TriangleMesh mesh = with_radius(sphere(3), lump);
  const SurfaceAnalysis before = analysed(mesh);
  Random random(8);
  const Matrix3 turn = random_rotation(random);
  mesh.positions = ((5 * mesh.positions * turn.transpose()).rowwise() + Eigen::RowVector3d(1, 2, 3)).eval();
  const SurfaceAnalysis after = analysed(mesh);
  REQUIRE(after.samples == before.samples);
  const TrainParams params = with(false, true);
  const RowMatrixf own = features_of(before, 20, params, Matrix3::Identity());
  CHECK((features_of(after, 20, params, turn.transpose()) - own).rightCols(18).cwiseAbs().maxCoeff() < 1e-4F);
  CHECK((features_of(after, 20, params, Matrix3::Identity()) - own).rightCols(18).cwiseAbs().maxCoeff() >
        0.1F);
}

TEST_CASE("features: what is said of a point's height does not change with a turn about the up axis") {
  const SurfaceAnalysis analysis = analysed(with_radius(sphere(3), lump));
  const TrainParams params = with(true, true);
  const RowMatrixf placed = placed_features(analysis, first_samples(analysis, 20).vertices);
  const auto turned_about = [&](const Vector3& axis) -> RowMatrixf {
    const Eigen::Matrix3f turn = Eigen::AngleAxisd(0.7, axis).toRotationMatrix().cast<float>().transpose();
    RowMatrixf result(placed.rows(), placed.cols());
    result << placed.leftCols(3) * turn, placed.rightCols(3) * turn;
    return result;
  };
  const RowMatrixf upright = upright_features(analysis, first_samples(analysis, 20), placed);
  CHECK(upright.cols() == upright_feature_count(params));
  CHECK(upright_feature_count(params) <= max_components);
  CHECK(upright.leftCols(invariant_feature_count(params)) ==
        invariant_features(analysis, first_samples(analysis, 20)));
  CHECK((upright_features(analysis, first_samples(analysis, 20), turned_about({0, 1, 0})) - upright)
            .cwiseAbs()
            .maxCoeff() < 1e-5F);
  CHECK((upright_features(analysis, first_samples(analysis, 20), turned_about({1, 0, 0})) - upright)
            .cwiseAbs()
            .maxCoeff() > 0.1F);
}
