#include "skeleton/detail_training.h"

#include <algorithm>
#include <map>

#include "landmarks/train.h"
#include "skeleton/detail_region.h"
#include "skeleton/teachers.h"

namespace focal {
namespace {

// Training characters per part: more improve the part's model little and enlarge the file.
constexpr size_t max_teachers = 10;
constexpr int32_t fewest_shapes = 12;
constexpr int32_t landmarks = 24;
// Length of limb below the root that is included, in the part's frame: enough to find the start of the part.
constexpr double limb_below = 0.25, limb_before_bones = 1.5;

TrainParams params_of_part(uint64_t seed) {
  TrainParams params;
  params.eigenpair_count = 64;
  params.tree_count = 12;
  params.proxy_vertices = 1000;
  params.augmented_copies = 0;
  params.learns_confidence = false;
  params.finds_heading = false;
  params.max_samples_per_shape = 400;
  params.seed = seed;
  return params;
}

// The part's joints of one character: numbers in its own rig, -1 for a missing one.
std::vector<int32_t> own_joints(const Rig& rig, const std::vector<SkeletonJoint>& skeleton,
                                const std::vector<int32_t>& part) {
  std::map<std::string, int32_t> number;
  for (size_t j = 0; j < rig.joints.size(); ++j) number.emplace(rig.joints[j].name, static_cast<int32_t>(j));
  std::vector<int32_t> result;
  for (const int32_t joint : part) {
    const auto found = number.find(skeleton[joint].name);
    result.push_back(found == number.end() ? -1 : found->second);
  }
  return result;
}

// A part of one skeleton, and the characters that have it.
struct Part {
  std::vector<int32_t> joints;  // of the skeleton
  size_t root = 0;              // index among them; before it is the limb below
  std::vector<const RiggedMesh*> teachers;
  std::vector<std::vector<int32_t>> own;  // per training character: own_joints

