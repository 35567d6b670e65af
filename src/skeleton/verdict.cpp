#include "skeleton/verdict.h"

#include <algorithm>
#include <cmath>

#include "mesh/nearest_vertex.h"
#include "skeleton/bone_names.h"

namespace focal {
namespace {

// Fitted on 167 rigs of real characters, animals and the generator's characters (docs/accuracy.md): 62 sound,
// 70 of another category than the model's, the rest reversed or tangled. A logistic regression of the
// measures together: the badness of each rises from 0 at `fine` to 1 at `bad` and subtracts `weight` from the
// log odds. From `doubted` on a warning reports it.
struct Indication {
  double RigMeasures::*measure;
  double fine, bad, weight, doubted;
  const char* doubt;
};
constexpr double best_odds = 4.6;  // logarithm
constexpr Indication indications[] = {
    {&RigMeasures::bulge_agreement, 0.25, 0, 1.9, 0.7,
     "the surface bulges elsewhere than on the training characters"},
    {&RigMeasures::surface_distance, 0.035, 0.08, 2.5, 0.7,
     "no training character, bent and stretched, comes near the surface"},
    {&RigMeasures::bone_strain, 0.1, 0.5, 1.8, 0.5,
     "the lengths of the bones are unlike those of the training characters"},
    {&RigMeasures::uncovered, 0.04, 0.2, 2.6, 0.6,
     "a training character that takes this pose does not cover the mesh"},
    {&RigMeasures::category_fit, 0.4, 0, 1.5, 0.7, "the mesh is unlike the training characters of the model"},
    {&RigMeasures::heading_margin, 0.06, 0, 0.3, 0.7,
     "a training character that faces the other way fits the surface nearly as well"}};

// Defects that count regardless of the rest: factors, 1 up to `fine`, then linear to `least` at `bad` and
// beyond.
struct Criterion {
  double RigMeasures::*measure;
  double fine, bad, least;
  const char* doubt;
};
constexpr Criterion criteria[] = {
    {&RigMeasures::map_residual, 0.66, 0.8, 0.6, "no training character fits the surface well"},
    {&RigMeasures::cost_margin, 2, 0, 0.8,
     "another pose in the mesh, turned or mirrored, fits nearly as well"},
    {&RigMeasures::joint_spread, 0.4, 0.9, 0.8, "the training characters disagree on where the joints are"},
    {&RigMeasures::absent_share, 0.15, 0.7, 0.3, "many joints are in parts of the body that were not found"},
    {&RigMeasures::outside_share, 0, 0.15, 0.15, "joints are far outside the body"},
    {&RigMeasures::long_share, 0, 0.08, 0.15, "bones are longer than most of the body"},
    {&RigMeasures::collapsed_share, 0, 0.2, 0.2, "bones have no length"},
    {&RigMeasures::merged_share, 0, 0.25, 0.2, "joints of the left and the right side coincide"},
    {&RigMeasures::crossed_share, 0.05, 0.3, 0.2, "bones of one side cross over to the other"}};
// By cross-validation over the characters: of the 57 rigs above the first 55 are sound, of the 99 below the
// second 3.
constexpr double good_quality = 0.6, failed_quality = 0.3;
constexpr double doubted_factor = 0.85;

// Lengths relative to the longest side of the body's bounding box.
constexpr double far_outside = 0.1, longest_bone = 0.6, no_length = 0.004, real_length = 0.015,
                 merged_gap = 0.01, over_the_middle = 0.03;
constexpr double stretch_allowed = 1.5;  // relative to the longest such bone of the training characters
constexpr double min_ratio = 1e-3;       // smaller lengths count as equal

// 0 where it is fine or not measured, 1 where it is bad.
template <class Measure>
double badness_of(const Measure& one, const RigMeasures& measures) {
  const double value = measures.*one.measure;
  return std::isnan(value) ? 0 : std::clamp((value - one.fine) / (one.bad - one.fine), 0.0, 1.0);
}

double factor_of(const Criterion& one, const RigMeasures& measures) {
  return 1 - (1 - one.least) * badness_of(one, measures);
}

double share(double part, double whole) { return whole > 0 ? part / whole : 0; }

// A skeleton for comparing lengths, independent of its size.
struct Figure {
  // Of the joints, in units of the longest side of the body's bounding box.
  std::vector<std::optional<Vector3>> place;
  std::vector<int32_t> parent, pair;  // pair: the joint on the other side; -1: none
  std::vector<char> is_left;
  Vector3 low = Vector3::Zero(), high = Vector3::Zero();

