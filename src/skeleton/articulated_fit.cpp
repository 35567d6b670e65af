#include "skeleton/articulated_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.h"
#include "mesh/similarity.h"
#include "skeleton/rig_landmarks.h"

namespace focal {
namespace {

// Lengths are in units of sqrt(area). Chosen on left-out characters of game packs and of the generator.
constexpr double min_share = 0.006;  // of the area: smaller parts do not move on their own
constexpr double no_share = 1e-4;    // likewise, for a single joint: a control, which no surface constrains
constexpr size_t most_moving = 40, normal_points = 10;
constexpr Eigen::Index coarse_stride = 4, target_samples = 1000;  // of the points, of the target's
constexpr double target_weight = 0.5;   // of the distances from the target to the shape
constexpr double point_weight = 0.1;    // weight of a distance along the surface relative to one across it
constexpr double normal_cost = 0.0245;  // of two perpendicular normals
constexpr double pose_cost = 0.02;      // of joints bent by 90 degrees from the bind pose
constexpr double min_facing = 0.05;     // pairs with opposite normals keep a small weight
// Distances at which the weight of a pair decreases: in the first and last round, and of a map's image.
constexpr double loose = 0.17, tight = 0.045, map_outlier = 0.12;
constexpr double max_bend = 1.8, max_angle = 0.3, max_scale = 0.2;  // of a start; the others of one round
// Weights of all bones together, relative to distances whose weights sum to about 1.
constexpr double bone_weight = 3;        // a joint is at the end of its parent's bone
constexpr double angle_weight = 5e-3;    // rotations of a round, and differences between neighbours
constexpr double pose_weight = 3e-4;     // angles between neighbours relative to the bind pose
constexpr double even_weight = 3e-3;     // scales of neighbours
constexpr double size_weight = 2.5e-2;   // scales relative to the mean
constexpr double slender_weight = 1e-2;  // length relative to girth
constexpr double symmetry_weight = 0.3, still_weight = 1e-3;  // of both sides; of not moving
constexpr double control_reach = 0.1;  // joints nearer to a control than this place it with equal weight
constexpr int unknowns = 8;            // per joint: position, rotation, length, girth

using Jacobian = Eigen::Matrix<double, 3, unknowns>;

Matrix3 cross_matrix(const Vector3& v) {
  Matrix3 result;
  result << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return result;
}

Matrix3 turn_by(const Vector3& turn) {
  return Eigen::AngleAxisd(std::min(turn.norm(), max_angle), turn.stableNormalized()).toRotationMatrix();
}

// Rotation between a joint and its parent, in world coordinates: axis times angle.
Vector3 bend_of(const Matrix3& turn, const Matrix3& above) {
  const Eigen::AngleAxisd bend(Matrix3(turn * above.transpose()));
  return bend.angle() * bend.axis();
}

// The direction of least variance of the points.
Vector3 flat_direction(const MatrixX3& points) {
  const MatrixX3 away = points.rowwise() - points.colwise().mean();
  return Eigen::SelfAdjointEigenSolver<Matrix3>(away.transpose() * away).eigenvectors().col(0);
}

}  // namespace

FitTarget::FitTarget(const TriangleMesh& surface)
    : positions(surface.positions),
      normals(area_normals(surface)),
      area(normals.rowwise().norm()),
      tree(positions) {
  for (Eigen::Index v = 0; v < normals.rows(); ++v) normals.row(v) /= std::max(area[v], 1e-30);
  area /= area.sum();
}

// The normal equations. Only the lower triangle is set.
struct ArticulatedFit::System {
  explicit System(size_t joints)
      : matrix(Eigen::MatrixXd::Zero(unknowns * joints, unknowns * joints)),
        gradient(Vector::Zero(unknowns * joints)) {}

  // Adds a residual with derivative 1 for the first unknown and -1 for the second; index -1: none.
  void add_difference(Eigen::Index first, Eigen::Index second, double value, double weight) {
    matrix(first, first) += weight, gradient[first] += weight * value;
    if (second < 0) return;
    matrix(second, second) += weight, gradient[second] -= weight * value;
    matrix(std::max(first, second), std::min(first, second)) -= weight;
  }

