#include "skeleton/mirrored_rig.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "mesh/nearest_vertex.h"
#include "mesh/similarity.h"

namespace focal {
namespace {

constexpr double same_place = 5e-4;  // relative to the mesh's diagonal
constexpr double min_share = 0.5;    // of the vertices with a counterpart
// Relative to the diagonal: joints without a side that are nearer to the plane are moved into it.
constexpr double middle_reach = 0.03;
constexpr size_t max_searched = 20000;  // vertices used to refine the plane

Vector3 place_in(const Matrix4& frame) { return frame.topRightCorner<3, 1>(); }

// The common direction of vectors of either sign; x without vectors.
Vector3 main_direction(const std::vector<Vector3>& ways) {
  Matrix3 sum = Matrix3::Zero();
  for (const Vector3& way : ways) sum += way * way.transpose();
  if (sum.isZero()) return Vector3::UnitX();
  return Eigen::SelfAdjointEigenSolver<Matrix3>(sum).eigenvectors().col(2);
}

// The plane perpendicular to an axis through 0, if the given plane is close to it: mirror images then have
// the same digits.
MirrorPlane snapped(MirrorPlane plane, double size) {
  Eigen::Index axis = 0;
  if (plane.normal.cwiseAbs().maxCoeff(&axis) > 1 - 1e-6) plane.normal = Vector3::Unit(axis);
  if (std::abs(plane.offset) < 1e-3 * size) plane.offset = 0;
  return plane;
}

// The plane between pairs of points that are mirror images.
MirrorPlane plane_between(const std::vector<std::pair<Vector3, Vector3>>& pairs) {
  std::vector<Vector3> ways;
  for (const auto& [one, other] : pairs) ways.push_back(one - other);
  MirrorPlane plane{main_direction(ways)};
  for (const auto& [one, other] : pairs)
    plane.offset += plane.normal.dot(one + other) / (2 * static_cast<double>(pairs.size()));
  return plane;
}

MirrorPlane plane_of_joints(const std::vector<Matrix4>& frames, const std::vector<int32_t>& other) {
  std::vector<std::pair<Vector3, Vector3>> pairs;
  for (size_t j = 0; j < frames.size(); ++j)
    if (other[j] > static_cast<int32_t>(j))
      pairs.emplace_back(place_in(frames[j]), place_in(frames[other[j]]));
  return pairs.empty() ? MirrorPlane{} : plane_between(pairs);
}

// For points at the same position the smallest number: the caller's vertices may be split along seams.
std::vector<int32_t> first_at_same_place(const MatrixX3& positions) {
  std::vector<int32_t> order(static_cast<size_t>(positions.rows())), first(order.size());
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&](int32_t v) { return std::tuple(positions(v, 0), positions(v, 1), positions(v, 2)); };
  std::stable_sort(order.begin(), order.end(), [&](int32_t a, int32_t b) { return key(a) < key(b); });
  for (size_t i = 0; i < order.size(); ++i)
    first[order[i]] = i > 0 && key(order[i - 1]) == key(order[i]) ? first[order[i - 1]] : order[i];
  return first;
}

// Iterates the plane between points and the points nearest to their mirror images towards the best symmetry
// plane.
MirrorPlane settled(const MatrixX3& positions, const NearestVertex& near, MirrorPlane plane, double size) {
  const auto count = static_cast<size_t>(positions.rows());
  const size_t step = std::max<size_t>(1, count / max_searched);
  double reach = 0.05 * size;
  for (int round = 0; round < 12; ++round, reach = std::max(reach / 2, same_place * size)) {
    std::vector<std::pair<Vector3, Vector3>> pairs;
    for (size_t v = 0; v < count; v += step) {
      const Vector3 place = positions.row(static_cast<Eigen::Index>(v)).transpose();
      const auto [partner, squared] = near.nearest(plane(place));
      if (squared < reach * reach) pairs.emplace_back(place, positions.row(partner).transpose());
    }
    if (pairs.size() < 3) break;
    plane = plane_between(pairs);
  }
  return plane;
}

// Relation of the joint axes of both sides: mirrored, with one of them or all three reversed. The rotations
// decide which.
Matrix3 axes_of_other(const Matrix3& turn, const Matrix3& mirrored) {
  Matrix3 best;
  double most = -std::numeric_limits<double>::infinity();
  for (const Vector3& signs :
       {Vector3(-1, 1, 1), Vector3(1, -1, 1), Vector3(1, 1, -1), Vector3(-1, -1, -1)}) {
    const double agreed = (turn.transpose() * mirrored * signs.asDiagonal()).trace();
    if (agreed > most) most = agreed, best = signs.asDiagonal();
  }
  return best;
}

// Makes frames and tips of joints symmetric about one plane. share: per joint its weight relative to its
// counterpart.
struct Mirror {
  MirrorPlane plane;
  const std::vector<int32_t>& other;
  std::vector<double> share;
  double reach;  // for joints without a side

