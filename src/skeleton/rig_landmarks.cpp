#include "skeleton/rig_landmarks.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace focal {
namespace {

constexpr double min_apart = 0.05;  // in sqrt(area): nearer landmarks are redundant
constexpr const char* axis_names[] = {"x", "y", "z"};

// One landmark on every shape of the set.
struct Candidate {
  std::string name;
  std::vector<std::optional<SurfacePoint>> marks;
};

// Points on edges where a joint's part of the surface starts: its weight crosses one half.
std::vector<SurfacePoint> ring_of(const TriangleMesh& surface, const RowMatrixf& below, int32_t joint) {
  std::vector<SurfacePoint> ring;
  for (int32_t t = 0; t < surface.triangle_count(); ++t)
    for (int i = 0; i < 3; ++i) {
      const int k = (i + 1) % 3;
      const double a = below(surface.triangles(t, i), joint) - 0.5,
                   b = below(surface.triangles(t, k), joint) - 0.5;
      if ((a < 0) == (b < 0)) continue;
      SurfacePoint point{t, Vector3::Zero()};
      point.barycentric[k] = a / (a - b), point.barycentric[i] = 1 - point.barycentric[k];
      ring.push_back(point);
    }
  return ring;
}

std::vector<std::vector<SurfacePoint>> rings_on_all(const TrainingSet& set,
                                                    const std::vector<RowMatrixf>& below, int32_t joint) {
  std::vector<std::vector<SurfacePoint>> rings;
  for (size_t s = 0; s < set.shapes.size(); ++s)
    rings.push_back(set.shapes[s].rig->bind[joint] ? ring_of(set.shapes[s].mesh->surface, below[s], joint)
                                                   : std::vector<SurfacePoint>{});
  return rings;
}

Vector3 mean_position(const TriangleMesh& surface, const std::vector<SurfacePoint>& points) {
  Vector3 sum = Vector3::Zero();
  for (const auto& point : points) sum += position_of(surface, point);
  return sum / static_cast<double>(points.size());
}

// The two axes of the world across which the rings are placed, the same for all shapes: a rig has one
// heading.
std::array<int, 2> axes_across(const TrainingSet& set, const std::vector<std::vector<SurfacePoint>>& rings) {
  Vector3 spread = Vector3::Zero();
  for (size_t s = 0; s < rings.size(); ++s) {
    if (rings[s].empty()) continue;
    const TriangleMesh& surface = set.shapes[s].mesh->surface;
    const Vector3 centre = mean_position(surface, rings[s]);
    for (const auto& point : rings[s])
      spread += (position_of(surface, point) - centre).cwiseAbs() / static_cast<double>(rings[s].size());
  }
  int least = 0;
  spread.minCoeff(&least);
  return {(least + 1) % 3, (least + 2) % 3};
}

SurfacePoint farthest_along(const TriangleMesh& surface, const std::vector<SurfacePoint>& points,
                            const Vector3& direction) {
  return *std::max_element(points.begin(), points.end(), [&](const SurfacePoint& a, const SurfacePoint& b) {
    return direction.dot(position_of(surface, a)) < direction.dot(position_of(surface, b));
  });
}

void add_ring_points(const TrainingSet& set, const std::vector<RowMatrixf>& below, int32_t joint,
                     std::vector<Candidate>& candidates) {
  const auto rings = rings_on_all(set, below, joint);
  for (const int axis : axes_across(set, rings))
    for (const double sign : {1.0, -1.0}) {
      Candidate candidate{set.skeleton[joint].name + (sign > 0 ? " +" : " -") + axis_names[axis], {}};
      for (size_t s = 0; s < rings.size(); ++s) {
        candidate.marks.emplace_back();
        if (!rings[s].empty())
          candidate.marks.back() =
              farthest_along(set.shapes[s].mesh->surface, rings[s], sign * Vector3::Unit(axis));
      }
      candidates.push_back(std::move(candidate));
    }
}

void add_tip(const TrainingSet& set, int32_t joint, std::vector<Candidate>& candidates) {
  Candidate candidate{set.skeleton[joint].name + " tip", {}};
  for (const MarkedShape& shape : set.shapes) {
    candidate.marks.emplace_back();
    Eigen::Index vertex = 0;
    if (shape.rig->bind[joint] &&
        (shape.mesh->surface.positions.rowwise() - shape.rig->tip[joint].transpose())
                .rowwise()
                .squaredNorm()
                .minCoeff(&vertex) < 1e-12)
      candidate.marks.back() = at_vertex(shape.mesh->surface, static_cast<int32_t>(vertex));
  }
  candidates.push_back(std::move(candidate));
}

// Mean distance of two candidates over the shapes that have both; infinite without any.
double distance_between(const TrainingSet& set, const Candidate& a, const Candidate& b) {
  double sum = 0, count = 0;
  for (size_t s = 0; s < set.shapes.size(); ++s) {
    if (!a.marks[s] || !b.marks[s]) continue;
    const TriangleMesh& surface = set.shapes[s].mesh->surface;
    sum += (position_of(surface, *a.marks[s]) - position_of(surface, *b.marks[s])).norm(), ++count;
  }
  return count > 0 ? sum / count : std::numeric_limits<double>::infinity();
}

// Joints without a descendant that has a part of the surface on most shapes: markers at the ends of fingers
// move one vertex or none.
std::vector<char> ends_of_limbs(const TrainingSet& set) {
  std::vector<int32_t> parts(set.skeleton.size(), 0);
  for (const MarkedShape& shape : set.shapes)
    for (size_t j = 0; j < parts.size(); ++j)
      if (const auto& bind = shape.rig->bind[j])
        parts[j] += (shape.rig->tip[j] - bind->topRightCorner<3, 1>()).norm() > 0;
  std::vector<char> result(set.skeleton.size(), 0),
      has_part(set.skeleton.size(), 0);  // at or below the joint
  for (size_t j = set.skeleton.size(); j-- > 0;) {
    const bool own = 2 * parts[j] > static_cast<int32_t>(set.shapes.size());
    result[j] = own && !has_part[j];
    has_part[j] |= own;
    if (const int32_t p = set.skeleton[j].parent; p >= 0) has_part[p] |= has_part[j];
  }
  return result;
}

}  // namespace

