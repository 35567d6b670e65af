// Weights of a known tube and of a sample humanoid: what is far is dropped, parts stay rigid, seams stay closed.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "skeleton/leak_filter.h"
#include "skeleton/part_weights.h"
#include "skeleton/rig_transfer.h"
#include "skeleton/small_rig.h"

using namespace focal;
using namespace focal_test;

namespace {

constexpr int around = 12, rings = 21;

// An open tube of radius 0.1 from y = low to high, moved sideways; behind what the mesh has.
void add_tube(TriangleMesh& mesh, double low, double high, double radius = 0.1, double sideways = 0) {
  const auto first = static_cast<int32_t>(mesh.positions.rows()),
             before = static_cast<int32_t>(mesh.triangles.rows());
  mesh.positions.conservativeResize(first + around * rings, 3);
  mesh.triangles.conservativeResize(before + 2 * around * (rings - 1), 3);
  int32_t t = before;
  for (int r = 0; r < rings; ++r)
    for (int a = 0; a < around; ++a) {
      const double angle = 2 * std::numbers::pi * a / around;
      mesh.positions.row(first + r * around + a) << sideways + radius * std::cos(angle),
          low + (high - low) * r / (rings - 1), -radius * std::sin(angle);
      if (r == 0) continue;
      const int32_t here = first + r * around + a, next = first + r * around + (a + 1) % around;
      mesh.triangles.row(t++) << here - around, next - around, here;
      mesh.triangles.row(t++) << next - around, next, here;
    }
}

SurfaceAnalysis analysis_of(TriangleMesh mesh) {
  const auto prepared =
      std::make_shared<const PreparedMesh>(prepare(std::move(mesh), {.analysed = AnalysedSurface::as_it_is}));
  SurfaceAnalysis analysis;
  analysis.proxy = {prepared, prepared};
  analysis.operators = make_operators(prepared->surface, bridges_of(*prepared), true);
  return analysis;
}

const std::vector<SkeletonJoint> chain = {{"lower", -1}, {"middle", 0}, {"upper", 1}};

// A chain of three bones of a third each along the tube, in the coordinates of the surface.
PlacedSkeleton chain_in(const SurfaceAnalysis& analysis) {
  PlacedSkeleton skeleton{chain, {}, {}, std::vector<Matrix3>(3, Matrix3::Identity())};
  const PreparedMesh& mesh = *analysis.proxy.full;
  for (int j = 0; j < 3; ++j) {
    skeleton.place.push_back((Vector3(0, j / 3.0, 0) - mesh.centre) / mesh.scale);
    skeleton.tip.push_back((Vector3(0, (j + 1) / 3.0, 0) - mesh.centre) / mesh.scale);
  }
  return skeleton;
}

double height_of(const SurfaceAnalysis& analysis, Eigen::Index v) {
  const PreparedMesh& mesh = *analysis.proxy.full;
  return mesh.centre[1] + mesh.scale * mesh.surface.positions(v, 1);
}

// The joint of the third that a vertex lies in.
RowMatrixf thirds(const SurfaceAnalysis& analysis) {
  RowMatrixf weights = RowMatrixf::Zero(analysis.surface().vertex_count(), 3);
  for (Eigen::Index v = 0; v < weights.rows(); ++v)
    weights(v, std::clamp(static_cast<int>(3 * height_of(analysis, v)), 0, 2)) = 1;
  return weights;
}

float weight_of(const VertexInfluences& influences, int32_t joint) {
  float sum = 0;
  for (const Influence& one : influences) sum += one.joint == joint ? one.weight : 0;
  return sum;
}

Rig by_parts(const RowMatrixf& weights, const SurfaceAnalysis& analysis, int32_t most = 4) {
  Rig rig;
  put_influences_by_parts({weights, 1}, chain_in(analysis), analysis, most, rig, execution);
  return rig;
}

}  // namespace

TEST_CASE("weights of a far joint are dropped, and a vertex left without any takes the nearest bone's") {
  TriangleMesh mesh;
  add_tube(mesh, 0, 1);
  const SurfaceAnalysis analysis = analysis_of(std::move(mesh));
  const PlacedSkeleton skeleton = chain_in(analysis);
  const RowMatrixf clean = thirds(analysis);
  RowMatrixf weights = clean;
  for (Eigen::Index v = 0; v < 3 * around; ++v)
    weights.row(v) << 0.3F, 0, 0.7F;  // an island of the upper joint
  weights.row(around) << 0, 0, 1;
  const WeightHabits habits{std::vector<float>(3, 0.5F), RowMatrixf::Constant(3, 3, 1)};
  drop_leaks(weights, analysis, skeleton, habits);
  CHECK((weights - clean).cwiseAbs().maxCoeff() < 1e-6);
}

TEST_CASE("joints that no training shape has together do not move one vertex") {
  TriangleMesh mesh;
  add_tube(mesh, 0, 1);
  const SurfaceAnalysis analysis = analysis_of(std::move(mesh));
  RowMatrixf weights = thirds(analysis);
  const Eigen::Index middle = rings / 2 * around;
  weights.row(middle) << 0.2F, 0.6F, 0.2F;
  RowMatrixf together = RowMatrixf::Constant(3, 3, 1);
  together(1, 2) = together(2, 1) = 0;
  drop_leaks(weights, analysis, chain_in(analysis), {std::vector<float>(3, 2.0F), together});
  CHECK(weights(middle, 0) == doctest::Approx(0.25));
  CHECK(weights(middle, 1) == doctest::Approx(0.75));
  CHECK(weights(middle, 2) == 0);
}