  template <class A, class B>
  void add_block(int32_t row, int32_t column, const A& a, const B& b) {  // a' b, where row >= column
    matrix.block<unknowns, unknowns>(unknowns * row, unknowns * column).noalias() += a.transpose() * b;
  }

  Eigen::MatrixXd matrix;
  Vector gradient;
};

ArticulatedFit::ArticulatedFit(const std::vector<SkeletonJoint>& skeleton, const Exemplar& shape,
                               const std::vector<int32_t>& counterpart, const FitTarget& target)
    : skeleton_(skeleton),
      shape_(shape),
      counterpart_(counterpart),
      target_(target),
      weight_(shape.samples.weight.head(shape.positions.rows()).cast<double>()) {
  weight_ /= weight_.sum();
  choose_moving();
  cut_into_parts();
  estimate_normals();
}

void ArticulatedFit::choose_moving() {
  const Vector share = weights_below(skeleton_, shape_.rig->influences).cast<double>().transpose() * weight_;
  Vector own = Vector::Zero(share.size());
  for (Eigen::Index i = 0; i < weight_.size(); ++i)
    for (const Influence& one : shape_.rig->influences[i]) own[one.joint] += one.weight * weight_[i];
  std::vector<double> sorted(share.begin(), share.end());
  std::sort(sorted.rbegin(), sorted.rend());
  const double least = sorted.size() > most_moving ? std::max(min_share, sorted[most_moving]) : min_share;
  std::vector<Vector3> children(skeleton_.size(), Vector3::Zero());
  for (size_t j = 0; j < skeleton_.size(); ++j) {
    const int32_t above = skeleton_[j].parent < 0 ? -1 : slot_[skeleton_[j].parent];
    slot_.push_back(above);
    axis_.push_back(Vector3::UnitY());
    if (!has(j)) continue;
    if (above >= 0) children[moving_[above]] += bind_place(j) - bind_place(moving_[above]);
    const auto at = static_cast<Eigen::Index>(j);
    if (own[at] < no_share || (above >= 0 && share[at] < least)) continue;
    slot_.back() = static_cast<int32_t>(moving_.size());
    moving_.push_back(static_cast<int32_t>(j)), parent_.push_back(above);
  }
  if (moving_.empty())
    throw Error(Status::invalid_argument, "a training character's rig moves no vertex",
                "train the model again");
  for (const int32_t j : moving_) {
    constexpr double min_length = 0.02;
    const Vector3 to_tip = shape_.rig->tip[j] - bind_place(j);
    const Vector3& bone = children[j].norm() > min_length ? children[j] : to_tip;
    if (bone.norm() > 1e-6) axis_[j] = bone.normalized();
  }
}

void ArticulatedFit::cut_into_parts() {
  for (Eigen::Index i = 0; i < shape_.positions.rows(); ++i) {
    std::vector<Part>& parts = parts_.emplace_back();
    for (const Influence& one : shape_.rig->influences[i]) {
      if (!(one.weight > 0) || slot_[one.joint] < 0) continue;
      const auto same = std::find_if(parts.begin(), parts.end(),
                                     [&](const Part& part) { return part.slot == slot_[one.joint]; });
      if (same != parts.end())
        same->weight += one.weight;
      else
        parts.push_back({slot_[one.joint], one.weight});
    }
    if (parts.empty()) parts.push_back({0, 1});  // of a joint that this shape lacks
    std::sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.slot < b.slot; });
    double sum = 0;
    for (const Part& part : parts) sum += part.weight;
    for (Part& part : parts) {
      const int32_t j = moving_[part.slot];
      const Vector3 from = shape_.positions.row(i).transpose() - bind_place(j);
      part.weight /= sum;
      part.along = axis_[j] * axis_[j].dot(from), part.away = from - part.along;
    }
  }
}

