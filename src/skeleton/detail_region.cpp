#include "skeleton/detail_region.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

namespace focal {
namespace {

constexpr int32_t min_joints = 4;  // beyond the root; fewer are found equally well on the whole body
// Median length beyond the root, in sqrt(area): four edges of a proxy of 3,500 vertices.
constexpr double longest_bone = 0.075;
// Vertices with less weight from the part's joints belong to another limb.
constexpr double part_weight = 0.5;

std::vector<std::optional<Vector3>> places_in(const std::vector<SkeletonJoint>& skeleton, const Rig& rig) {
  std::map<std::string, Vector3> place;
  for (const Joint& joint : rig.joints) place.emplace(joint.name, joint.bind.topRightCorner<3, 1>());
  std::vector<std::optional<Vector3>> result;
  for (const SkeletonJoint& joint : skeleton) {
    result.emplace_back();
    if (const auto found = place.find(joint.name); found != place.end()) result.back() = found->second;
  }
  return result;
}

// Median length of the bones beyond the root over all characters, relative to their sizes; 0: no such bones.
double bone_length(const std::vector<SkeletonJoint>& skeleton, const std::vector<char>& is_below,
                   int32_t root, const std::vector<SizedRig>& characters) {
  std::vector<double> lengths;
  for (const SizedRig& character : characters) {
    const auto place = places_in(skeleton, *character.rig);
    for (size_t j = 0; j < skeleton.size(); ++j) {
      const int32_t p = skeleton[j].parent;
      if (is_below[j] && static_cast<int32_t>(j) != root && p != root && place[j] && place[p])
        lengths.push_back((*place[j] - *place[p]).norm() / character.size);
    }
  }
  if (lengths.empty()) return 0;
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  return *middle;
}

// Cuts triangles at the plane y = start; vertices are in order of first use.
class Cutter {
 public:
  Cutter(const MatrixX3& places, const std::vector<VertexInfluences>& influences, double start,
         DetailRegion& out)
      : places_(places), influences_(influences), start_(start), out_(out) {}

  void add(const std::array<int32_t, 3>& triangle) {
    std::vector<int32_t> polygon;
    for (int i = 0; i < 3; ++i) {
      const int32_t a = triangle[i], b = triangle[(i + 1) % 3];
      if (is_kept(a)) polygon.push_back(vertex(a));
      if (is_kept(a) != is_kept(b)) polygon.push_back(crossing(std::min(a, b), std::max(a, b)));
    }
    for (size_t i = 2; i < polygon.size(); ++i)
      triangles_.push_back({polygon[0], polygon[i - 1], polygon[i]});
  }

  void finish() {
    out_.mesh.positions.resize(static_cast<Eigen::Index>(positions_.size()), 3);
    for (size_t v = 0; v < positions_.size(); ++v)
      out_.mesh.positions.row(static_cast<Eigen::Index>(v)) = positions_[v].transpose();
    out_.mesh.triangles.resize(static_cast<Eigen::Index>(triangles_.size()), 3);
    for (size_t t = 0; t < triangles_.size(); ++t)
      for (int c = 0; c < 3; ++c) out_.mesh.triangles(static_cast<Eigen::Index>(t), c) = triangles_[t][c];
  }

 private:
  bool is_kept(int32_t v) const { return places_(v, 1) >= start_; }

  int32_t push(const Vector3& position, const VertexInfluences& influences, int32_t source) {
    positions_.push_back(position);
    out_.influences.push_back(influences), out_.source_vertex.push_back(source);
    return static_cast<int32_t>(positions_.size() - 1);
  }

  int32_t vertex(int32_t v) {
    const auto [at, is_new] = vertex_.try_emplace(v, 0);
    if (is_new) at->second = push(places_.row(v).transpose(), influences_[v], v);
    return at->second;
  }

  int32_t crossing(int32_t a, int32_t b) {
    const auto [at, is_new] = crossing_.try_emplace({a, b}, 0);
    if (!is_new) return at->second;
    const double t = (start_ - places_(a, 1)) / (places_(b, 1) - places_(a, 1));
    std::vector<Influence> mixed;
    for (Influence one : influences_[a]) one.weight *= static_cast<float>(1 - t), mixed.push_back(one);
    for (Influence one : influences_[b]) one.weight *= static_cast<float>(t), mixed.push_back(one);
    at->second = push(((1 - t) * places_.row(a) + t * places_.row(b)).transpose(), heaviest(mixed), -1);
    return at->second;
  }

