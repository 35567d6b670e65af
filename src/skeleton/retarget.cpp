#include "skeleton/retarget.h"

#include <algorithm>

#include "mesh/similarity.h"

namespace focal {
namespace {

constexpr double least_move = 1e-3;  // of the source's size: less is rounding

struct Frame {
  Matrix3 turn = Matrix3::Identity();
  Vector3 place = Vector3::Zero();
};

Frame frame_of(const Matrix4& matrix) {
  return {nearest_rotation(matrix.topLeftCorner<3, 3>()), matrix.topRightCorner<3, 1>()};
}

// Seen from the parent.
Frame local(const Frame& parent, const Frame& child) {
  return {parent.turn.transpose() * child.turn, parent.turn.transpose() * (child.place - parent.place)};
}

const Joint* find(const std::vector<Joint>& joints, const std::string& name) {
  for (const Joint& joint : joints)
    if (joint.name == name) return &joint;
  return nullptr;
}

double size_of(const std::vector<Joint>& joints) {
  Eigen::AlignedBox3d box;
  for (const Joint& joint : joints) box.extend(Vector3(joint.bind.topRightCorner<3, 1>()));
  return box.isEmpty() ? 0 : box.diagonal().norm();
}

}  // namespace

std::vector<JointKeys> retarget(const std::vector<Joint>& source, const JointTracks& tracks,
                                const std::vector<Joint>& target, double scale) {
  const double still = least_move * size_of(source);
  std::vector<JointKeys> result(target.size());
  for (size_t j = 0; j < target.size(); ++j) {
    const int32_t p = target[j].parent;
    const auto track = tracks.find(target[j].name),
               track_above = p < 0 ? tracks.end() : tracks.find(target[p].name);
    const Joint *from = find(source, target[j].name), *above = p < 0 ? nullptr : find(source, target[p].name);
    if (track == tracks.end() || !from || (p >= 0 && (track_above == tracks.end() || !above))) continue;
    const Frame at_rest = local(above ? frame_of(above->bind) : Frame{}, frame_of(from->bind));
    const Frame place = local(above ? frame_of(target[p].bind) : Frame{}, frame_of(target[j].bind));
    double farthest = 0;
    JointKeys& out = result[j];
    for (size_t t = 0; t < track->second.size(); ++t) {
      const Frame now = local(above ? frame_of(track_above->second[t]) : Frame{}, frame_of(track->second[t]));
      Eigen::Quaterniond q(now.turn);
      if (t > 0 && q.dot(out.rotation.back()) < 0) q.coeffs() *= -1;  // the short way round from key to key
      out.rotation.push_back(q);
      out.translation.push_back(place.place + scale * (now.place - at_rest.place));
      farthest = std::max(farthest, (now.place - at_rest.place).norm());
    }
    if (farthest <= still) out.translation.clear();
  }
  return result;
}

}  // namespace focal