  void frame(size_t j, size_t k, Matrix4& one, Matrix4& pair) const {
    const Matrix3 turn = one.topLeftCorner<3, 3>();
    const Matrix3 image = plane.turn() * pair.topLeftCorner<3, 3>();
    const Matrix3 axes = axes_of_other(turn, image);
    const double mine = share[j] / (share[j] + share[k]);
    one.topLeftCorner<3, 3>() = nearest_rotation(mine * turn + (1 - mine) * image * axes);
    pair.topLeftCorner<3, 3>() = plane.turn() * one.topLeftCorner<3, 3>() * axes;
    Vector3 place = place_in(one), there = place_in(pair);
    point(j, k, place, there);
    one.topRightCorner<3, 1>() = place, pair.topRightCorner<3, 1>() = there;
  }

  void point(size_t j, size_t k, Vector3& one, Vector3& pair) const {
    const double mine = share[j] / (share[j] + share[k]);
    if (mine < 1) one = mine * one + (1 - mine) * plane(pair);
    pair = plane(one);
  }

  // Handles a joint without a side.
  void middle(Matrix4& frame) const {
    const Matrix3 turn = frame.topLeftCorner<3, 3>();
    const Matrix3 image = plane.turn() * turn;
    frame.topLeftCorner<3, 3>() = nearest_rotation(turn + image * axes_of_other(turn, image));
    frame.topRightCorner<3, 1>() = in_plane(place_in(frame));
  }
  Vector3 in_plane(const Vector3& p) const { return p - (plane.normal.dot(p) - plane.offset) * plane.normal; }
  bool is_middle(const Vector3& p) const { return std::abs(plane.normal.dot(p) - plane.offset) < reach; }

  // tip may be null.
  void apply(size_t j, const std::vector<Matrix4*>& frames, std::vector<Vector3>* tip, bool may_move) const {
    if (other[j] > static_cast<int32_t>(j)) {
      const auto k = static_cast<size_t>(other[j]);
      // The one of larger weight leads: it is unchanged to the bit if it has all the weight.
      const auto [a, b] = share[j] >= share[k] ? std::pair(j, k) : std::pair(k, j);
      frame(a, b, *frames[a], *frames[b]);
      if (tip) point(a, b, (*tip)[a], (*tip)[b]);
    } else if (other[j] < 0 && may_move && is_middle(place_in(*frames[j]))) {
      middle(*frames[j]);
      if (tip && is_middle((*tip)[j])) (*tip)[j] = in_plane((*tip)[j]);
    }
  }
};

class MirroredWeights {
 public:
  MirroredWeights(const MirroredVertices& vertices, const std::vector<int32_t>& other,
                  const MatrixX3& positions, Rig& rig)
      : other_(other),
        first_(first_at_same_place(positions)),
        made_(first_.size()),
        is_made_(first_.size(), 0) {
    most_ = static_cast<size_t>(rig.more.empty() ? max_influences : 2 * max_influences);
    std::vector<std::vector<Influence>> at(first_.size());
    for (size_t v = 0; v < first_.size(); ++v)
      for (const Influence& one : influences_of(rig, v)) at[first_[v]].push_back(one);
    const std::vector<int32_t>& partner = vertices.partner;
    for (size_t v = 0; v < first_.size(); ++v) {
      if (first_[v] != static_cast<int32_t>(v) || partner[v] < static_cast<int32_t>(v) || at[v].empty())
        continue;
      if (partner[partner[v]] == static_cast<int32_t>(v)) share(v, static_cast<size_t>(partner[v]), at);
    }
    for (size_t v = 0; v < first_.size(); ++v)
      if (is_made_[first_[v]] && !influences_of(rig, v).empty()) put_influences(made_[first_[v]], v, rig);
  }

 private:
  std::vector<Influence> images(std::vector<Influence> influences) const {
    for (Influence& one : influences)
      if (other_[one.joint] >= 0) one.joint = other_[one.joint];
    return influences;
  }

  // The influences of a vertex in the plane when its last joint has lost its counterpart.
  std::vector<Influence> closed(std::vector<Influence> influences) const {
    const auto has = [&](int32_t joint) {
      return std::any_of(influences.begin(), influences.end(),
                         [&](const Influence& i) { return i.joint == joint; });
    };
    std::vector<Influence> kept;
    for (const Influence& one : influences)
      if (other_[one.joint] < 0 || has(other_[one.joint])) kept.push_back(one);
    return kept.empty() ? influences : heaviest(kept, most_);
  }

  void share(size_t v, size_t w, const std::vector<std::vector<Influence>>& at) {
    std::vector<Influence> both = heaviest(at[v], at[v].size());
    const std::vector<Influence> there = images(heaviest(at[w], at[w].size()));
    both.insert(both.end(), there.begin(), there.end());
    made_[v] = heaviest(both, most_);
    if (v == w) made_[v] = closed(made_[v]);
    if (v != w) made_[w] = images(made_[v]);
    is_made_[v] = is_made_[w] = 1;
  }