// Perpendicular to the nearest points, away from the bone.
void ArticulatedFit::estimate_normals() {
  const Eigen::Index points = shape_.positions.rows();
  normals_ = MatrixX3::Zero(points, 3);
  std::vector<double> length(skeleton_.size(), 0);
  for (size_t slot = 0; slot < moving_.size(); ++slot)
    if (parent_[slot] >= 0) {
      const int32_t j = moving_[slot], above = moving_[parent_[slot]];
      length[above] = std::max(length[above], axis_[above].dot(bind_place(j) - bind_place(above)));
    }
  std::vector<std::pair<double, Eigen::Index>> near(points);
  const auto count = static_cast<Eigen::Index>(std::min(normal_points, near.size()));
  for (Eigen::Index i = 0; i < points; ++i) {
    for (Eigen::Index k = 0; k < points; ++k)
      near[k] = {(shape_.positions.row(k) - shape_.positions.row(i)).squaredNorm(), k};
    std::nth_element(near.begin(), near.begin() + count - 1, near.end());
    MatrixX3 around(count, 3);
    for (Eigen::Index k = 0; k < count; ++k) around.row(k) = shape_.positions.row(near[k].second);
    const Vector3 normal = flat_direction(around);
    Vector3 outwards = Vector3::Zero();
    for (const Part& part : parts_[i]) {
      const int32_t j = moving_[part.slot];
      const double end = std::max(length[j], 0.5 * axis_[j].dot(shape_.rig->tip[j] - bind_place(j)));
      const double at = axis_[j].dot(part.along);
      outwards += part.weight * (part.away + (at - std::clamp(at, 0.0, std::max(end, 0.0))) * axis_[j]);
    }
    normals_.row(i) = normal.dot(outwards) < 0 ? -normal : normal;
  }
}

Vector3 ArticulatedFit::carried(const Posture& posture, size_t joint, const Vector3& place) const {
  if (slot_[joint] < 0) return posture.place[joint] + posture.turn[joint] * (place - bind_place(joint));
  const int32_t j = moving_[slot_[joint]];
  const Vector3 from = place - bind_place(j), along = axis_[j] * axis_[j].dot(from);
  return posture.place[j] + posture.turn[j] * (std::exp(posture.length[j]) * along +
                                               std::exp(posture.girth[j]) * (from - along));
}

MatrixX3 ArticulatedFit::points(const Posture& posture) const {
  MatrixX3 result = MatrixX3::Zero(shape_.positions.rows(), 3);
  for (Eigen::Index i = 0; i < result.rows(); ++i)
    for (const Part& part : parts_[i]) {
      const int32_t j = moving_[part.slot];
      const Vector3 from = std::exp(posture.length[j]) * part.along + std::exp(posture.girth[j]) * part.away;
      result.row(i) += part.weight * (posture.place[j] + posture.turn[j] * from).transpose();
    }
  return result;
}

MatrixX3 ArticulatedFit::normals(const Posture& posture) const {
  MatrixX3 result = MatrixX3::Zero(normals_.rows(), 3);
  for (Eigen::Index i = 0; i < result.rows(); ++i) {
    for (const Part& part : parts_[i])
      result.row(i) +=
          part.weight * (posture.turn[moving_[part.slot]] * normals_.row(i).transpose()).transpose();
    result.row(i).normalize();
  }
  return result;
}

template <class Pair>
double ArticulatedFit::for_each_pair(const MatrixX3& points, const MatrixX3& normals, Eigen::Index stride,
                                     Pair&& pair) const {
  double sum = 0;
  const auto meet = [&](Eigen::Index point, Eigen::Index vertex, double weight) {
    const Vector3 gap = points.row(point) - target_.positions.row(vertex);
    const double facing = normals.row(point).dot(target_.normals.row(vertex));
    pair(point, vertex, gap, weight * std::max(facing, min_facing));
    return gap.norm() + normal_cost * (1 - facing);
  };
  double all = 0;
  for (Eigen::Index i = 0; i < points.rows(); i += stride) all += weight_[i];
  for (Eigen::Index i = 0; i < points.rows(); i += stride)
    sum += weight_[i] / all * meet(i, target_.tree.nearest(points.row(i)).first, weight_[i] / all);
  const NearestVertex own(points);
  const Eigen::Index every = std::max<Eigen::Index>(1, target_.positions.rows() * stride / target_samples);
  all = 0;
  for (Eigen::Index v = 0; v < target_.positions.rows(); v += every) all += target_.area[v];
  for (Eigen::Index v = 0; v < target_.positions.rows(); v += every) {
    const double weight = target_.area[v] / all;
    sum += weight * meet(own.nearest(target_.positions.row(v)).first, v, target_weight * weight);
  }
  return sum;
}

