#include "skeleton/detail_evidence.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh/nearest_vertex.h"
#include "model/landmark_model.h"

namespace focal {
namespace {

constexpr double min_length = 1e-6;

// From the branching of bones to the joint whose part is the end of the limb.
struct Chain {
  int32_t begin = 0, end = 0, tip = 0;  // tip: number of the landmark
};

std::vector<Chain> chains_of(const LandmarkModel& model) {
  std::vector<int32_t> children(model.skeleton.size(), 0);
  for (const SkeletonJoint& joint : model.skeleton)
    if (joint.parent >= 0) ++children[joint.parent];
  std::vector<Chain> result;
  const auto& names = model.landmark_names;
  for (size_t j = 0; j < model.skeleton.size(); ++j) {
    const auto tip = std::find(names.begin(), names.end(), model.skeleton[j].name + " tip");
    if (tip == names.end()) continue;
    const auto end = static_cast<int32_t>(j);
    Chain chain{end, end, static_cast<int32_t>(tip - names.begin())};
    for (int32_t p = model.skeleton[j].parent; p >= 0 && children[p] == 1; p = model.skeleton[p].parent)
      chain.begin = p;
    result.push_back(chain);
  }
  return result;
}

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Per chain the smallest ratio to another one; infinite: unknown.
template <class Distance, class Length>
std::vector<double> min_ratios(const std::vector<Chain>& chains, const Distance& distance,
                               const Length& length) {
  std::vector<double> result(chains.size(), std::numeric_limits<double>::infinity());
  for (size_t a = 0; a < chains.size(); ++a)
    for (size_t b = 0; b < chains.size(); ++b) {
      const double both = length(chains[a]) + length(chains[b]),
                   apart = a == b ? -1 : distance(chains[a], chains[b]);
      if (apart >= 0 && both > min_length) result[a] = std::min(result[a], apart / both);
    }
  return result;
}

std::vector<double> ratios_of_shape(const Exemplar& shape, const std::vector<Chain>& chains) {
  const ShapeRig& rig = *shape.rig;
  return min_ratios(
      chains,
      [&](const Chain& a, const Chain& b) {
        return shape.marked[a.tip] && shape.marked[b.tip] ? double{shape.constellation.distance(a.tip, b.tip)}
                                                          : -1;
      },
      [&](const Chain& chain) {
        const auto& bind = rig.bind[chain.begin];
        return bind ? (rig.tip[chain.end] - bind->topRightCorner<3, 1>()).norm() : 0;
      });
}

// Per chain the median over the training shapes; 0: no shape has it.
std::vector<double> taught_ratios(const LandmarkModel& model, const std::vector<Chain>& chains) {
  std::vector<std::vector<double>> all(chains.size());
  for (const Exemplar& shape : model.exemplars) {
    if (!shape.rig || shape.constellation.distance.size() == 0) continue;
    const std::vector<double> ratios = ratios_of_shape(shape, chains);
    for (size_t c = 0; c < chains.size(); ++c)
      if (std::isfinite(ratios[c])) all[c].push_back(ratios[c]);
  }
  std::vector<double> result;
  for (auto& ratios : all) result.push_back(ratios.empty() ? 0 : median(ratios));
  return result;
}

// Slightly beyond the last joint of a chain: inside the finger, if there is one. The tip itself may be
// detected on a neighbour.
Vector3 end_of(const Chain& chain, const CharacterRig& rig) {
  constexpr double beyond = 0.3;  // relative to the last bone
  const auto place = [&](int32_t j) -> Vector3 { return rig.rig.joints[j].bind.topRightCorner<3, 1>(); };
  const int32_t before = rig.rig.joints[chain.end].parent;
  return before < 0 ? place(chain.end)
                    : Vector3(place(chain.end) + beyond * (place(chain.end) - place(before)));
}

std::vector<double> found_ratios(const Detection& part, const CharacterRig& rig,
                                 const std::vector<Chain>& chains) {
  const SurfaceAnalysis& analysis = *part.analysis;
  const ToCaller to_caller(analysis);
  std::vector<int32_t> vertex;
  const NearestVertex search(analysis.surface().positions);
  for (const Chain& chain : chains)
    vertex.push_back(search.nearest((end_of(chain, rig) - to_caller.offset) / to_caller.scale).first);
  const RowMatrixf fields = analysis.metric->distances(vertex, Execution().inner());
  const auto number = [&](const Chain& chain) { return &chain - chains.data(); };
  return min_ratios(
      chains, [&](const Chain& a, const Chain& b) { return double{fields(number(a), vertex[number(b)])}; },
      [&](const Chain& chain) {
        const Vector3 begin = rig.rig.joints[chain.begin].bind.topRightCorner<3, 1>();
        return (end_of(chain, rig) - begin).norm() / to_caller.scale;
      });
}

}  // namespace

double median_separateness(const Detection& part, const CharacterRig& rig) {
  const std::vector<Chain> chains = chains_of(*part.model);
  const std::vector<double> taught = taught_ratios(*part.model, chains),
                            found = found_ratios(part, rig, chains);
  std::vector<double> ratios;
  for (size_t c = 0; c < chains.size(); ++c)
    if (taught[c] > 0 && std::isfinite(found[c])) ratios.push_back(found[c] / taught[c]);
  return ratios.empty() ? 1 : median(ratios);
}

double bone_strain(const std::vector<Vector3>& reference, const CharacterRig& rig) {
  double sum = 0, count = 0;
  for (size_t j = 0; j < reference.size(); ++j) {
    const int32_t p = rig.rig.joints[j].parent;
    if (p < 0 || rig.rig.joints[p].parent < 0) continue;  // the limb below
    const double taught = (reference[j] - reference[p]).norm();
    const double found =
        (rig.rig.joints[j].bind.topRightCorner<3, 1>() - rig.rig.joints[p].bind.topRightCorner<3, 1>())
            .norm();
    sum += std::abs(std::log(std::max(found, min_length) / std::max(taught, min_length))), ++count;
  }
  return count > 0 ? sum / count : 0;
}

}  // namespace focal
