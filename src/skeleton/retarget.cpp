#include "skeleton/retarget.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "base/error.h"
#include "mesh/similarity.h"
#include "skeleton/joint_match.h"

namespace focal {
namespace {

constexpr double min_move = 1e-3;  // relative to the source's size: less is rounding
constexpr double min_turn = 1e-3;  // radians, of a joint that does not move
constexpr int64_t max_samples = 64'000'000;
constexpr int cubic_steps = 8;  // samples per cubic segment that must be sampled

struct Frame {
  Matrix3 turn = Matrix3::Identity();
  Vector3 place = Vector3::Zero();
};

Frame frame_of(const Matrix4& matrix) {
  return {nearest_rotation(matrix.topLeftCorner<3, 3>()), matrix.topRightCorner<3, 1>()};
}

// Relative to the parent.
Frame local(const Frame& parent, const Frame& child) {
  return {parent.turn.transpose() * child.turn, parent.turn.transpose() * (child.place - parent.place)};
}

double size_of(const std::vector<Joint>& joints) {
  Eigen::AlignedBox3d box;
  for (const Joint& joint : joints) box.extend(Vector3(joint.bind.topRightCorner<3, 1>()));
  return box.isEmpty() ? 0 : box.diagonal().norm();
}

// "hips (2)" is named "hips" in its file.
std::string name_in_file(const std::string& name, const std::set<std::string>& all) {
  const size_t at = name.rfind(" (");
  return at != std::string::npos && name.back() == ')' && all.contains(name.substr(0, at))
             ? name.substr(0, at)
             : name;
}

// The source's joints by name, those of the skeleton that the clip animates most first.
struct Named {
  std::vector<std::string> names;
  std::vector<int32_t> joints;
};

Named named_joints(const ClipSource& source, const Clip& clip) {
  const auto& joints = source.joints;
  std::map<int32_t, int64_t> channels;
  for (const Channel& channel : clip.channels) ++channels[channel.node];
  std::vector<int32_t> root(joints.size());
  std::vector<int64_t> moved(joints.size(), 0);
  for (size_t j = 0; j < joints.size(); ++j) {
    root[j] = joints[j].parent < 0 ? static_cast<int32_t>(j) : root[joints[j].parent];
    if (const auto found = channels.find(joints[j].node); found != channels.end())
      moved[root[j]] += found->second;
  }
  Named result;
  result.joints.resize(joints.size());
  std::iota(result.joints.begin(), result.joints.end(), 0);
  std::stable_sort(result.joints.begin(), result.joints.end(),
                   [&](int32_t a, int32_t b) { return moved[root[a]] > moved[root[b]]; });
  std::set<std::string> all, taken;
  for (const Joint& joint : joints) all.insert(joint.name);
  for (const int32_t j : result.joints) {
    const std::string name = name_in_file(joints[j].name, all);
    result.names.push_back(taken.insert(name).second ? name : joints[j].name);
  }
  return result;
}

// Transform of the source's node n relative to another node above it (-1: the world): turn * q, and linear *
// t + offset.
struct Path {
  bool is_exact = false;  // no other node is animated on the path
  Matrix3 turn, linear;
  Vector3 offset;
};

class Retargeter {
 public:
  Retargeter(const ClipSource& source, const Clip& clip, const std::vector<Joint>& target,
             const std::vector<Matrix4>& target_rest, double scale);
  Retargeted run();

 private:
  // One target joint, and the source joint that it follows.
  struct Follower {
    size_t joint;
    const Joint* from;
    const Joint* above;    // of the nearest target joint above that follows one; null: the world
    Matrix3 left, right;   // rotation of the target = left * (rotation of from relative to above) * right
    Frame at_rest, place;  // of the source relative to above; of the target relative to its parent
  };
  Follower follower(size_t joint) const;
  Matrix3 axes(size_t joint) const;
  Path path(const Follower& one) const;
  void follow_keys(const Follower& one, const Path& path, JointKeys& out) const;
  void sample(const std::vector<Follower>& sampled);
  void add_times(const Follower& one, std::set<double>& times) const;
  const Channel* channel(int32_t node, NodeProperty property) const;
  bool is_moved(int32_t node) const;
  Vector3 translation_of(const Follower& one, const Vector3& place) const {
    return one.place.place + scale_ * (one.left * (place - one.at_rest.place));
  }

