#include "skeleton/rigged_shapes.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.h"
#include "base/random.h"
#include "gltf/output_file.h"
#include "mesh/closest_point.h"
#include "mesh/similarity.h"
#include "skeleton/rig_landmarks.h"
#include "skeleton/teachers.h"

namespace focal {
namespace {

// Rotations of joints in radians, and scales: limbs bend clearly, and bodies vary like those of people.
constexpr double pose_deviation = 0.35, most_turned = 0.9, size_deviation = 0.1, breadth_deviation = 0.08;

int32_t index_of(const std::vector<SkeletonJoint>& skeleton, const std::string& name) {
  for (size_t j = 0; j < skeleton.size(); ++j)
    if (skeleton[j].name == name) return static_cast<int32_t>(j);
  return -1;
}

std::vector<SkeletonJoint> shared_skeleton(const std::vector<RiggedMesh>& characters) {
  struct Use {
    int32_t characters = 0, depth = 0, order = 0;
    std::string parent;
  };
  std::map<std::string, Use> uses;
  int32_t order = 0;
  for (const RiggedMesh& character : characters) {
    const auto& joints = character.rig.joints;
    const std::vector<double> moved = weight_below(character.rig);
    std::vector<int32_t> depth(joints.size(), 0);
    for (size_t j = 0; j < joints.size(); ++j) {
      if (joints[j].parent >= 0) depth[j] = depth[joints[j].parent] + 1;
      if (moved[j] <= 0) continue;
      Use& use = uses[joints[j].name];
      if (use.characters++ == 0)
        use = {1, depth[j], order++, joints[j].parent < 0 ? "" : joints[joints[j].parent].name};
    }
  }
  std::vector<std::pair<std::string, Use>> kept;
  for (const auto& [name, use] : uses)
    if (2 * use.characters >= static_cast<int32_t>(characters.size())) kept.emplace_back(name, use);
  std::sort(kept.begin(), kept.end(), [](const auto& a, const auto& b) {
    return std::pair(a.second.depth, a.second.order) < std::pair(b.second.depth, b.second.order);
  });
  std::vector<SkeletonJoint> skeleton;
  for (const auto& [name, use] : kept) {
    std::string parent = use.parent;  // the nearest ancestor that is kept
    for (size_t steps = 0; steps < uses.size() && !parent.empty() && index_of(skeleton, parent) < 0; ++steps)
      parent = uses.contains(parent) ? uses.at(parent).parent : "";
    skeleton.push_back({name, index_of(skeleton, parent)});
  }
  return skeleton;
}

// Maps the character's own joints to those of the shared skeleton: each to itself or to its nearest ancestor
// there; -1: none.
std::vector<int32_t> shared_joints(const Rig& rig, const std::vector<SkeletonJoint>& skeleton) {
  std::vector<int32_t> result;
  for (const Joint& joint : rig.joints) {
    const int32_t own = index_of(skeleton, joint.name);
    result.push_back(own >= 0 || joint.parent < 0 ? own : result[joint.parent]);
  }
  return result;
}

ShapeRig shape_rig(const RiggedMesh& character, const std::vector<SkeletonJoint>& skeleton) {
  const PreparedMesh& mesh = *character.mesh;
  ShapeRig result;
  result.bind.resize(skeleton.size());
  for (const Joint& joint : character.rig.joints)
    if (const int32_t j = index_of(skeleton, joint.name); j >= 0 && !result.bind[j]) {
      Matrix4 bind = Matrix4::Identity();
      bind.topLeftCorner<3, 3>() = nearest_rotation(joint.bind.topLeftCorner<3, 3>());
      bind.topRightCorner<3, 1>() = (joint.bind.topRightCorner<3, 1>() - mesh.centre) / mesh.scale;
      result.bind[j] = bind;
    }
  const std::vector<int32_t> shared = shared_joints(character.rig, skeleton);
  for (int32_t v = 0; v < mesh.surface.vertex_count(); ++v) {
    std::vector<Influence> influences;
    for (Influence one : character.rig.influences[mesh.source_vertex[v]])
      if (one.weight > 0 && shared[one.joint] >= 0) influences.push_back({shared[one.joint], one.weight});
    result.influences.push_back(heaviest(influences));
  }
  result.tip = joint_tips(mesh.surface, result);
  return result;
}

// The character's outer shell with the skin of the nearest triangles, in the caller's coordinates.
RiggedMesh wrapped(const RiggedMesh& character, const Execution& execution) {
  const PreparedMesh& mesh = *character.mesh;
  const TriangleMesh shell = focal::wrapped(mesh, execution).source;
  std::vector<SurfaceQuery> queries;
  for (int32_t v = 0; v < shell.vertex_count(); ++v)
    queries.push_back({shell.positions.row(v).transpose(), Vector3::Zero()});
  const auto nearest = closest_points(mesh.surface, queries, 0.02, execution);
  RiggedMesh result{nullptr, {character.rig.joints, {}}};
  for (const SurfacePoint& point : nearest) {
    std::vector<Influence> influences;
    for (int c = 0; c < 3; ++c)
      for (Influence one :
           character.rig.influences[mesh.source_vertex[mesh.surface.triangles(point.triangle, c)]]) {
        one.weight *= static_cast<float>(point.barycentric[c]);
        influences.push_back(one);
      }
    result.rig.influences.push_back(heaviest(influences));
  }
  result.mesh = std::make_shared<const PreparedMesh>(
      prepare(in_source_coordinates(shell, mesh),
              {.analysed = AnalysedSurface::as_it_is, .repair_orientation = false}, execution));
  return result;
}

// Random motion of a joint for the vertices that it moves: rotation and scale about its position; its
// children move along.
std::vector<Matrix4> random_motion(const std::vector<SkeletonJoint>& skeleton, const ShapeRig& rig,
                                   Random& random) {
  std::vector<Matrix4> motion(skeleton.size(), Matrix4::Identity());
  std::vector<Matrix3> turn(skeleton.size(), Matrix3::Identity());
  std::vector<double> size(skeleton.size(), 1);
  for (size_t j = 0; j < skeleton.size(); ++j) {
    const int32_t p = skeleton[j].parent;
    const Vector3 axis = Vector3(random.normal(), random.normal(), random.normal()).stableNormalized();
    const double angle = p < 0 ? 0 : std::clamp(pose_deviation * random.normal(), -most_turned, most_turned);
    size[j] = std::exp(size_deviation * random.normal());
    turn[j] = Eigen::AngleAxisd(angle, axis.norm() > 0 ? axis : Vector3::UnitX()).toRotationMatrix();
    if (p >= 0) turn[j] = turn[p] * turn[j];
    if (!rig.bind[j]) {
      if (p >= 0) motion[j] = motion[p], turn[j] = turn[p], size[j] = size[p];
      continue;
    }
    const Vector3 place = rig.bind[j]->topRightCorner<3, 1>();
    const Vector3 moved =
        p < 0 ? place : Vector3(motion[p].topLeftCorner<3, 3>() * place + motion[p].topRightCorner<3, 1>());
    motion[j].topLeftCorner<3, 3>() = size[j] * turn[j];
    motion[j].topRightCorner<3, 1>() = moved - size[j] * turn[j] * place;
  }
  return motion;
}

// The shape in another pose and with other proportions; its landmarks on the same triangles.
MarkedShape posed(const MarkedShape& shape, const std::vector<SkeletonJoint>& skeleton, Random random) {
  const ShapeRig& rig = *shape.rig;
  std::vector<Matrix4> motion = random_motion(skeleton, rig, random);
  Matrix4 build = Matrix4::Identity();  // tall and slim, or short and broad
  for (int axis = 0; axis < 3; ++axis) build(axis, axis) = std::exp(breadth_deviation * random.normal());
  for (Matrix4& one : motion) one = one * build;
  TriangleMesh moved{skinned(shape.mesh->surface.positions, rig.influences, motion),
                     shape.mesh->surface.triangles};
  const auto mesh = std::make_shared<const PreparedMesh>(
      prepare(std::move(moved), {.analysed = AnalysedSurface::as_it_is}));
  MarkedShape result{mesh, {}, ShapeRig{}, true};
  for (const auto& mark : shape.marks) {
    std::optional<SurfacePoint> carried;
    if (mark) carried = to_surface(*mesh, *mark);
    if (carried && carried->triangle < 0) carried.reset();
    result.marks.push_back(carried);
  }
  const auto on_surface = [&](const Vector3& p) -> Vector3 { return (p - mesh->centre) / mesh->scale; };
  for (size_t j = 0; j < skeleton.size(); ++j) {
    const Matrix3 linear = motion[j].topLeftCorner<3, 3>();
    const auto carry = [&](const Vector3& p) -> Vector3 {
      return on_surface(linear * p + motion[j].topRightCorner<3, 1>());
    };
    result.rig->bind.emplace_back();
    result.rig->tip.push_back(carry(rig.tip[j]));
    if (!rig.bind[j]) continue;
    Matrix4 bind = Matrix4::Identity();
    bind.topLeftCorner<3, 3>() = nearest_rotation(linear) * rig.bind[j]->topLeftCorner<3, 3>();
    bind.topRightCorner<3, 1>() = carry(rig.bind[j]->topRightCorner<3, 1>());
    result.rig->bind.back() = bind;
  }
  for (const int32_t source : mesh->source_vertex) result.rig->influences.push_back(rig.influences[source]);
  return result;
}

}  // namespace

TrainingSet training_set_of(const std::vector<RiggedMesh>& given, const RiggedShapesParams& params,
                            const Execution& execution, std::vector<std::string>* warnings) {
  std::vector<RiggedMesh> characters = given;
  std::vector<std::string> odd = match_teachers(characters);
  if (warnings) *warnings = std::move(odd);
  for (RiggedMesh& character : characters)
    if (character.mesh->is_wrapped) character = wrapped(character, execution);
  if (characters.empty())
    throw Error(Status::invalid_argument, "there is no rigged character to learn from", "add one");
  TrainingSet set;
  set.skeleton = shared_skeleton(characters);
  if (set.skeleton.empty())
    throw Error(Status::invalid_argument,
                "no vertex of the characters is moved by a joint that most of them have",
                "use characters of one skeleton, with the same joint names and skin weights");
  for (const RiggedMesh& character : characters)
    set.shapes.push_back({character.mesh, {}, shape_rig(character, set.skeleton)});
  mark_by_skeleton(set, params.landmarks);
  const auto originals = static_cast<int32_t>(set.shapes.size());
  // Half as many copies again while there are few characters: each copy adds 0.4 MB to the model.
  constexpr int32_t enough = 60;
  const int32_t wanted = std::max({params.shapes, originals, std::min(originals + originals / 2, enough)});
  for (int32_t copy = 0; static_cast<int32_t>(set.shapes.size()) < wanted; ++copy) {
    execution.check_cancelled();
    set.shapes.push_back(posed(set.shapes[copy % originals], set.skeleton, Random(params.seed, 9000 + copy)));
  }
  return set;
}

}  // namespace focal
