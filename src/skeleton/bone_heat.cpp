#include "skeleton/bone_heat.h"

#include <algorithm>
#include <limits>

#include "base/error.h"
#include "linear/sparse_cholesky.h"

namespace focal {
namespace {

constexpr double heat_of_hidden = 1e-4;  // of the heat of a visible bone: used only where no bone is visible
constexpr double min_distance = 1e-3;    // in sqrt(area): a bone in the skin
constexpr double same_distance = 1.02;   // bones within this ratio of distances share a vertex

Vector3 nearest_on(const Bone& bone, const Vector3& p) {
  const Vector3 along = bone.to - bone.from;
  const double squared = along.squaredNorm();
  if (!(squared > 0)) return bone.from;
  return bone.from + std::clamp(along.dot(p - bone.from) / squared, 0.0, 1.0) * along;
}

// Whether the straight line from a vertex to a position stays inside.
bool sees(const RayCaster& rays, const Vector3& vertex, const Vector3& normal, const Vector3& place) {
  const Vector3 way = place - vertex;
  if (way.dot(normal) > 0) return false;
  constexpr double skin = 1e-6;
  return rays.first_hit(vertex - skin * normal, way, 1).triangle < 0;
}

struct Source {
  double heat = 0;              // of the paper's H, an inverse squared length
  std::vector<int32_t> joints;  // that share it
};

Source source_of(const RayCaster& rays, const Vector3& vertex, const Vector3& normal,
                 const std::vector<Bone>& bones, double hottest) {
  struct Candidate {
    double distance;
    const Bone* bone;
  };
  std::vector<Candidate> near;
  for (const Bone& bone : bones) near.push_back({(nearest_on(bone, vertex) - vertex).norm(), &bone});
  std::sort(near.begin(), near.end(), [](const auto& a, const auto& b) { return a.distance < b.distance; });
  // The nearest visible bone; bones farther than twice the nearest one belong to other limbs.
  const auto seen = std::find_if(near.begin(), near.end(), [&](const Candidate& one) {
    return one.distance < 2 * near[0].distance + min_distance &&
           sees(rays, vertex, normal, nearest_on(*one.bone, vertex));
  });
  const double strength = hottest * (seen == near.end() ? heat_of_hidden : 1);
  const double nearest = seen == near.end() ? near[0].distance : seen->distance;
  Source source;
  for (const Candidate& one : near) {
    if (one.distance < nearest || one.distance > same_distance * nearest) continue;
    if (std::find(source.joints.begin(), source.joints.end(), one.bone->joint) == source.joints.end())
      source.joints.push_back(one.bone->joint);
  }
  const double distance = std::max(nearest, min_distance);
  source.heat = strength / (distance * distance);
  return source;
}

}  // namespace

RowMatrixf bone_heat_weights(const SurfaceAnalysis& analysis, const RayCaster& rays,
                             const std::vector<Bone>& bones, int32_t joint_count, const Execution& execution,
                             double strength) {
  if (bones.empty()) throw Error(Status::invalid_argument, "the skeleton has no bones", "give it joints");
  const TriangleMesh& mesh = analysis.surface();
  const Eigen::Index n = mesh.vertex_count();
  const MatrixX3 normals = area_normals(mesh).rowwise().normalized();
  std::vector<Source> sources(static_cast<size_t>(n));
  parallel_for(execution, n, [&](int64_t v) {
    sources[v] =
        source_of(rays, mesh.positions.row(v).transpose(), normals.row(v).transpose(), bones, strength);
  });
  // (L + M H) w = M H p, the paper's -Laplacian w + H w = H p times the mass of each vertex.
  SparseMatrix A = analysis.operators.L;
  RowMatrix heat = RowMatrix::Zero(n, joint_count);
  for (Eigen::Index v = 0; v < n; ++v) {
    const double flow = analysis.operators.mass[v] * sources[v].heat;
    A.coeffRef(v, v) += flow;
    for (const int32_t joint : sources[v].joints)
      heat(v, joint) += flow / static_cast<double>(sources[v].joints.size());
  }
  const SparseCholesky factor(A);
  RowMatrixf weights(n, joint_count);
  parallel_for(execution, joint_count,
               [&](int64_t j) { weights.col(j) = factor.solve(heat.col(j)).cwiseMax(0).cast<float>(); });
  for (Eigen::Index v = 0; v < n; ++v) weights.row(v) /= weights.row(v).sum();
  return weights;
}

}  // namespace focal
