#include "skeleton/skeleton_template.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "mesh/section.h"
#include "model/landmark_model.h"
#include "skeleton/bone_heat.h"
#include "skeleton/mirrored_rig.h"
#include "skeleton/rig_landmarks.h"

namespace focal {
namespace {

[[noreturn]] void fail(const TemplateJoint& joint, const std::string& what, const std::string& hint) {
  throw Error(Status::invalid_argument, "joint '" + joint.name + "' of the template " + what, hint);
}

// A template joint with its names resolved.
struct Rule {
  struct End {
    int32_t joint = -1, landmark = -1;  // one of them
  };
  int32_t parent = -1;
  std::vector<int32_t> centre, surface;
  std::vector<End> between;
  int32_t tip = -1;
};

int32_t index_in(const std::vector<std::string>& names, const std::string& name) {
  const auto at = std::find(names.begin(), names.end(), name);
  return at == names.end() ? -1 : static_cast<int32_t>(at - names.begin());
}

// "between" may refer to other joints, but not in a cycle.
void check_circles(const SkeletonTemplate& skeleton, const std::vector<Rule>& rules) {
  std::vector<int> state(rules.size(), 0);  // 1: being visited, 2: done
  const auto follow = [&](const auto& self, int32_t j) -> void {
    if (state[j] == 1)
      fail(skeleton.joints[j], "depends on itself through other joints", "place one of them by landmarks");
    if (state[j] == 2) return;
    state[j] = 1;
    for (const Rule::End& end : rules[j].between)
      if (end.joint >= 0) self(self, end.joint);
    state[j] = 2;
  };
  for (size_t j = 0; j < rules.size(); ++j) follow(follow, static_cast<int32_t>(j));
}

std::vector<Rule> rules_of(const SkeletonTemplate& skeleton, const std::vector<std::string>& landmarks) {
  std::vector<std::string> names;
  for (const TemplateJoint& joint : skeleton.joints) names.push_back(joint.name);
  if (names.empty()) throw Error(Status::invalid_argument, "the template has no joints", "give it one");
  std::vector<Rule> rules;
  for (const TemplateJoint& joint : skeleton.joints) {
    const auto own = static_cast<int32_t>(rules.size());
    Rule rule;
    if (joint.name.empty()) fail(joint, "has no name", "give every joint a name");
    if (index_in(names, joint.name) != own) fail(joint, "occurs twice", "give every joint its own name");
    if (!joint.parent.empty()) {
      rule.parent = index_in(names, joint.parent);
      if (rule.parent < 0 || rule.parent >= own)
        fail(joint, "has the parent '" + joint.parent + "', which does not come before it",
             "list parents first");
    }
    if (!joint.centre.empty() + !joint.surface.empty() + !joint.between.empty() != 1)
      fail(joint, "needs exactly one position", R"(give it one of "centre", "surface" and "between")");
    const auto look_up = [&](const std::string& name, const std::vector<std::string>& list,
                             const char* kind) {
      const int32_t index = index_in(list, name);
      if (index < 0) fail(joint, "refers to '" + name + "', which is not a " + kind, "check the spelling");
      return index;
    };
    for (const auto& name : joint.centre)
      rule.centre.push_back(look_up(name, landmarks, "landmark of the model"));
    for (const auto& name : joint.surface)
      rule.surface.push_back(look_up(name, landmarks, "landmark of the model"));
    for (const auto& name : joint.between) {
      const int32_t other = index_in(names, name);
      rule.between.push_back({other, other >= 0 ? -1 : look_up(name, landmarks, "joint or landmark")});
    }
    if (!joint.tip.empty()) rule.tip = look_up(joint.tip, landmarks, "landmark of the model");
    if (!joint.between.empty() && (joint.between.size() != 2 || !(joint.share >= 0 && joint.share <= 1)))
      fail(joint, "needs exactly two places for \"between\", and a share from 0 to 1",
           "give two places and a share of 0 to 1");
    rules.push_back(std::move(rule));
  }
  check_circles(skeleton, rules);
  return rules;
}

// Everything is in the coordinates of the analysed surface.
class Placer {
 public:
  Placer(const SkeletonTemplate& skeleton, const Detection& detection)
      : skeleton_(skeleton),
        detection_(detection),
        surface_(detection.analysis->surface()),
        rays_(surface_),
        rules_(rules_of(skeleton, detection.model->landmark_names)) {
    normals_ = area_normals(surface_);
  }

  void place(CharacterRig& character);
  std::vector<Bone> bones(const std::vector<Joint>& joints) const;
  const RayCaster& rays() const { return rays_; }
  const std::vector<Rule>& rules() const { return rules_; }
  std::optional<Vector3> landmark(int32_t l) const {
    if (l < 0 || detection_.places[l].triangle < 0) return std::nullopt;
    return position_of(surface_, detection_.places[l]);
  }