  const MatrixX3& places_;
  const std::vector<VertexInfluences>& influences_;
  double start_;
  DetailRegion& out_;
  std::vector<Vector3> positions_;
  std::vector<std::array<int32_t, 3>> triangles_;
  std::map<int32_t, int32_t> vertex_;
  std::map<std::pair<int32_t, int32_t>, int32_t> crossing_;
};

}  // namespace

std::vector<int32_t> detail_joints(const std::vector<SkeletonJoint>& skeleton,
                                   const std::vector<SizedRig>& characters) {
  const auto count = static_cast<int32_t>(skeleton.size());
  std::vector<int32_t> children(skeleton.size(), 0), result;
  for (const SkeletonJoint& joint : skeleton)
    if (joint.parent >= 0) ++children[joint.parent];
  std::vector<char> has_detail(skeleton.size(), 0);  // at the joint or below it
  for (int32_t j = count; j-- > 0;) {
    const int32_t p = skeleton[j].parent;
    if (!has_detail[j] && children[j] >= 2) {
      const std::vector<char> is_below = at_or_below(skeleton, j);
      const double length = bone_length(skeleton, is_below, j, characters);
      if (std::count(is_below.begin(), is_below.end(), 1) > min_joints && length > 0 && length < longest_bone)
        result.push_back(j), has_detail[j] = 1;
    }
    if (p >= 0) has_detail[p] |= has_detail[j];
  }
  std::reverse(result.begin(), result.end());
  return result;
}

std::vector<int32_t> joints_of_part(const std::vector<SkeletonJoint>& skeleton, int32_t root) {
  const std::vector<char> is_below = at_or_below(skeleton, root);
  std::vector<int32_t> result;
  if (skeleton[root].parent >= 0) result.push_back(skeleton[root].parent);
  for (size_t j = 0; j < skeleton.size(); ++j)
    if (is_below[j]) result.push_back(static_cast<int32_t>(j));
  return result;
}

Similarity frame_of(const std::vector<Vector3>& places) {
  Vector3 middle = Vector3::Zero();
  for (size_t i = 1; i < places.size(); ++i)
    middle += (places[i] - places[0]) / static_cast<double>(places.size() - 1);
  Similarity frame;
  const Vector3 up = middle.stableNormalized();
  Matrix3 spread = Matrix3::Zero();
  for (size_t i = 1; i < places.size(); ++i) {
    const Vector3 off = places[i] - places[0] - middle;
    const Vector3 across = off - up * up.dot(off);
    spread += across * across.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Matrix3> axes(spread);
  Vector3 x = axes.eigenvectors().col(2);
  x = (x - up * up.dot(x)).stableNormalized();
  frame.rotation.col(0) = x, frame.rotation.col(1) = up, frame.rotation.col(2) = x.cross(up);
  frame.scale = middle.norm();
  frame.offset = places[0];
  return frame;
}

DetailRegion cut_region(const TriangleMesh& mesh, const std::vector<VertexInfluences>& influences,
                        const std::vector<char>& is_of_part, const Similarity& frame, double start) {
  const MatrixX3 places =
      ((mesh.positions.rowwise() - frame.offset.transpose()) * frame.rotation) / frame.scale;
  std::vector<float> share(influences.size(), 0);
  for (size_t v = 0; v < influences.size(); ++v)
    for (const Influence& one : influences[v])
      if (is_of_part[one.joint]) share[v] += one.weight;
  DetailRegion region;
  Cutter cutter(places, influences, start, region);
  for (int32_t t = 0; t < mesh.triangle_count(); ++t) {
    const std::array<int32_t, 3> corner = {mesh.triangles(t, 0), mesh.triangles(t, 1), mesh.triangles(t, 2)};
    if (share[corner[0]] + share[corner[1]] + share[corner[2]] > 3 * part_weight) cutter.add(corner);
  }
  cutter.finish();
  return region;
}

}  // namespace focal
