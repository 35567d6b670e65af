#include "skeleton/leak_filter.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

#include "model/landmark_model.h"

namespace focal {
namespace {

constexpr float moves = 0.05F;         // smaller weights do not count for a joint's reach
constexpr double room = 1.25;          // for bodies that are stouter than the training characters
constexpr double min_reach = 0.03;     // of sqrt(area)
constexpr double small_island = 0.15;  // relative to the largest part where a joint is the main one
// Relative to a bone's length: how far a joint reaches along the surface beyond its core.
constexpr double fade = 0.6;

std::vector<int32_t> main_joints(const RowMatrixf& weights) {
  std::vector<int32_t> result;
  for (Eigen::Index v = 0; v < weights.rows(); ++v) {
    Eigen::Index joint = 0;
    result.push_back(weights.row(v).maxCoeff(&joint) > 0 ? static_cast<int32_t>(joint) : -1);
  }
  return result;
}

// Connected vertices with the same main joint.
struct Island {
  int32_t joint = -1;
  double area = 0;
  std::vector<int32_t> vertices;
};

std::vector<Island> islands_of(const std::vector<int32_t>& main, const SurfaceAnalysis& analysis) {
  std::vector<Island> islands;
  std::vector<char> seen(main.size(), 0);
  for (size_t start = 0; start < main.size(); ++start) {
    if (seen[start] || main[start] < 0) continue;
    Island island{main[start], 0, {static_cast<int32_t>(start)}};
    seen[start] = 1;
    for (size_t i = 0; i < island.vertices.size(); ++i) {
      const int32_t v = island.vertices[i];
      island.area += analysis.operators.mass[v];
      for (SparseMatrix::InnerIterator it(analysis.operators.L, v); it; ++it)
        if (!seen[it.row()] && main[it.row()] == island.joint)
          seen[it.row()] = 1, island.vertices.push_back(static_cast<int32_t>(it.row()));
    }
    islands.push_back(std::move(island));
  }
  return islands;
}

// Removes a joint as the main one from small separate parts of the surface where another joint's bone is
// nearer.
bool drop_islands(RowMatrixf& weights, const SurfaceAnalysis& analysis, const RowMatrixf& distance) {
  const std::vector<Island> islands = islands_of(main_joints(weights), analysis);
  std::vector<double> largest(static_cast<size_t>(weights.cols()), 0);
  for (const Island& one : islands) largest[one.joint] = std::max(largest[one.joint], one.area);
  bool any = false;
  for (const Island& one : islands) {
    if (one.area >= small_island * largest[one.joint]) continue;
    for (const int32_t v : one.vertices)
      if (distance(v, one.joint) > distance.row(v).minCoeff()) weights(v, one.joint) = 0, any = true;
  }
  return any;
}

// Lengths of the shortest edge paths from the vertices where the joint is the main one, up to `most`.
std::vector<float> ways_from_core(const std::vector<int32_t>& main, int32_t joint, float most,
                                  const SurfaceAnalysis& analysis) {
  std::vector<float> way(main.size(), std::numeric_limits<float>::infinity());
  using Step = std::pair<float, int32_t>;
  std::priority_queue<Step, std::vector<Step>, std::greater<>> front;
  for (size_t v = 0; v < main.size(); ++v)
    if (main[v] == joint) way[v] = 0, front.emplace(0, static_cast<int32_t>(v));
  const MatrixX3& positions = analysis.surface().positions;
  while (!front.empty()) {
    const auto [length, v] = front.top();
    front.pop();
    if (length > way[v] || length > most) continue;
    for (SparseMatrix::InnerIterator it(analysis.operators.L, v); it; ++it) {
      const float next = length + static_cast<float>((positions.row(it.row()) - positions.row(v)).norm());
      if (next < way[it.row()]) way[it.row()] = next, front.emplace(next, static_cast<int32_t>(it.row()));
    }
  }
  return way;
}

// The length of the longest bone of each joint.
std::vector<float> bone_lengths(const PlacedSkeleton& skeleton) {
  std::vector<float> length(skeleton.joints.size(), 0);
  for (size_t j = 0; j < length.size(); ++j) {
    length[j] = std::max(length[j], static_cast<float>((skeleton.tip[j] - skeleton.place[j]).norm()));
    if (const int32_t p = skeleton.joints[j].parent; p >= 0)
      length[p] = std::max(length[p], static_cast<float>((skeleton.place[j] - skeleton.place[p]).norm()));
  }
  return length;
}

void drop_far_along_surface(RowMatrixf& weights, const SurfaceAnalysis& analysis,
                            const PlacedSkeleton& skeleton) {
  const std::vector<int32_t> main = main_joints(weights);
  const std::vector<float> length = bone_lengths(skeleton);
  for (Eigen::Index j = 0; j < weights.cols(); ++j) {
    const auto most = static_cast<float>(std::max(fade * length[j], min_reach));
    const auto way = ways_from_core(main, static_cast<int32_t>(j), most, analysis);
    for (Eigen::Index v = 0; v < weights.rows(); ++v)
      if (way[v] > most) weights(v, j) = 0;
  }
}

// The nearest of the joints within reach; of all joints where none is.
Eigen::Index nearest_joint(const Eigen::Ref<const Eigen::RowVectorXf>& distance,
                           const std::vector<float>& reach) {
  Eigen::Index best = 0;
  float least = std::numeric_limits<float>::infinity();
  for (Eigen::Index j = 0; j < distance.size(); ++j)
    if (reach[j] > 0 && distance[j] < least) least = distance[j], best = j;
  return best;
}

}  // namespace

WeightHabits habits_of(const Teachers& teachers, const PlacedSkeleton& skeleton,
                       const std::vector<MatrixX3>& posed) {
  const auto joints = static_cast<Eigen::Index>(skeleton.joints.size());
  WeightHabits habits{std::vector<float>(skeleton.joints.size(), 0), RowMatrixf::Identity(joints, joints)};
  for (size_t m = 0; m < posed.size(); ++m) {
    const ShapeRig& rig = *teachers.model.exemplars[teachers.maps[m].shape].rig;
    const RowMatrixf distance = bone_distances(skeleton, posed[m]);
    for (size_t i = 0; i < rig.influences.size(); ++i)
      for (const Influence& a : rig.influences[i]) {
        if (a.weight < moves) continue;
        const float away = distance(static_cast<Eigen::Index>(i), a.joint);
        const auto reach = static_cast<float>(std::max(room * away, min_reach));
        habits.reach[a.joint] = std::max(habits.reach[a.joint], reach);
        for (const Influence& b : rig.influences[i])
          if (b.weight >= moves) habits.together(a.joint, b.joint) = 1;
      }
  }
  for (Eigen::Index j = 0; j < joints; ++j)
    if (const int32_t p = skeleton.joints[j].parent; p >= 0)
      habits.together(j, p) = habits.together(p, j) = 1;
  return habits;
}

void drop_leaks(RowMatrixf& weights, const SurfaceAnalysis& analysis, const PlacedSkeleton& skeleton,
                const WeightHabits& habits) {
  const RowMatrixf distance = bone_distances(skeleton, analysis.surface().positions);
  RowMatrixf kept = weights;
  for (Eigen::Index v = 0; v < kept.rows(); ++v)
    for (Eigen::Index j = 0; j < kept.cols(); ++j)
      if (distance(v, j) > habits.reach[j]) kept(v, j) = 0;
  constexpr int rounds = 4;
  for (int round = 0; round < rounds && drop_islands(kept, analysis, distance); ++round) {
  }
  drop_far_along_surface(kept, analysis, skeleton);
  const std::vector<int32_t> main = main_joints(kept);
  for (Eigen::Index v = 0; v < kept.rows(); ++v) {
    if (main[v] < 0) {
      kept(v, nearest_joint(distance.row(v), habits.reach)) = 1;
      continue;
    }
    kept.row(v) = kept.row(v).cwiseProduct(habits.together.row(main[v]));
    kept.row(v) /= kept.row(v).sum();
  }
  weights = std::move(kept);
}

}  // namespace focal