 private:
  struct Place {
    Vector3 position = Vector3::Zero();
    double confidence = 0;
  };
  std::optional<Place> by_landmarks(const Rule& rule) const;
  std::optional<Place> place_of_end(const Rule::End& end) const;
  bool place_between();
  void hold(size_t joint, CharacterRig& character);
  Vector3 centre_under(const SurfacePoint& point) const;

  const SkeletonTemplate& skeleton_;
  const Detection& detection_;
  const TriangleMesh& surface_;
  RayCaster rays_;
  std::vector<Rule> rules_;
  MatrixX3 normals_;
  std::vector<std::optional<Place>> places_;
};

Vector3 Placer::centre_under(const SurfacePoint& point) const {
  Vector3 normal = Vector3::Zero();
  for (int i = 0; i < 3; ++i)
    normal += point.barycentric[i] * normals_.row(surface_.triangles(point.triangle, i)).transpose();
  return section_centre(rays_, position_of(surface_, point), normal.stableNormalized());
}

std::optional<Placer::Place> Placer::by_landmarks(const Rule& rule) const {
  const bool below = !rule.centre.empty();
  Place sum;
  double count = 0;
  for (const int32_t l : below ? rule.centre : rule.surface) {
    const SurfacePoint& point = detection_.places[l];
    if (point.triangle < 0) continue;
    sum.position += below ? centre_under(point) : position_of(surface_, point);
    sum.confidence += detection_.landmarks[l].confidence, ++count;
  }
  if (count == 0) return std::nullopt;
  sum.position /= count, sum.confidence /= count;
  if (below || count > 1) sum.position = drawn_inside(rays_, sum.position);
  return sum;
}

std::optional<Placer::Place> Placer::place_of_end(const Rule::End& end) const {
  if (end.joint >= 0) return places_[end.joint];
  const auto position = landmark(end.landmark);
  if (!position) return std::nullopt;
  return Place{*position, detection_.landmarks[end.landmark].confidence};
}

// Whether another joint could be placed.
bool Placer::place_between() {
  bool any = false;
  for (size_t j = 0; j < rules_.size(); ++j) {
    const auto& ends = rules_[j].between;
    if (places_[j] || ends.empty()) continue;
    const auto a = place_of_end(ends[0]), b = place_of_end(ends[1]);
    if (!a || !b) continue;
    const double share = skeleton_.joints[j].share;
    places_[j] = Place{drawn_inside(rays_, (1 - share) * a->position + share * b->position),
                       std::min(a->confidence, b->confidence)};
    any = true;
  }
  return any;
}

void Placer::hold(size_t joint, CharacterRig& character) {
  int32_t above = rules_[joint].parent;
  while (above >= 0 && !places_[above]) above = rules_[above].parent;
  const auto other =
      above >= 0 ? places_.begin() + above
                 : std::find_if(places_.begin(), places_.end(), [](const auto& p) { return p.has_value(); });
  if (other == places_.end())
    throw Error(Status::invalid_argument, "no landmark that the template names was found on the mesh",
                "check that it belongs to the category that the model was trained on");
  character.warnings.push_back("joint '" + skeleton_.joints[joint].name +
                               "': none of its landmarks was found on this mesh, it is placed at '" +
                               skeleton_.joints[static_cast<size_t>(other - places_.begin())].name + "'");
  places_[joint] = Place{(*other)->position, 0};
}

void Placer::place(CharacterRig& character) {
  for (const Rule& rule : rules_) places_.push_back(by_landmarks(rule));
  while (place_between()) continue;
  const auto hold_where = [&](bool between) {
    for (size_t j = 0; j < rules_.size(); ++j) {
      if (places_[j] || rules_[j].between.empty() == between) continue;
      hold(j, character);
      while (place_between()) continue;
    }
  };
  hold_where(false), hold_where(true);  // joints between others last: fixed joints may place them
  for (size_t j = 0; j < rules_.size(); ++j) {
    Joint joint{skeleton_.joints[j].name, rules_[j].parent};
    joint.bind.topRightCorner<3, 1>() = places_[j]->position;
    character.rig.joints.push_back(std::move(joint));
    character.confidence.push_back(places_[j]->confidence);
  }
}

// A joint's bones lead to its children; the last of a chain to its tip, or towards the skin in the direction
// of the chain.
std::vector<Bone> Placer::bones(const std::vector<Joint>& joints) const {
  std::vector<Bone> result;
  std::vector<bool> has_child(joints.size(), false);
  for (size_t j = 0; j < joints.size(); ++j) {
    const int32_t p = joints[j].parent;
    if (p < 0) continue;
    has_child[p] = true;
    result.push_back({p, place_of(joints[p]), place_of(joints[j])});
  }
  for (size_t j = 0; j < joints.size(); ++j) {
    if (has_child[j]) continue;
    const Vector3 from = place_of(joints[j]);
    std::optional<Vector3> to = landmark(rules_[j].tip);
    if (!to && joints[j].parent >= 0) {
      constexpr double short_of_skin = 0.9;
      const Vector3 way = from - place_of(joints[joints[j].parent]);
      const auto hit = rays_.first_hit(from, way);
      to = from + (hit.triangle >= 0 ? short_of_skin * hit.distance : 0.5) * way;
    }
    result.push_back({static_cast<int32_t>(j), from, to.value_or(from)});
  }
  return result;
}

// The y axis along the bone to the first child, or to the tip, with the smallest rotation about it relative
// to the parent.
void turn_along_bones(std::vector<Joint>& joints, const std::vector<Vector3>& tips) {
  std::vector<Vector3> end = tips;
  for (size_t j = joints.size(); j-- > 0;)  // backwards: the first child overrides the others
    if (joints[j].parent >= 0) end[joints[j].parent] = place_of(joints[j]);
  for (size_t j = 0; j < joints.size(); ++j) {
    Matrix3 turn = Matrix3::Identity();
    if (joints[j].parent >= 0) turn = joints[joints[j].parent].bind.topLeftCorner<3, 3>();
    const Vector3 way = end[j] - place_of(joints[j]);
    if (way.norm() > 1e-6)
      turn = Eigen::Quaterniond::FromTwoVectors(turn.col(1), way).toRotationMatrix() * turn;
    joints[j].bind.topLeftCorner<3, 3>() = turn;
  }
}

// Before the tips are set: tips follow from the joints.
void hold_fixed(const FixedJoints& fixed, const ToCaller& to_caller, CharacterRig& character) {
  FixedJoints inside(fixed.size());
  for (size_t j = 0; j < fixed.size(); ++j)
    if (fixed[j]) inside[j] = (*fixed[j] - to_caller.offset) / to_caller.scale;
  for (const Joint& joint : character.rig.joints) character.tip.push_back(place_of(joint));
  follow(inside, fixed_joint_reach, character);
}

std::vector<Matrix4> rest_of(const SkeletonTemplate& skeleton, const std::vector<Joint>& joints) {
  std::vector<Matrix4> rest;
  if (std::none_of(skeleton.joints.begin(), skeleton.joints.end(), [](const auto& j) { return j.rest; }))
    return rest;
  for (size_t j = 0; j < joints.size(); ++j) {
    const int32_t p = joints[j].parent;
    rest.push_back(p < 0 ? joints[j].bind : Matrix4(rest[p] * joints[p].bind.inverse() * joints[j].bind));
    if (const auto& way = skeleton.joints[j].rest) {
      const Matrix3 turn = rest[j].topLeftCorner<3, 3>();
      rest[j].topLeftCorner<3, 3>() =
          Eigen::Quaterniond::FromTwoVectors(turn.col(1), *way).toRotationMatrix() * turn;
    }
  }
  return rest;
}

}  // namespace

void check_template(const SkeletonTemplate& skeleton, const std::vector<std::string>& landmarks) {
  rules_of(skeleton, landmarks);
}

CharacterRig rig_by_template(const SkeletonTemplate& skeleton, const Detection& detection,
                             const Execution& execution, int32_t influences, const FixedJoints& fixed) {
  const SurfaceAnalysis& analysis = analysis_of(detection);
  execution.begin_stage("joints", 0, 0.3);
  CharacterRig result;
  Placer placer(skeleton, detection);
  placer.place(result);
  if (skeleton.symmetric) make_bones_symmetric(result);
  hold_fixed(fixed, ToCaller(analysis), result);
  execution.begin_stage("weights", 0.3, 1);
  auto& joints = result.rig.joints;
  const auto count = static_cast<int32_t>(joints.size());
  const RowMatrixf weights =
      bone_heat_weights(analysis, placer.rays(), placer.bones(joints), count, execution);
  put_influences_on_source(weights, analysis, influences, result.rig, execution);

  ShapeRig shape;  // for the tips: the far ends of the parts
  std::vector<Influence> row(joints.size());
  for (Eigen::Index v = 0; v < weights.rows(); ++v) {
    for (int32_t j = 0; j < count; ++j) row[j] = {j, weights(v, j)};
    shape.influences.push_back(heaviest(row));
  }
  for (const Joint& joint : joints) shape.bind.emplace_back(joint.bind);
  result.tip = joint_tips(analysis.surface(), shape);
  for (int32_t j = 0; j < count; ++j)
    if (const auto tip = placer.landmark(placer.rules()[j].tip)) result.tip[j] = *tip;
  turn_along_bones(joints, result.tip);

  const ToCaller to_caller(analysis);
  for (Joint& joint : joints) joint.bind.topRightCorner<3, 1>() = to_caller(place_of(joint));
  for (Vector3& tip : result.tip) tip = to_caller(tip);
  for (size_t j = 0; j < fixed.size(); ++j)
    if (fixed[j]) joints[j].bind.topRightCorner<3, 1>() = *fixed[j];  // exactly
  if (skeleton.symmetric) make_symmetric(detection.mesh->source, fixed, result);
  result.rest = rest_of(skeleton, joints);
  return result;
}

}  // namespace focal