void ArticulatedFit::add_point(const Posture& posture, Eigen::Index point, const Matrix3& metric,
                               const Vector3& gap, System& system) const {
  std::array<Jacobian, 8> moved;
  const std::vector<Part>& parts = parts_[point];
  const size_t count = std::min(parts.size(), moved.size());
  const Vector3 pull = metric * gap;
  for (size_t a = 0; a < count; ++a) {
    const int32_t j = moving_[parts[a].slot];
    const Vector3 along = std::exp(posture.length[j]) * (posture.turn[j] * parts[a].along);
    const Vector3 away = std::exp(posture.girth[j]) * (posture.turn[j] * parts[a].away);
    moved[a] << Matrix3::Identity(), -cross_matrix(along + away), along, away;
    moved[a] *= parts[a].weight;
    system.gradient.segment<unknowns>(unknowns * parts[a].slot).noalias() += moved[a].transpose() * pull;
    const Jacobian pulled = metric * moved[a];
    for (size_t b = 0; b <= a; ++b) system.add_block(parts[a].slot, parts[b].slot, pulled, moved[b]);
  }
}

void ArticulatedFit::add_bones(const Posture& posture, System& system) const {
  const double each = 1.0 / static_cast<double>(moving_.size());
  double mean = 0;
  for (const int32_t j : moving_) mean += each * (posture.length[j] + posture.girth[j]) / 2;
  for (size_t slot = 0; slot < moving_.size(); ++slot) {
    const int32_t j = moving_[slot], above = parent_[slot];
    const Eigen::Index at = unknowns * static_cast<Eigen::Index>(slot), up = unknowns * above;
    const Vector3 bend =
        above < 0 ? Vector3(Vector3::Zero()) : bend_of(posture.turn[j], posture.turn[moving_[above]]);
    for (int i = 0; i < 3; ++i) {
      system.add_difference(at + i, -1, 0, still_weight * each);
      system.add_difference(at + 3 + i, -1, 0, angle_weight * each);
      if (above < 0) continue;
      system.add_difference(at + 3 + i, up + 3 + i, 0, angle_weight * each);
      system.add_difference(at + 3 + i, up + 3 + i, bend[i], pose_weight * each);
    }
    const int32_t other = counterpart_[j] >= 0 && has(counterpart_[j]) ? slot_[counterpart_[j]] : -1;
    const bool is_pair = other > static_cast<int32_t>(slot) && moving_[other] == counterpart_[j];
    for (const int of : {6, 7}) {
      const Vector& scale = of == 6 ? posture.length : posture.girth;
      system.add_difference(at + of, -1, scale[j] - mean, size_weight * each);
      if (above >= 0)
        system.add_difference(at + of, up + of, scale[j] - scale[moving_[above]], even_weight * each);
      if (is_pair)
        system.add_difference(at + of, unknowns * other + of, scale[j] - scale[counterpart_[j]],
                              symmetry_weight * each);
    }
    system.add_difference(at + 6, at + 7, posture.length[j] - posture.girth[j], slender_weight * each);
    if (above < 0) continue;
    const int32_t p = moving_[above];
    const Vector3 bone = bind_place(j) - bind_place(p);
    const Vector3 along = std::exp(posture.length[p]) * axis_[p].dot(bone) * (posture.turn[p] * axis_[p]);
    const Vector3 away =
        std::exp(posture.girth[p]) * (posture.turn[p] * (bone - axis_[p] * axis_[p].dot(bone)));
    Jacobian own = Jacobian::Zero(), of_parent;
    own.leftCols<3>().setIdentity();
    of_parent << -Matrix3::Identity(), cross_matrix(along + away), -along, -away;
    const Vector3 gap = posture.place[j] - posture.place[p] - along - away;
    const double weight = bone_weight * each;
    system.gradient.segment<unknowns>(at) += weight * own.transpose() * gap;
    system.gradient.segment<unknowns>(up) += weight * of_parent.transpose() * gap;
    const auto here = static_cast<int32_t>(slot);
    system.add_block(here, here, weight * own, own), system.add_block(here, above, weight * own, of_parent);
    system.add_block(above, above, weight * of_parent, of_parent);
  }
}