  Vector3 place(size_t teacher, size_t i) const {
    return teachers[teacher]->rig.joints[own[teacher][i]].bind.topRightCorner<3, 1>();
  }
};

Part part_at(int32_t root, const std::vector<RiggedMesh>& characters,
             const std::vector<SkeletonJoint>& skeleton) {
  Part part;
  part.joints = joints_of_part(skeleton, root);
  part.root = skeleton[root].parent >= 0 ? 1 : 0;
  for (const RiggedMesh& character : characters) {
    std::vector<int32_t> own = own_joints(character.rig, skeleton, part.joints);
    const auto there =
        static_cast<size_t>(std::count_if(own.begin(), own.end(), [](int32_t j) { return j >= 0; }));
    if (own[part.root] < 0 || 4 * there < 3 * own.size()) continue;
    part.teachers.push_back(&character), part.own.push_back(std::move(own));
  }
  return part;
}

// From the part's frame to the character's coordinates, by the joints that both have.
Similarity fitted_frame(const Part& part, size_t teacher, const std::vector<Vector3>& reference) {
  const auto count = static_cast<Eigen::Index>(part.joints.size());
  MatrixX3 from = MatrixX3::Zero(count, 3), to = from;
  Vector weight = Vector::Zero(count);
  for (size_t i = part.root; i < part.joints.size(); ++i) {
    if (part.own[teacher][i] < 0) continue;
    const auto row = static_cast<Eigen::Index>(i);
    from.row(row) = reference[i].transpose(), to.row(row) = part.place(teacher, i).transpose();
    weight[row] = i == part.root ? root_trust : 1;
  }
  return fit_similarity(from, to, weight);
}

Vector3 in_frame(const Similarity& frame, const Vector3& p) {
  return frame.rotation.transpose() * (p - frame.offset) / frame.scale;
}

// The mean positions of the joints in the frame of the training character that has most of them.
std::vector<Vector3> mean_places(const Part& part) {
  const auto missing = [&](size_t t) { return std::count(part.own[t].begin(), part.own[t].end(), -1); };
  size_t first = 0;
  for (size_t t = 1; t < part.teachers.size(); ++t)
    if (missing(t) < missing(first)) first = t;
  std::vector<Vector3> places, reference(part.joints.size(), Vector3::Zero());
  for (size_t i = part.root; i < part.joints.size(); ++i)
    if (part.own[first][i] >= 0) places.push_back(part.place(first, i));
  const Similarity frame = frame_of(places);
  for (size_t i = part.root; i < part.joints.size(); ++i)
    if (part.own[first][i] >= 0) reference[i] = in_frame(frame, part.place(first, i));
  std::vector<Vector3> sum(part.joints.size(), Vector3::Zero());
  std::vector<double> count(part.joints.size(), 0);
  for (size_t t = 0; t < part.teachers.size(); ++t) {
    const Similarity own = fitted_frame(part, t, reference);
    for (size_t i = 0; i < part.joints.size(); ++i)
      if (part.own[t][i] >= 0) sum[i] += in_frame(own, part.place(t, i)), ++count[i];
  }
  for (size_t i = 0; i < sum.size(); ++i)  // with the precision of the file
    reference[i] = count[i] > 0 ? Vector3((sum[i] / count[i]).cast<float>().cast<double>()) : Vector3::Zero();
  return reference;
}

double start_of(const Part& part, const std::vector<SkeletonJoint>& skeleton,
                const std::vector<Vector3>& reference) {
  Vector3 begin = Vector3::Zero();
  double bones = 0, reach = 0;
  for (size_t i = part.root + 1; i < part.joints.size(); ++i)
    if (skeleton[part.joints[i]].parent == part.joints[part.root]) begin += reference[i], ++bones;
  begin /= bones;
  for (size_t i = part.root + 1; i < part.joints.size(); ++i)
    reach = std::max(reach, (reference[i] - begin).norm());
  return static_cast<float>(
      std::max(reference[part.root].y() - limb_below, begin.y() - limb_before_bones * reach));
}

// A training character's part as a separate character. Weights of joints outside it go to the limb below.
RiggedMesh cut_out(const Part& part, size_t teacher, const std::vector<SkeletonJoint>& skeleton,
                   const std::vector<Vector3>& reference, double start, const Execution& execution) {
  const RiggedMesh& character = *part.teachers[teacher];
  const auto& joints = character.rig.joints;
  std::vector<int32_t> number(joints.size(), -1);
  const Similarity frame = fitted_frame(part, teacher, reference);
  RiggedMesh result;
  for (size_t i = 0; i < part.joints.size(); ++i) {
    const int32_t own = part.own[teacher][i];
    if (own < 0) continue;
    number[own] = static_cast<int32_t>(result.rig.joints.size());
    Joint joint{skeleton[part.joints[i]].name, -1};
    for (int32_t p = joints[own].parent; p >= 0 && joint.parent < 0; p = joints[p].parent)
      joint.parent = number[p];
    joint.bind.topLeftCorner<3, 3>() =
        frame.rotation.transpose() * nearest_rotation(joints[own].bind.topLeftCorner<3, 3>());
    joint.bind.topRightCorner<3, 1>() = in_frame(frame, joints[own].bind.topRightCorner<3, 1>());
    result.rig.joints.push_back(std::move(joint));
  }
  std::vector<char> is_of_part(joints.size(), 0);
  for (size_t j = 0; j < joints.size(); ++j) {
    const int32_t p = joints[j].parent;
    if (number[j] < 0 && p >= 0 && is_of_part[p]) number[j] = number[p];
    is_of_part[j] = number[j] >= 0;
  }
  DetailRegion region =
      cut_region(character.mesh->source, character.rig.influences, is_of_part, frame, start);
  for (const VertexInfluences& influences : region.influences) {
    std::vector<Influence> own;
    for (Influence one : influences)
      if (one.weight > 0 && number[one.joint] >= 0) one.joint = number[one.joint], own.push_back(one);
    result.rig.influences.push_back(heaviest(own));
  }
  result.mesh = std::make_shared<const PreparedMesh>(
      prepare(std::move(region.mesh), {.analysed = AnalysedSurface::wrapped}, execution));
  return result;
}

}  // namespace

std::vector<DetailModel> learn_details(const std::vector<RiggedMesh>& given,
                                       const std::vector<SkeletonJoint>& skeleton, uint64_t seed,
                                       const Execution& execution) {
  std::vector<RiggedMesh> characters = given;
  match_teachers(characters);
  std::vector<SizedRig> sized;
  for (const RiggedMesh& character : characters) sized.push_back({&character.rig, character.mesh->scale});
  std::vector<DetailModel> result;
  for (const int32_t root : detail_joints(skeleton, sized)) {
    const Part part = part_at(root, characters, skeleton);
    if (part.teachers.empty()) continue;
    DetailModel detail{root, {}, {}, 0, nullptr};
    const std::vector<Vector3> reference = mean_places(part);
    detail.start = start_of(part, skeleton, reference);
    std::vector<RiggedMesh> parts;
    const size_t used = std::min(part.teachers.size(), max_teachers);
    for (size_t i = 0; i < used; ++i)
      parts.push_back(
          cut_out(part, i * part.teachers.size() / used, skeleton, reference, detail.start, execution));
    const TrainingSet set =
        training_set_of(parts, {.shapes = fewest_shapes, .landmarks = landmarks, .seed = seed}, execution);
    if (set.landmark_names.size() < 4) continue;
    for (const SkeletonJoint& joint : set.skeleton)
      for (size_t i = 0; i < part.joints.size(); ++i)
        if (skeleton[part.joints[i]].name == joint.name)
          detail.joints.push_back(part.joints[i]), detail.reference.push_back(reference[i]);
    detail.model = std::make_shared<const LandmarkModel>(train(set, params_of_part(seed), execution));
    result.push_back(std::move(detail));
  }
  return result;
}

}  // namespace focal
