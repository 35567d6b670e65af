#include "skeleton/character_rig.h"

#include <algorithm>

#include "skeleton/bone_names.h"

namespace focal {
namespace {

constexpr float min_weight = 0.02f;  // lighter influences are dropped

}  // namespace

std::vector<std::string> names_of(const std::vector<Joint>& joints) {
  std::vector<std::string> names;
  for (const Joint& joint : joints) names.push_back(joint.name);
  return names;
}

std::vector<int32_t> other_sides(const std::vector<Joint>& joints) {
  std::vector<int32_t> result;
  for (const Joint& joint : joints) {
    const auto name = mirrored_name(joint.name);
    const auto other = std::find_if(joints.begin(), joints.end(),
                                    [&](const Joint& one) { return name && one.name == *name; });
    result.push_back(other == joints.end() ? -1 : static_cast<int32_t>(other - joints.begin()));
  }
  return result;
}

std::vector<Vector3> bone_directions(const std::vector<int32_t>& parent, const std::vector<Vector3>& place,
                                     const std::vector<Vector3>& tip) {
  std::vector<Vector3> way(place.size(), Vector3::Zero());
  for (size_t j = 0; j < way.size(); ++j)
    if (const int32_t p = parent[j]; p >= 0) way[p] += place[j] - place[p];
  for (size_t j = 0; j < way.size(); ++j)
    if (way[j].isZero()) way[j] = tip[j] - place[j];
  return way;
}

ToCaller::ToCaller(const SurfaceAnalysis& analysis) {
  const PreparedMesh& full = *analysis.proxy.full;
  scale = full.scale, offset = full.centre;
  if (analysis.proxy.is_full()) return;
  offset += scale * analysis.proxy.coarse->centre;
  scale *= analysis.proxy.coarse->scale;
}

void clear_influences(size_t vertices, int32_t most, Rig& rig) {
  rig.influences.assign(vertices, {});
  rig.more.assign(most > max_influences ? vertices : 0, {});
}

void put_influences(const Eigen::Ref<const Eigen::RowVectorXf>& weights, int32_t most, size_t vertex,
                    Rig& rig) {
  std::vector<Influence> influences;
  const float total = weights.sum();
  for (Eigen::Index j = 0; j < weights.size(); ++j)
    if (weights[j] > min_weight * total) influences.push_back({static_cast<int32_t>(j), weights[j]});
  put_influences(heaviest(influences, static_cast<size_t>(most)), vertex, rig);
}

std::vector<Influence> influences_of(const Rig& rig, size_t vertex) {
  std::vector<Influence> all(rig.influences[vertex].begin(), rig.influences[vertex].end());
  if (!rig.more.empty()) all.insert(all.end(), rig.more[vertex].begin(), rig.more[vertex].end());
  std::erase_if(all, [](const Influence& one) { return !(one.weight > 0); });
  return all;
}

void put_influences(const std::vector<Influence>& influences, size_t vertex, Rig& rig) {
  rig.influences[vertex] = {};
  if (!rig.more.empty()) rig.more[vertex] = {};
  for (size_t i = 0; i < influences.size(); ++i)
    (i < max_influences ? rig.influences : rig.more)[vertex][i % max_influences] = influences[i];
}

void put_influences_on_source(const RowMatrixf& weights, const SurfaceAnalysis& analysis, int32_t most,
                              Rig& rig, const Execution& execution) {
  const auto places = coarse_place_of_vertices(analysis.proxy, execution);
  const std::vector<int32_t>& place_of = analysis.proxy.full->surface_vertex;
  const auto count = static_cast<int64_t>(place_of.size());
  clear_influences(place_of.size(), most, rig);
  parallel_for_ranges(execution, count, 1024, [&](int64_t begin, int64_t end) {
    for (int64_t v = begin; v < end; ++v) {
      if (place_of[v] < 0) continue;
      const SurfacePoint& place = places[place_of[v]];
      Eigen::RowVectorXf mixed = Eigen::RowVectorXf::Zero(weights.cols());
      for (int c = 0; c < 3; ++c)
        mixed += static_cast<float>(place.barycentric[c]) *
                 weights.row(analysis.surface().triangles(place.triangle, c));
      put_influences(mixed, most, static_cast<size_t>(v), rig);
    }
  });
}

void make_bones_symmetric(CharacterRig& character) {
  auto& joints = character.rig.joints;
  const std::vector<int32_t> other = other_sides(joints);
  const auto place = [&](size_t j) { return place_of(joints[j]); };
  std::vector<double> length(joints.size(), 0);  // before the change
  for (size_t j = 0; j < joints.size(); ++j)
    if (joints[j].parent >= 0) length[j] = (place(j) - place(static_cast<size_t>(joints[j].parent))).norm();
  for (size_t j = 0; j < joints.size(); ++j) {
    if (other[j] < 0 || joints[j].parent < 0) continue;
    const auto pair = static_cast<size_t>(other[j]);
    const double mine = character.confidence[j] + 1e-3, theirs = character.confidence[pair] + 1e-3;
    const double agreed = (mine * length[j] + theirs * length[pair]) / (mine + theirs);
    const Vector3 parent = place(static_cast<size_t>(joints[j].parent));
    const Vector3 way = (place(j) - parent).stableNormalized();
    joints[j].bind.topRightCorner<3, 1>() = parent + agreed * way;
  }
}

}  // namespace focal