RowMatrixf weights_below(const std::vector<SkeletonJoint>& skeleton,
                         const std::vector<VertexInfluences>& influences) {
  RowMatrixf result = RowMatrixf::Zero(static_cast<Eigen::Index>(influences.size()),
                                       static_cast<Eigen::Index>(skeleton.size()));
  for (size_t v = 0; v < influences.size(); ++v)
    for (const Influence& one : influences[v]) result(v, one.joint) += one.weight;
  for (size_t j = skeleton.size(); j-- > 0;)
    if (skeleton[j].parent >= 0) result.col(skeleton[j].parent) += result.col(j);
  return result;
}

std::vector<Vector3> joint_tips(const TriangleMesh& surface, const ShapeRig& rig) {
  std::vector<Vector3> tips;
  for (size_t j = 0; j < rig.bind.size(); ++j) {
    const Vector3 place = rig.bind[j] ? Vector3(rig.bind[j]->topRightCorner<3, 1>()) : Vector3::Zero();
    tips.push_back(place);
    double farthest = 0;
    for (int32_t v = 0; v < surface.vertex_count(); ++v) {
      const Influence& main = rig.influences[v][0];
      if (main.joint != static_cast<int32_t>(j) || main.weight <= 0.5f) continue;
      const Vector3 p = surface.positions.row(v);
      if (const double away = (p - place).norm(); away > farthest) farthest = away, tips.back() = p;
    }
  }
  return tips;
}

void mark_by_skeleton(TrainingSet& set, int32_t most) {
  std::vector<RowMatrixf> below;
  for (const MarkedShape& shape : set.shapes)
    below.push_back(weights_below(set.skeleton, shape.rig->influences));
  const std::vector<char> is_leaf = ends_of_limbs(set);
  std::vector<Candidate> candidates;  // tips first, which are detected best
  for (size_t j = 0; j < set.skeleton.size(); ++j)
    if (is_leaf[j]) add_tip(set, static_cast<int32_t>(j), candidates);
  for (size_t j = 0; j < set.skeleton.size(); ++j)
    if (set.skeleton[j].parent >= 0) add_ring_points(set, below, static_cast<int32_t>(j), candidates);
  std::vector<const Candidate*> kept;
  for (const Candidate& candidate : candidates) {
    const auto marked = std::count_if(candidate.marks.begin(), candidate.marks.end(),
                                      [](const auto& mark) { return mark.has_value(); });
    const bool is_new = std::all_of(kept.begin(), kept.end(), [&](const Candidate* other) {
      return distance_between(set, candidate, *other) >= min_apart;
    });
    if (static_cast<int32_t>(kept.size()) < most && 2 * marked > static_cast<int64_t>(set.shapes.size()) &&
        is_new)
      kept.push_back(&candidate);
  }
  for (const Candidate* candidate : kept) {
    set.landmark_names.push_back(candidate->name);
    for (size_t s = 0; s < set.shapes.size(); ++s) set.shapes[s].marks.push_back(candidate->marks[s]);
  }
}

}  // namespace focal