  // Length of the bone that ends in the joint; negative: none.
  double length(size_t joint) const {
    const int32_t p = parent[joint];
    return p < 0 || !place[joint] || !place[p] ? -1 : (*place[joint] - *place[p]).norm();
  }
  double gap(size_t joint) const {  // to its counterpart; negative: none
    const int32_t other = pair[joint];
    return other < 0 || !place[joint] || !place[other] ? -1 : (*place[joint] - *place[other]).norm();
  }
};

std::vector<int32_t> pairs_of(const std::vector<Joint>& joints) {
  std::vector<int32_t> result(joints.size(), -1);
  for (size_t j = 0; j < joints.size(); ++j)
    if (const auto name = mirrored_name(joints[j].name))
      for (size_t k = 0; k < joints.size(); ++k)
        if (joints[k].name == *name) result[j] = static_cast<int32_t>(k);
  return result;
}

void set_box(Figure& figure, const MatrixX3& positions) {
  const Vector3 low = positions.colwise().minCoeff(), high = positions.colwise().maxCoeff();
  const double size = std::max((high - low).maxCoeff(), 1e-30);
  figure.low = low / size, figure.high = high / size;
  for (auto& place : figure.place)
    if (place) *place /= size;
}

Figure figure_of(const CharacterRig& rig, const MatrixX3& positions) {
  Figure result;
  for (const Joint& joint : rig.rig.joints) {
    result.place.emplace_back(joint.bind.topRightCorner<3, 1>());
    result.parent.push_back(joint.parent);
  }
  result.pair = pairs_of(rig.rig.joints);
  for (size_t j = 0; j < result.pair.size(); ++j)  // "left" is before "right" in every spelling
    result.is_left.push_back(result.pair[j] >= 0 &&
                             rig.rig.joints[j].name < rig.rig.joints[result.pair[j]].name);
  set_box(result, positions);
  return result;
}

// Shapes of the exemplars with a rig: those most similar to the mesh, else all.
std::vector<const Exemplar*> teachers_of(const Detection& detection) {
  std::vector<const Exemplar*> result;
  const auto& exemplars = detection.model->exemplars;
  const auto add = [&](const Exemplar& shape) {
    if (shape.rig && shape.positions.rows() > 0) result.push_back(&shape);
  };
  for (const int32_t number : detection.exemplars) add(exemplars[number]);
  if (result.empty()) std::for_each(exemplars.begin(), exemplars.end(), add);
  return result;
}

// Whether the joints are those that the model has learned, not those of a template.
bool is_learned(const std::vector<SkeletonJoint>& skeleton, const std::vector<Joint>& joints) {
  return std::equal(skeleton.begin(), skeleton.end(), joints.begin(), joints.end(),
                    [](const SkeletonJoint& a, const Joint& b) { return a.name == b.name; });
}

std::vector<Figure> teachers_figures(const std::vector<const Exemplar*>& teachers, const Figure& like) {
  std::vector<Figure> result;
  for (const Exemplar* teacher : teachers) {
    Figure figure{{}, like.parent, like.pair, like.is_left};
    for (const auto& bind : teacher->rig->bind)
      figure.place.push_back(bind ? std::optional<Vector3>(bind->topRightCorner<3, 1>()) : std::nullopt);
    set_box(figure, teacher->positions);
    result.push_back(std::move(figure));
  }
  return result;
}

// Range of a length of the figure on the training characters: empty where none of them has it.
struct Range {
  double least = std::numeric_limits<double>::infinity(), most = 0, log_sum = 0;
  int32_t count = 0;
  void add(double length) {
    if (length < 0) return;
    least = std::min(least, length), most = std::max(most, length), ++count;
    log_sum += std::log(std::max(length, min_ratio));
  }
};

void measure_bones(const Figure& figure, const std::vector<Figure>& teachers, RigMeasures& out) {
  double bones = 0, too_long = 0, collapsed = 0, strain = 0, strained = 0;
  for (size_t j = 0; j < figure.place.size(); ++j) {
    const double length = figure.length(j);
    if (length < 0) continue;
    Range taught;
    for (const Figure& teacher : teachers) taught.add(teacher.length(j));
    ++bones;
    too_long += length > longest_bone && length > stretch_allowed * taught.most;
    if (taught.count == 0) continue;
    collapsed += length < no_length && taught.least > real_length;
    if (taught.least < real_length) continue;  // the length of short bones is noise
    strain += std::abs(std::log(std::max(length, min_ratio)) - taught.log_sum / taught.count);
    ++strained;
  }
  out.long_share = share(too_long, bones), out.collapsed_share = share(collapsed, bones);
  out.bone_strain = share(strain, strained);
}

// The plane between the sides: {x: across . x = offset}; empty where no pair is apart.
struct Middle {
  Vector3 across;
  double offset = 0;
};
std::optional<Middle> middle_of(const Figure& figure) {
  Middle result{Vector3::Zero()};
  std::vector<Vector3> between;
  for (size_t j = 0; j < figure.place.size(); ++j) {
    if (!figure.is_left[j]) continue;
    const Vector3 &left = *figure.place[j], &right = *figure.place[figure.pair[j]];
    // Each pair has the same weight, whatever its distance.
    result.across += (right - left).stableNormalized();
    between.push_back((left + right) / 2);
  }
  if (between.empty() || !(result.across.norm() > 1e-9)) return std::nullopt;
  result.across.normalize();
  std::vector<double> along;
  for (const Vector3& one : between) along.push_back(one.dot(result.across));
  const auto half = along.begin() + static_cast<std::ptrdiff_t>(along.size() / 2);
  std::nth_element(along.begin(), half, along.end());
  result.offset = *half;
  return result;
}

void measure_sides(const Figure& figure, const std::vector<Figure>& teachers, RigMeasures& out) {
  double pairs = 0, merged = 0, bones = 0, crossed = 0;
  for (size_t j = 0; j < figure.place.size(); ++j) {
    if (!figure.is_left[j]) continue;
    Range taught;
    for (const Figure& teacher : teachers) taught.add(teacher.gap(j));
    ++pairs, merged += figure.gap(j) < merged_gap && (taught.count == 0 || taught.least > real_length);
  }
  out.merged_share = share(merged, pairs);
  const auto middle = middle_of(figure);
  if (!middle) return;
  const auto side = [&](int32_t joint) { return figure.place[joint]->dot(middle->across) - middle->offset; };
  for (size_t j = 0; j < figure.place.size(); ++j) {
    const int32_t p = figure.parent[j];
    if (p < 0 || figure.pair[j] < 0 || figure.pair[p] < 0) continue;
    const double from = side(p), to = side(static_cast<int32_t>(j));
    ++bones, crossed += from * to < 0 && std::min(std::abs(from), std::abs(to)) > over_the_middle;
  }
  out.crossed_share = share(crossed, bones);
}

void measure_outside(const Figure& figure, const Rig& rig, RigMeasures& out) {
  std::vector<char> moves(rig.joints.size(), rig.influences.empty());  // controls may be anywhere
  for (const VertexInfluences& influences : rig.influences)
    for (const Influence& one : influences)
      if (one.weight > 0) moves[one.joint] = 1;
  double joints = 0, outside = 0;
  for (size_t j = 0; j < moves.size(); ++j) {
    if (!moves[j]) continue;
    const Vector3& p = *figure.place[j];
    const double away = std::max((figure.low - p).maxCoeff(), (p - figure.high).maxCoeff());
    ++joints, outside += away > far_outside || !p.allFinite();
  }
  out.outside_share = share(outside, joints);
}

// The most similar training character, posed by the detected joints: the distance from it that a twentieth of
// the mesh exceeds. A mean would hide missing legs.
double uncovered(const Exemplar& teacher, const Rig& rig, const SurfaceAnalysis& analysis) {
  const ToCaller to_caller(analysis);
  std::vector<Matrix4> motion;
  for (size_t j = 0; j < rig.joints.size(); ++j) {
    Matrix4 found = rig.joints[j].bind;
    found.topRightCorner<3, 1>() = (found.topRightCorner<3, 1>() - to_caller.offset) / to_caller.scale;
    const int32_t p = rig.joints[j].parent;
    const auto& bind = teacher.rig->bind[j];
    motion.push_back(bind     ? Matrix4(found * bind->inverse())
                     : p >= 0 ? motion[p]
                              : Matrix4(Matrix4::Identity()));
  }
  const MatrixX3 copy = skinned(teacher.positions, teacher.rig->influences, motion);
  if (!copy.allFinite()) return std::numeric_limits<double>::infinity();
  const MatrixX3& mesh = analysis.surface().positions;
  const NearestVertex nearest(copy);
  std::vector<double> away;
  for (Eigen::Index v = 0; v < mesh.rows(); ++v)
    away.push_back(std::sqrt(nearest.nearest(mesh.row(v).transpose()).second));
  const auto twentieth = away.begin() + static_cast<std::ptrdiff_t>(away.size() * 19 / 20);
  std::nth_element(away.begin(), twentieth, away.end());
  return *twentieth;
}

}  // namespace

std::vector<std::string> guessed_joints(const Detection& detection) {
  std::vector<std::string> result;
  for (const SkeletonJoint& joint : detection.model->skeleton) {
    int32_t own = 0, absent = 0;
    for (size_t l = 0; l < detection.places.size(); ++l)
      if (detection.model->landmark_names[l].starts_with(joint.name + " "))
        ++own, absent += detection.places[l].triangle < 0;
    if (own > 0 && absent == own) result.push_back(joint.name);
  }
  return result;
}

RigMeasures rig_measures(const Detection& detection, const CharacterRig& rig) {
  RigMeasures result;
  const auto& joints = rig.rig.joints;
  result.category_fit = detection.category_fit;
  if (!detection.exemplars.empty())
    result.bulge_agreement = detection.bulge_agreement, result.cost_margin = detection.cost_margin;
  if (!detection.maps.empty()) result.map_residual = detection.map_residual;
  result.surface_distance = rig.surface_distance, result.heading_margin = rig.heading_margin;
  double doubt = 0, doubted = 0;
  for (size_t j = 0; j < rig.confidence.size(); ++j)
    if (rig.left_out.empty() || !rig.left_out[j]) doubt += 1 - rig.confidence[j], ++doubted;
  result.joint_spread = share(doubt, doubted);
  const bool learned = is_learned(detection.model->skeleton, joints);
  const auto unsure = std::count(rig.confidence.begin(), rig.confidence.end(), 0.0);
  const auto guessed = learned ? guessed_joints(detection).size() : static_cast<size_t>(unsure);
  result.absent_share = share(static_cast<double>(guessed), static_cast<double>(joints.size()));
  const auto teachers = learned ? teachers_of(detection) : std::vector<const Exemplar*>{};
  const Figure figure = figure_of(rig, analysed_positions(*detection.mesh));
  const std::vector<Figure> taught = teachers_figures(teachers, figure);
  measure_bones(figure, taught, result);
  measure_sides(figure, taught, result);
  measure_outside(figure, rig.rig, result);
  if (!teachers.empty() && detection.analysis)
    result.uncovered = uncovered(*teachers[0], rig.rig, *detection.analysis);
  return result;
}

double rig_quality(const RigMeasures& measures) {
  double odds = best_odds;
  for (const Indication& one : indications) odds -= one.weight * badness_of(one, measures);
  double quality = (1 + std::exp(-best_odds)) / (1 + std::exp(-odds));
  for (const Criterion& one : criteria) quality *= factor_of(one, measures);
  return quality;
}

Verdict verdict_of(const RigMeasures& measures) {
  const double quality = rig_quality(measures);
  return quality >= good_quality     ? Verdict::good
         : quality >= failed_quality ? Verdict::check
                                     : Verdict::failed;
}

const char* name_of(Verdict verdict) {
  return verdict == Verdict::good ? "good" : verdict == Verdict::check ? "check" : "failed";
}

// Fitted on 1466 joints of 82 rigs, by three models, of characters that were not in the training set or came
// from other packs; by cross-validation over the characters the expected calibration error is 0.05. Agreement
// has little influence: the fits of a body usually have a common error.
void calibrate_confidence(double quality, const FixedJoints& fixed, CharacterRig& rig) {
  constexpr double offset = -0.05, slope = 0.48, min_quality = 0.02, enough_agreement = 0.5;
  const double q = std::clamp(quality, min_quality, 1 - min_quality);
  const double chance = 1 / (1 + std::exp(-offset - slope * std::log(q / (1 - q))));
  for (size_t j = 0; j < rig.confidence.size(); ++j)
    if (fixed.empty() || !fixed[j])
      rig.confidence[j] = chance * std::min(1.0, rig.confidence[j] / enough_agreement);
}

std::vector<std::string> doubts_about(const RigMeasures& measures) {
  std::vector<std::pair<double, const char*>> found;
  for (const Indication& one : indications)
    if (const double badness = badness_of(one, measures); badness > one.doubted)
      found.emplace_back(1 - badness, one.doubt);
  for (const Criterion& one : criteria)
    if (const double factor = factor_of(one, measures); factor < doubted_factor)
      found.emplace_back(factor, one.doubt);
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::string> result;
  for (const auto& [factor, doubt] : found) result.emplace_back(doubt);
  return result;
}

}  // namespace focal