TEST_CASE(
    "a small separate part that rides on a bone is rigid, one round a joint bends, the body stays as it is") {
  TriangleMesh mesh;
  add_tube(mesh, 0, 1);
  add_tube(mesh, 0.45, 0.55, 0.03, 0.15);  // beside the middle of the middle bone
  add_tube(mesh, 0.28, 0.40, 0.105);       // a cuff round the middle joint
  const SurfaceAnalysis analysis = analysis_of(std::move(mesh));
  RowMatrixf weights = thirds(analysis);
  for (Eigen::Index v = around * rings; v < 2 * around * rings; ++v)
    weights.row(v) << 0, v % 2 ? 1.0F : 0.6F, v % 2 ? 0.0F : 0.4F;
  const Rig rig = by_parts(weights, analysis);
  const int32_t n = around * rings;
  for (int32_t v = 0; v < 3 * n; ++v) {
    const bool is_plate = v >= n && v < 2 * n;
    for (int32_t j = 0; j < 3; ++j)
      CHECK(weight_of(rig.influences[v], j) ==
            doctest::Approx(is_plate ? float(j == 1) : weights(analysis.proxy.full->surface_vertex[v], j)));
  }
}

TEST_CASE("parts that touch have the same weights at their seam") {
  TriangleMesh mesh;
  add_tube(mesh, 0, 0.5);
  add_tube(mesh, 0.5 + 3e-4, 1);  // nearer, and they were one part
  const SurfaceAnalysis analysis = analysis_of(std::move(mesh));
  RowMatrixf weights = RowMatrixf::Zero(analysis.surface().vertex_count(), 3);
  const int32_t n = around * rings;
  for (int32_t v = 0; v < 2 * n; ++v) weights.row(v) << 0.5F, v < n ? 0.5F : 0.1F, v < n ? 0.0F : 0.4F;
  const Rig rig = by_parts(weights, analysis);
  for (int a = 0; a < around; ++a)
    for (int32_t j = 0; j < 3; ++j)
      CHECK(weight_of(rig.influences[(rings - 1) * around + a], j) ==
            doctest::Approx(weight_of(rig.influences[n + a], j)));
  CHECK(weight_of(rig.influences[0], 2) == 0);  // away from the seam nothing changes
}

TEST_CASE("as many influences as asked for, the heaviest first, of sum 1") {
  Eigen::RowVectorXf weights(10);
  for (int j = 0; j < 10; ++j) weights[j] = static_cast<float>(1 + j);
  for (const int32_t most : {1, 3, 4, 6, 8}) {
    Rig rig;
    clear_influences(1, most, rig);
    put_influences(weights, most, 0, rig);
    CHECK(rig.more.size() == (most > 4 ? 1 : 0));
    std::vector<Influence> all(rig.influences[0].begin(), rig.influences[0].end());
    if (!rig.more.empty()) all.insert(all.end(), rig.more[0].begin(), rig.more[0].end());
    float sum = 0;
    for (int32_t i = 0; i < static_cast<int32_t>(all.size()); ++i) {
      sum += all[i].weight;
      CHECK((all[i].weight > 0) == (i < most));
      if (i < most) CHECK(all[i].joint == 9 - i);
    }
    CHECK(sum == doctest::Approx(1));
  }
}

TEST_CASE("sharpened weights keep their order and their sum") {
  Eigen::RowVectorXf weights(3), once(3);
  weights << 0.2F, 0.5F, 0.3F;
  once = weights;
  sharpen(once, 1);
  CHECK((once - weights).norm() < 1e-6);
  sharpen(weights, 2);
  CHECK(weights[1] == doctest::Approx(0.25 / 0.38));
  sharpen(weights, 100);
  CHECK(weights[1] == doctest::Approx(1));
}

TEST_CASE("no vertex of another humanoid follows a far joint") {
  const creatures::Character other = humanoid(12);
  const auto mesh = mesh_of(other.posed, other);
  const CharacterRig found = transfer_rig(detect(rig_model(), mesh, {}, execution), execution, false, 8);
  PlacedSkeleton skeleton{rig_model()->skeleton, {}, found.tip, {}};
  for (const Joint& joint : found.rig.joints) skeleton.place.push_back(joint.bind.topRightCorner<3, 1>());
  const RowMatrixf distance = bone_distances(skeleton, mesh->source.positions);
  const double height = mesh->source.positions.col(1).maxCoeff() - mesh->source.positions.col(1).minCoeff();
  int far = 0;
  for (size_t v = 0; v < found.rig.influences.size(); ++v) {
    const float nearest = distance.row(static_cast<Eigen::Index>(v)).minCoeff();
    float sum = 0;
    bool is_far = false;
    for (const auto* set : {&found.rig.influences[v], &found.rig.more[v]})
      for (const Influence& one : *set) {
        sum += one.weight;
        const float away = distance(static_cast<Eigen::Index>(v), one.joint);
        is_far |= one.weight > 0.1F && away > 0.15 * height && away > 2 * nearest;
      }
    CHECK(sum == doctest::Approx(1).epsilon(1e-5));
    far += is_far;
  }
  CHECK(far <= 0.005 * static_cast<double>(found.rig.influences.size()));
}
