#include "rig/skeleton_metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace focal_test {
namespace {

using namespace focal;
using Points = std::vector<Vector3>;

struct Segment {
  Vector3 from, to;
};

Points places_of(const std::vector<Joint>& joints) {
  Points result;
  for (const Joint& joint : joints) result.emplace_back(joint.bind.topRightCorner<3, 1>());
  return result;
}

std::vector<Segment> bones_of(const std::vector<Joint>& joints) {
  const Points places = places_of(joints);
  std::vector<Segment> result;
  for (size_t j = 0; j < joints.size(); ++j)
    if (joints[j].parent >= 0) result.push_back({places[joints[j].parent], places[j]});
  return result;
}

double distance(const Vector3& p, const Segment& bone) {
  const Vector3 along = bone.to - bone.from;
  const double squared = along.squaredNorm();
  const double t = squared > 0 ? std::clamp(along.dot(p - bone.from) / squared, 0.0, 1.0) : 0;
  return (bone.from + t * along - p).norm();
}

double distance(const Vector3& p, const Vector3& q) { return (p - q).norm(); }

template <class Things>
double mean_distance(const Points& from, const Things& to) {
  double sum = 0;
  for (const Vector3& p : from) {
    double least = std::numeric_limits<double>::infinity();
    for (const auto& thing : to) least = std::min(least, distance(p, thing));
    sum += least;
  }
  return sum / static_cast<double>(from.size());
}

Points along(const std::vector<Segment>& bones, double step) {
  Points result;
  for (const Segment& bone : bones) {
    const int count = std::max(1, static_cast<int>((bone.to - bone.from).norm() / step));
    for (int i = 0; i <= count; ++i)
      result.emplace_back(bone.from + (bone.to - bone.from) * (static_cast<double>(i) / count));
  }
  return result;
}

// Half the body's thickness round each joint: rays across its bones.
std::vector<double> radii(const std::vector<Joint>& joints, const TriangleMesh& body) {
  constexpr int rays_a_bone = 14;
  const RayCaster rays(body);
  const Points places = places_of(joints);
  std::vector<double> sum(joints.size(), 0), hits(joints.size(), 0);
  const auto cast = [&](size_t joint, const Vector3& bone) {
    const Vector3 axis = bone.stableNormalized();
    const Vector3 side = axis.unitOrthogonal(), other = axis.cross(side);
    for (int r = 0; r < rays_a_bone; ++r) {
      const double angle = 2 * std::numbers::pi * r / rays_a_bone;
      const auto hit = rays.first_hit(places[joint], std::cos(angle) * side + std::sin(angle) * other);
      if (hit.triangle >= 0) sum[joint] += hit.distance, ++hits[joint];
    }
  };
  for (size_t j = 0; j < joints.size(); ++j) {
    if (joints[j].parent < 0) continue;
    const auto p = static_cast<size_t>(joints[j].parent);
    if ((places[j] - places[p]).norm() > 0) cast(j, places[j] - places[p]), cast(p, places[j] - places[p]);
  }
  for (size_t j = 0; j < joints.size(); ++j) sum[j] /= std::max(hits[j], 1.0);
  return sum;
}

// The rows' partners at least cost in all (J. Munkres 1957, by shortest augmenting paths); rows <= columns.
std::vector<size_t> assignment(const Eigen::MatrixXd& cost) {
  const auto rows = static_cast<size_t>(cost.rows()), columns = static_cast<size_t>(cost.cols());
  constexpr double infinite = std::numeric_limits<double>::infinity();
  std::vector<double> row_price(rows + 1, 0), column_price(columns + 1, 0);
  std::vector<size_t> row_of(columns + 1, rows);  // `rows`: none; column `columns` holds the row being placed
  for (size_t row = 0; row < rows; ++row) {
    std::vector<double> slack(columns + 1, infinite);
    std::vector<size_t> before(columns + 1, columns);
    std::vector<bool> done(columns + 1, false);
    size_t column = columns;
    row_of[columns] = row;
    while (row_of[column] != rows) {
      done[column] = true;
      const size_t r = row_of[column];
      size_t next = columns;
      double least = infinite;
      for (size_t c = 0; c < columns; ++c) {
        if (done[c]) continue;
        const double reduced =
            cost(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c)) - row_price[r] - column_price[c];
        if (reduced < slack[c]) slack[c] = reduced, before[c] = column;
        if (slack[c] < least) least = slack[c], next = c;
      }
      for (size_t c = 0; c <= columns; ++c)
        if (done[c])
          row_price[row_of[c]] += least, column_price[c] -= least;
        else
          slack[c] -= least;
      column = next;
    }
    for (; column != columns; column = before[column]) row_of[column] = row_of[before[column]];
  }
  std::vector<size_t> column_of(rows);
  for (size_t c = 0; c < columns; ++c)
    if (row_of[c] != rows) column_of[row_of[c]] = c;
  return column_of;
}

int matched(const Points& found, const Points& truth, const std::vector<double>& tolerance) {
  const bool found_rows = found.size() <= truth.size();
  const Points &rows = found_rows ? found : truth, &columns = found_rows ? truth : found;
  Eigen::MatrixXd cost(rows.size(), columns.size());
  for (size_t r = 0; r < rows.size(); ++r)
    for (size_t c = 0; c < columns.size(); ++c)
      cost(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c)) = (rows[r] - columns[c]).norm();
  const auto partner = assignment(cost);
  int count = 0;
  for (size_t r = 0; r < rows.size(); ++r)
    count += (rows[r] - columns[partner[r]]).norm() <= tolerance[found_rows ? partner[r] : r];
  return count;
}

}  // namespace

SkeletonMetrics compare_skeletons(const std::vector<Joint>& found, const std::vector<Joint>& truth,
                                  const TriangleMesh& body) {
  const double unit = (body.positions.colwise().maxCoeff() - body.positions.colwise().minCoeff()).maxCoeff();
  const Points a = places_of(found), b = places_of(truth);
  const auto bones_a = bones_of(found), bones_b = bones_of(truth);
  constexpr double step = 0.005;
  const Points along_a = along(bones_a, step * unit), along_b = along(bones_b, step * unit);
  const double match = matched(a, b, radii(truth, body));
  return {.joints_to_joints = (mean_distance(a, b) + mean_distance(b, a)) / 2 / unit,
          .joints_to_bones = (mean_distance(a, bones_b) + mean_distance(b, bones_a)) / 2 / unit,
          .bones_to_bones = (mean_distance(along_a, bones_b) + mean_distance(along_b, bones_a)) / 2 / unit,
          .iou = 2 * match / static_cast<double>(a.size() + b.size()),
          .precision = match / static_cast<double>(a.size()),
          .recall = match / static_cast<double>(b.size())};
}

}  // namespace focal_test