  const ClipSource& source_;
  const Clip& clip_;
  const std::vector<Joint>& target_;
  const std::vector<Matrix4>& target_rest_;
  double scale_, still_, first_time_ = 0;
  std::vector<const Joint*> match_;
  std::vector<char> by_convention_;
  std::map<std::pair<int32_t, NodeProperty>, const Channel*> channels_;
  std::vector<Matrix4> world_;  // as in the file
  Retargeted result_;
};

Retargeter::Retargeter(const ClipSource& source, const Clip& clip, const std::vector<Joint>& target,
                       const std::vector<Matrix4>& target_rest, double scale)
    : source_(source),
      clip_(clip),
      target_(target),
      target_rest_(target_rest),
      scale_(scale),
      still_(min_move * size_of(source.joints)),
      match_(target.size(), nullptr),
      world_(world_transforms(source.tree)) {
  std::vector<std::string> wanted;
  for (const Joint& joint : target) wanted.push_back(joint.name);
  const Named named = named_joints(source, clip);
  const JointMatch match = match_joints(wanted, named.names);
  for (size_t j = 0; j < target.size(); ++j)
    if (match.there[j] >= 0) match_[j] = &source.joints[named.joints[match.there[j]]];
  by_convention_ = match.by_convention;
  result_.missing = match.missing;
  for (const Channel& one : clip.channels) channels_[{one.node, one.property}] = &one;
  if (!clip.channels.empty()) first_time_ = clip.channels.front().keys.times.front();
  for (const Channel& one : clip.channels) first_time_ = std::min(first_time_, one.keys.times.front());
}

const Channel* Retargeter::channel(int32_t node, NodeProperty property) const {
  const auto found = channels_.find({node, property});
  return found == channels_.end() ? nullptr : found->second;
}

bool Retargeter::is_moved(int32_t node) const {
  for (const auto property : {NodeProperty::translation, NodeProperty::rotation, NodeProperty::scale})
    if (channel(node, property)) return true;
  return false;
}

// From a joint's axes in the source to those in the target, where only a convention identifies them as one
// joint.
Matrix3 Retargeter::axes(size_t joint) const {
  if (!by_convention_[joint] || target_rest_.empty()) return Matrix3::Identity();
  return frame_of(match_[joint]->bind).turn.transpose() * frame_of(target_rest_[joint]).turn;
}

Retargeter::Follower Retargeter::follower(size_t joint) const {
  int32_t above = target_[joint].parent;
  while (above >= 0 && !match_[above]) above = target_[above].parent;
  const Joint* from_above = above < 0 ? nullptr : match_[above];
  const auto bound = [&](int32_t j) { return j < 0 ? Frame{} : frame_of(target_[j].bind); };
  // Target joints in between keep their pose.
  const Frame parent = local(bound(above), bound(target_[joint].parent));
  Follower one{joint, match_[joint], from_above, Matrix3::Identity(), axes(joint), {}, {}};
  one.left =
      parent.turn.transpose() * (above < 0 ? Matrix3(Matrix3::Identity()) : Matrix3(axes(above).transpose()));
  one.at_rest = local(from_above ? frame_of(from_above->bind) : Frame{}, frame_of(one.from->bind));
  one.place = local(bound(target_[joint].parent), bound(static_cast<int32_t>(joint)));
  return one;
}

Path Retargeter::path(const Follower& one) const {
  const auto& parent = source_.tree.parent;
  const int32_t top = one.above ? one.above->node : -1;
  Path path;
  Matrix4 between = Matrix4::Identity();
  int32_t node = parent[one.from->node];
  for (; node >= 0 && node != top; node = parent[node]) {
    if (is_moved(node)) return path;
    between = source_.tree.local[node] * between;
  }
  if (node != top) return path;
  Matrix3 above = Matrix3::Identity();
  if (top >= 0) {
    above = frame_of(world_[top]).turn.transpose() * world_[top].topLeftCorner<3, 3>();
    for (node = top; node >= 0; node = parent[node])
      if (channel(node, NodeProperty::scale)) return path;
  }
  path.linear = above * between.topLeftCorner<3, 3>();
  path.offset = above * between.topRightCorner<3, 1>();
  path.turn = nearest_rotation(path.linear);
  const double size = std::cbrt(std::abs(path.linear.determinant()));
  path.is_exact = (path.linear - size * path.turn).norm() < 1e-4 * size;
  return path;
}

Eigen::Quaterniond quaternion(const Vector& xyzw) { return {xyzw[3], xyzw[0], xyzw[1], xyzw[2]}; }

Keys constant(double time, const Vector& value) {
  Keys keys;
  keys.times = {time};
  keys.values = value.transpose();
  return keys;
}

// Applies change(values, is_tangent) to each row.
template <class Change>
Keys changed(Keys keys, const Change& change) {
  const bool cubic = keys.interpolation == Interpolation::cubic;
  for (Eigen::Index row = 0; row < keys.values.rows(); ++row)
    keys.values.row(row) =
        change(Vector(keys.values.row(row).transpose()), cubic && row % 3 != 1).transpose();
  return keys;
}

void Retargeter::follow_keys(const Follower& one, const Path& path, JointKeys& out) const {
  const int32_t node = one.from->node;
  const Frame shown = frame_of(source_.tree.local[node]);
  const Eigen::Quaterniond left(one.left * path.turn), right(one.right);
  const auto turned = [&](const Vector& q, bool) -> Vector {
    return (left * quaternion(q) * right).coeffs();
  };
  if (const Channel* turns = channel(node, NodeProperty::rotation)) {
    out.rotation = changed(turns->keys, turned);
  } else {
    const Eigen::Quaterniond q = left * Eigen::Quaterniond(shown.turn) * right;
    if (q.angularDistance(Eigen::Quaterniond(one.place.turn)) > min_turn)
      out.rotation = constant(first_time_, q.coeffs());
  }
  double farthest = 0;
  const auto moved = [&](const Vector& t, bool is_tangent) -> Vector {
    if (is_tangent) return scale_ * (one.left * (path.linear * t));
    const Vector3 place = path.linear * t + path.offset;
    farthest = std::max(farthest, (place - one.at_rest.place).norm());
    return translation_of(one, place);
  };
  const Channel* moves = channel(node, NodeProperty::translation);
  Keys keys = moves ? changed(moves->keys, moved) : constant(first_time_, moved(shown.place, false));
  if (farthest > still_) out.translation = std::move(keys);
}

// Adds the keys of all nodes that affect the joint.
void Retargeter::add_times(const Follower& one, std::set<double>& times) const {
  for (const Joint* joint : {one.from, one.above})
    for (int32_t node = joint ? joint->node : -1; node >= 0; node = source_.tree.parent[node])
      for (const auto property : {NodeProperty::translation, NodeProperty::rotation, NodeProperty::scale}) {
        const Channel* moves = channel(node, property);
        if (!moves) continue;
        const auto& own = moves->keys.times;
        times.insert(own.begin(), own.end());
        if (moves->keys.interpolation != Interpolation::cubic) continue;
        for (size_t k = 1; k < own.size(); ++k)
          for (int step = 1; step < cubic_steps; ++step)
            times.insert(own[k - 1] + (own[k] - own[k - 1]) * step / cubic_steps);
      }
}

void Retargeter::sample(const std::vector<Follower>& sampled) {
  std::set<double> all;
  for (const Follower& one : sampled) add_times(one, all);
  if (all.empty()) all.insert(first_time_);
  const std::vector<double> times(all.begin(), all.end());
  if (static_cast<int64_t>(times.size()) * static_cast<int64_t>(sampled.size() + world_.size()) > max_samples)
    throw Error(Status::unsupported,
                "the animation '" + clip_.name + "' has more keys than the memory limit allows",
                "bake it in the program it was made with, with fewer keys");
  std::vector<double> farthest(sampled.size(), 0);
  for (size_t i = 0; i < sampled.size(); ++i) {
    JointKeys& out = result_.joints[sampled[i].joint];
    out.rotation.times = out.translation.times = times;
    out.rotation.values.resize(static_cast<Eigen::Index>(times.size()), 4);
    out.translation.values.resize(static_cast<Eigen::Index>(times.size()), 3);
  }
  for (size_t t = 0; t < times.size(); ++t) {
    const auto world = world_transforms(source_.tree, &clip_, times[t]);
    const auto row = static_cast<Eigen::Index>(t);
    for (size_t i = 0; i < sampled.size(); ++i) {
      const Follower& one = sampled[i];
      JointKeys& out = result_.joints[one.joint];
      const Frame now =
          local(one.above ? frame_of(world[one.above->node]) : Frame{}, frame_of(world[one.from->node]));
      Eigen::Quaterniond q(Matrix3(one.left * now.turn * one.right));
      if (t > 0 && q.coeffs().dot(out.rotation.values.row(row - 1).transpose()) < 0)
        q.coeffs() *= -1;  // the shorter arc between keys
      out.rotation.values.row(row) = q.coeffs().transpose();
      out.translation.values.row(row) = translation_of(one, now.place).transpose();
      farthest[i] = std::max(farthest[i], (now.place - one.at_rest.place).norm());
    }
  }
  for (size_t i = 0; i < sampled.size(); ++i)
    if (farthest[i] <= still_) result_.joints[sampled[i].joint].translation = {};
}

Retargeted Retargeter::run() {
  result_.joints.resize(target_.size());
  std::vector<Follower> sampled;
  for (size_t j = 0; j < target_.size(); ++j) {
    if (!match_[j] || clip_.channels.empty()) continue;
    const Follower one = follower(j);
    if (const Path way = path(one); way.is_exact)
      follow_keys(one, way, result_.joints[j]);
    else
      sampled.push_back(one);
  }
  if (!sampled.empty()) sample(sampled);
  return std::move(result_);
}

}  // namespace

Retargeted retarget(const ClipSource& source, const Clip& clip, const std::vector<Joint>& target,
                    const std::vector<Matrix4>& target_rest, double scale) {
  return Retargeter(source, clip, target, target_rest, scale).run();
}

}  // namespace focal