  const std::vector<int32_t>& other_;
  const std::vector<int32_t> first_;
  size_t most_ = max_influences;
  std::vector<std::vector<Influence>> made_;  // for each position with a counterpart
  std::vector<char> is_made_;
};

double diagonal(const MatrixX3& positions) {
  return (positions.colwise().maxCoeff() - positions.colwise().minCoeff()).norm();
}

// Initial planes: the given one, and the coordinate planes that files are usually modelled about, if they are
// nearly parallel to it.
std::vector<MirrorPlane> starts(const MatrixX3& positions, const MirrorPlane& near) {
  std::vector<MirrorPlane> all = {near};
  for (const int axis : {0, 1, 2}) {
    if (std::abs(near.normal[axis]) < 0.7) continue;
    const auto along = positions.col(axis);
    for (const double offset : {0.0, (along.minCoeff() + along.maxCoeff()) / 2})
      all.push_back({Vector3::Unit(axis), offset});
  }
  return all;
}

MirroredVertices partners(const MatrixX3& positions, const NearestVertex& tree, const MirrorPlane& plane,
                          double reach) {
  MirroredVertices result{plane, std::vector<int32_t>(static_cast<size_t>(positions.rows()), -1)};
  size_t count = 0;
  for (Eigen::Index v = 0; v < positions.rows(); ++v) {
    const auto [partner, squared] = tree.nearest(plane(positions.row(v).transpose()));
    if (squared > reach * reach) continue;
    result.partner[static_cast<size_t>(v)] = partner, ++count;
  }
  result.share = static_cast<double>(count) / static_cast<double>(positions.rows());
  return result;
}

std::vector<Matrix4*> binds_of(std::vector<Joint>& joints) {
  std::vector<Matrix4*> binds;
  for (Joint& joint : joints) binds.push_back(&joint.bind);
  return binds;
}

void mirror_joints(const MirrorPlane& plane, const std::vector<int32_t>& other, const FixedJoints& fixed,
                   double reach, CharacterRig& character) {
  const auto is_fixed = [&](size_t j) { return j < fixed.size() && fixed[j].has_value(); };
  Mirror mirror{plane, other, {}, reach};
  for (size_t j = 0; j < other.size(); ++j) {
    const bool yields = other[j] >= 0 && is_fixed(static_cast<size_t>(other[j])) && !is_fixed(j);
    mirror.share.push_back(yields ? 0 : character.confidence[j] + 1e-3);
  }
  const std::vector<Matrix4*> binds = binds_of(character.rig.joints);
  for (size_t j = 0; j < other.size(); ++j)
    if (other[j] < 0 || !is_fixed(j) || !is_fixed(static_cast<size_t>(other[j])))
      mirror.apply(j, binds, &character.tip, !is_fixed(j));
}

std::string percent(double share) { return std::to_string(std::lround(100 * share)) + " %"; }

}  // namespace

MirroredVertices mirrored_vertices(const MatrixX3& positions, const MirrorPlane& near) {
  const double size = diagonal(positions);
  const std::vector<int32_t> first = first_at_same_place(positions);
  std::vector<int32_t> places;
  for (size_t v = 0; v < first.size(); ++v)
    if (first[v] == static_cast<int32_t>(v)) places.push_back(first[v]);
  MirroredVertices best{near, std::vector<int32_t>(first.size(), -1)};
  if (places.empty() || !(size > 0)) return best;
  const NearestVertex tree(positions, places);
  for (const MirrorPlane& start : starts(positions, near)) {
    const MirrorPlane plane = settled(positions, tree, start, size);
    MirroredVertices found = partners(positions, tree, plane, same_place * size);
    MirroredVertices plain = partners(positions, tree, snapped(plane, size), same_place * size);
    if (plain.share >= 0.99 * found.share) found = std::move(plain);
    if (found.share > best.share) best = std::move(found);
    if (best.share >= min_share) break;
  }
  return best;
}

void make_symmetric(const TriangleMesh& mesh, const FixedJoints& fixed, CharacterRig& character) {
  const std::vector<int32_t> other = other_sides(character.rig.joints);
  if (std::all_of(other.begin(), other.end(), [](int32_t o) { return o < 0; })) return;
  std::vector<Matrix4> binds;
  for (const Joint& joint : character.rig.joints) binds.push_back(joint.bind);
  const MirroredVertices vertices = mirrored_vertices(mesh.positions, plane_of_joints(binds, other));
  if (vertices.share < min_share) {
    make_bones_symmetric(character);
    character.warnings.push_back(
        "the mesh is not symmetric (" + percent(vertices.share) +
        " of its vertices have a mirror image): only the lengths of the bones are made equal");
    return;
  }
  mirror_joints(vertices.plane, other, fixed, middle_reach * diagonal(mesh.positions), character);
  MirroredWeights(vertices, other, mesh.positions, character.rig);
}

void make_rest_symmetric(CharacterRig& character) {
  if (character.rest.empty()) return;
  const std::vector<int32_t> other = other_sides(character.rig.joints);
  const MirrorPlane plane = plane_of_joints(character.rest, other);
  Mirror mirror{plane, other, std::vector<double>(other.size(), 1), std::numeric_limits<double>::infinity()};
  std::vector<Matrix4*> frames;
  for (Matrix4& frame : character.rest) frames.push_back(&frame);
  for (size_t j = 0; j < other.size(); ++j) mirror.apply(j, frames, nullptr, false);
}

}  // namespace focal