void ArticulatedFit::unbend(Posture& posture) const {
  for (size_t slot = 0; slot < moving_.size(); ++slot)
    if (const int32_t above = parent_[slot]; above >= 0) {
      Matrix3& turn = posture.turn[moving_[slot]];
      const Matrix3& at = posture.turn[moving_[above]];
      if (bend_of(turn, at).norm() > max_bend) turn = at;
    }
}

void ArticulatedFit::move(const Vector& step, Posture& posture) const {
  for (size_t slot = 0; slot < moving_.size(); ++slot) {
    const int32_t j = moving_[slot];
    const auto own = step.segment<unknowns>(unknowns * static_cast<Eigen::Index>(slot));
    posture.place[j] += own.head<3>();
    posture.turn[j] = turn_by(own.segment<3>(3)) * posture.turn[j];
    posture.length[j] += std::clamp(own[6], -max_scale, max_scale);
    posture.girth[j] += std::clamp(own[7], -max_scale, max_scale);
  }
}

void ArticulatedFit::run(const FitRounds& rounds, const std::vector<int32_t>& images,
                         Posture& posture) const {
  const int32_t all = rounds.coarse + rounds.fine;
  unbend(posture);
  for (int32_t round = 0; round < all; ++round) {
    const Eigen::Index stride = round < rounds.coarse ? coarse_stride : 1;
    const double progress = static_cast<double>(round) / all;
    const double outlier = std::max(loose * (1 - progress), tight);
    const MatrixX3 at = points(posture);
    System system(moving_.size());
    for_each_pair(at, normals(posture), stride,
                  [&](Eigen::Index point, Eigen::Index vertex, const Vector3& gap, double weight) {
                    const Vector3 normal = target_.normals.row(vertex);
                    const double trusted = weight / (1 + gap.squaredNorm() / (outlier * outlier));
                    add_point(posture, point,
                              trusted * (normal * normal.transpose() + point_weight * Matrix3::Identity()),
                              gap, system);
                  });
    if (const double weight = images.empty() ? 0 : rounds.map_weight * (1 - 2 * progress); weight > 0)
      for (Eigen::Index i = 0; i < at.rows(); i += stride) {
        const Vector3 gap = at.row(i) - target_.positions.row(images[i]);
        const double trusted = static_cast<double>(stride) * weight * weight_[i] /
                               (1 + gap.squaredNorm() / (map_outlier * map_outlier));
        add_point(posture, i, trusted * Matrix3::Identity(), gap, system);
      }
    add_bones(posture, system);
    move(-system.matrix.selfadjointView<Eigen::Lower>().llt().solve(system.gradient), posture);
  }
  take_along(posture);
}

// Joints that do not move on their own follow their parent, controls above all moving joints those near them.
void ArticulatedFit::take_along(Posture& posture) const {
  MatrixX3 before(moving_.size(), 3), after(moving_.size(), 3);
  for (size_t slot = 0; slot < moving_.size(); ++slot) {
    before.row(static_cast<Eigen::Index>(slot)) = bind_place(moving_[slot]);
    after.row(static_cast<Eigen::Index>(slot)) = posture.place[moving_[slot]];
  }
  for (size_t j = 0; j < skeleton_.size(); ++j) {
    if (!has(j)) continue;
    if (slot_[j] < 0) {
      const Vector away = (before.rowwise() - bind_place(j).transpose()).rowwise().squaredNorm();
      const Similarity near =
          fit_similarity(before, after, (away.array() + control_reach * control_reach).inverse());
      posture.place[j] = near(bind_place(j)), posture.turn[j] = near.rotation;
    } else if (moving_[slot_[j]] != static_cast<int32_t>(j)) {
      posture.place[j] = carried(posture, j, bind_place(j));
      posture.turn[j] = posture.turn[moving_[slot_[j]]];
    }
  }
}

double ArticulatedFit::residual(const Posture& posture) const {
  double bends = 0;
  for (size_t slot = 0; slot < moving_.size(); ++slot)
    if (const int32_t above = parent_[slot]; above >= 0)
      bends += std::pow(
          1 - std::cos(bend_of(posture.turn[moving_[slot]], posture.turn[moving_[above]]).norm()), 2);
  return for_each_pair(points(posture), normals(posture), 1, [](auto&&...) {}) +
         pose_cost * bends / static_cast<double>(moving_.size());
}

}  // namespace focal
