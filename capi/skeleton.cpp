#include "skeleton.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "arguments.h"
#include "base/error.h"
#include "boundary.h"
#include "gltf/document.h"
#include "skeleton/bone_roles.h"
#include "skeleton/ground_root.h"
#include "skeleton/helper_bones.h"
#include "skeleton/joint_match.h"
#include "skeleton/stretched_arms.h"
#include "skeleton_template.h"
#include "structs.h"
#include "surface_points.h"
#include "taken_animations.h"
#include "task.h"

namespace focal {

template <>
struct StructTraits<focal_skeleton_params> {
  static constexpr const char* name = "focal_skeleton_params";
  static constexpr size_t first_size = offsetof(focal_skeleton_params, max_influences);
  static focal_skeleton_params defaults() {
    focal_skeleton_params params{};
    params.max_influences = max_influences;
    return params;
  }
};
static_assert(sizeof(void*) != 8 || (sizeof(focal_skeleton_params) == 80 &&
                                     offsetof(focal_skeleton_params, joint_name_count) == 16 &&
                                     offsetof(focal_skeleton_params, fixed_joint_count) == 64));

template <>
struct StructTraits<focal_skeleton_info> {
  static constexpr const char* name = "focal_skeleton_info";
  static constexpr size_t first_size = 32;
  static focal_skeleton_info defaults() { return {}; }
};
static_assert(sizeof(focal_skeleton_info) == 56 && offsetof(focal_skeleton_info, unweighted_vertices) == 24 &&
              offsetof(focal_skeleton_info, quality) == 32 &&
              offsetof(focal_skeleton_info, guessed_joints) == 44);
static_assert(FOCAL_VERDICT_GOOD == static_cast<int>(Verdict::good) &&
              FOCAL_VERDICT_CHECK == static_cast<int>(Verdict::check) &&
              FOCAL_VERDICT_FAILED == static_cast<int>(Verdict::failed));

template <>
struct StructTraits<focal_joint> {
  static constexpr const char* name = "focal_joint";
  static constexpr size_t first_size = sizeof(focal_joint);
  static focal_joint defaults() { return {}; }
};
static_assert(sizeof(void*) != 8 || (sizeof(focal_joint) == 64 && offsetof(focal_joint, tip) == 52));

namespace {

void check(const focal_skeleton_params& params) {
  check_range("focal_skeleton_params.names", params.names, FOCAL_BONE_NAMES_AS_TRAINED,
              FOCAL_BONE_NAMES_RIGIFY_METARIG);
  check_range("focal_skeleton_params.rest_pose", params.rest_pose, FOCAL_POSE_OF_MESH, FOCAL_POSE_A);
  check_flag("focal_skeleton_params.drop_helpers", params.drop_helpers);
  check_flag("focal_skeleton_params.symmetric", params.symmetric);
  check_flag("focal_skeleton_params.ground_root", params.ground_root);
  check_reserved("focal_skeleton_params.reserved_2", params.reserved_2);
  check_range("focal_skeleton_params.max_influences", params.max_influences, 1, 2 * max_influences);
}

// The caller's, else the one that the model carries; nothing: rigged characters taught it.
std::optional<SkeletonTemplate> template_of(const focal_skeleton_params& params, const ModelObject& model) {
  std::optional<SkeletonTemplate> result = model.by_template;
  if (params.skeleton_template) result = parse_skeleton_template(params.skeleton_template);
  if (result && params.animations)
    throw Error(Status::invalid_argument, "animations were asked for together with a template",
                "they need the joints of the characters that taught the model; leave one of the two out");
  if (result) result->symmetric |= params.symmetric != 0;
  return result;
}

void check_names(const focal_skeleton_params& params, size_t joints) {
  if (params.joint_names ? params.joint_name_count != joints : params.joint_name_count != 0)
    throw Error(Status::invalid_argument,
                "focal_skeleton_params.joint_name_count is " + std::to_string(params.joint_name_count) +
                    ", the skeleton has " + std::to_string(joints) + " joints",
                "give one name, or NULL, for each joint of the model or template");
}

// In the caller's coordinates.
FixedJoints fixed_joints(const focal_skeleton_params& params, size_t joints) {
  if (!params.fixed_joints && params.fixed_joint_count == 0) return {};
  require(params.fixed_joints, "focal_skeleton_params.fixed_joints");
  check_count("focal_skeleton_params.fixed_joint_count", params.fixed_joint_count, joints, "the skeleton",
              "joints");
  FixedJoints result(joints);
  for (size_t j = 0; j < joints; ++j) {
    const Vector3 place = Eigen::Map<const Eigen::Vector3f>(params.fixed_joints + 3 * j).cast<double>();
    if (place.allFinite()) result[j] = place;
  }
  return result;
}

// numbers: of the joints in the model or template, where some were dropped.
void rename_joints(const focal_skeleton_params& params, const std::vector<size_t>& numbers,
                   CharacterRig& rig) {
  auto& joints = rig.rig.joints;
  size_t known = 0;
  const std::vector<std::string> names = names_by_role(joints, static_cast<BoneNames>(params.names), known);
  if (known == 0)
    rig.warnings.push_back("no bone has a role in this convention of names: all of them keep their own");
  const auto own = [&](size_t j) { return params.joint_names ? params.joint_names[numbers[j]] : nullptr; };
  for (size_t j = 0; j < joints.size(); ++j) joints[j].name = own(j) ? own(j) : names[j];
}

std::vector<size_t> kept_joints(const focal_skeleton_params& params, CharacterRig& rig) {
  if (params.drop_helpers) return drop_helper_bones(rig);
  std::vector<size_t> all(rig.rig.joints.size());
  std::iota(all.begin(), all.end(), size_t{0});
  return all;
}

std::vector<Matrix4> shown_pose(focal_pose pose, const CharacterRig& rig) {
  if (rig.rest.empty())
    throw Error(Status::invalid_argument, "the template has no rest pose",
                R"(give its joints a "rest": the way their bones point)");
  if (pose == FOCAL_POSE_OF_TEACHERS) return rig.rest;
  constexpr double below = std::numbers::pi / 4;
  const auto result = stretched_arms(rig.rig.joints, rig.rest, pose == FOCAL_POSE_A ? below : 0.0);
  if (result.empty())
    throw Error(Status::invalid_argument, "the skeleton has no two arms, which a T or A pose is made of",
                "ask for the rest pose of the characters that taught the model, FOCAL_POSE_OF_TEACHERS");
  return result;
}

void put_root(const focal_skeleton_params& params, SkeletonObject& object) {
  const bool capital = params.names == FOCAL_BONE_NAMES_UNITY;
  add_ground_root(capital ? "Root" : "root", object.mesh->mesh->source, object.rig);
  if (!object.shown_pose.empty())
    object.shown_pose.insert(object.shown_pose.begin(), object.rig.rig.joints.front().bind);
  for (JointAnimation& one : object.animations) one.joints.insert(one.joints.begin(), JointKeys{});
}

void set_verdict(SkeletonObject& object, const RigMeasures& measures) {
  object.verdict = verdict_of(measures), object.quality = rig_quality(measures);
  object.guessed_joints = static_cast<uint32_t>(
      std::lround(measures.absent_share * static_cast<double>(object.rig.rig.joints.size())));
  if (object.verdict == Verdict::good) return;
  std::string text = object.verdict == Verdict::failed ? "the rig failed" : "the rig should be looked at";
  const std::vector<std::string> doubts = doubts_about(measures);
  for (size_t i = 0; i < doubts.size(); ++i) text += (i ? "; " : ": ") + doubts[i];
  object.rig.warnings.push_back(text);
}

// The skeleton of the mesh's own file, if it has one that can be read: what is wrong with it is no reason not to give it another.
std::optional<Rig> previous_rig(const MeshObject& mesh) {
  if (!mesh.document) return std::nullopt;
  try {
    return mesh.document->rig(mesh.primitives);
  } catch (const Error&) {
    return std::nullopt;
  }
}

// Clips of the mesh's own file that move a skeleton which no mesh follows any more.
std::vector<std::string> clips_of_former_skeleton(const MeshObject& mesh, const std::vector<Joint>& joints) {
  const auto former = previous_rig(mesh);
  std::vector<std::string> names;
  if (!former || names_of(former->joints) == names_of(joints)) return names;  // rigged by this model before
  try {
    for (const Clip& clip : mesh.document->animations().clips)
      if (moves_joint(clip, former->joints)) names.push_back(clip.name);
  } catch (const Error&) {  // malformed ones stay as they are, too
  }
  return names;
}

// The joints of the mesh's own file that the new ones stand for.
std::vector<ReplacedJoint> replaced_joints(const MeshObject& mesh, const std::vector<Joint>& joints) {
  const auto former = previous_rig(mesh);
  if (!former) return {};
  const JointMatch match = match_joints(names_of(joints), names_of(former->joints));
  std::vector<ReplacedJoint> result(joints.size());
  for (size_t j = 0; j < joints.size(); ++j)
    if (match.there[j] >= 0)
      result[j] = {former->joints[match.there[j]].node, former->joints[match.there[j]].bind};
  return result;
}

// The mesh's own file with the skeleton, and with the landmarks where some were looked for.
SourceFile with_skeleton(const SkeletonObject& object, const std::filesystem::path& path) {
  SourceFile source = source_file(*object.mesh, path);
  const std::vector<Joint>& joints = object.rig.rig.joints;
  if (object.keeps_joints) {
    source.document.replace_weights(source.primitives, object.rig.rig);
  } else {
    GltfRig rig{&object.rig.rig, object.rig.tip, {}, object.animations, &object.mesh->mesh->source};
    rig.pose = object.shown_pose;
    rig.replaces = replaced_joints(*object.mesh, joints);
    source.document.add_skin(source.primitives, rig);
  }
  if (object.detection) put_landmarks(*object.detection, source);
  return source;
}

focal_joint to_abi(const CharacterRig& rig, size_t index) {
  const Joint& from = rig.rig.joints[index];
  focal_joint to{};
  to.parent = from.parent;
  to.name = from.name.c_str();
  to.confidence = rig.confidence[index];
  position_out(from.bind.topRightCorner<3, 1>(), to.position);
  position_out(rig.tip[index], to.tip);
  const Eigen::Quaterniond q(Matrix3(from.bind.topLeftCorner<3, 3>()));
  for (int i = 0; i < 4; ++i) to.rotation[i] = static_cast<float>(q.coeffs()[i]);
  return to;
}

}  // namespace
}  // namespace focal

using namespace focal;

focal_status focal_skeleton_params_init(focal_skeleton_params* params, size_t struct_size) {
  return guarded([&] { init_struct(params, struct_size); });
}

uint32_t focal_model_joint_count(const focal_model* model) {
  return guarded_value<uint32_t>(
      0, [&] { return static_cast<uint32_t>(resolve<ModelObject>(model)->info.joint_names.size()); });
}

const char* focal_model_joint_name(const focal_model* model, uint32_t index) {
  return guarded_value<const char*>(nullptr, [&] {
    return text_at(resolve<ModelObject>(model)->info.joint_names, index, "the model", "joints");
  });
}

focal_status focal_skeleton_create(const focal_detection* detection, const focal_skeleton_params* params,
                                   focal_task* task, focal_skeleton** out_skeleton) {
  return guarded([&] {
    require(out_skeleton, "out_skeleton");
    const auto object = std::make_shared<SkeletonObject>();
    object->detection = resolve<DetectionObject>(detection);
    object->mesh = object->detection->mesh, object->context = object->detection->model->context;
    const focal_skeleton_params how = read_struct(params);
    check(how);
    const auto by_hand = template_of(how, *object->detection->model);
    const size_t joint_count =
        by_hand ? by_hand->joints.size() : object->detection->model->info.joint_names.size();
    check_names(how, joint_count);
    const FixedJoints fixed = fixed_joints(how, joint_count);
    const auto character = how.animations ? resolve<MeshObject>(how.animations) : nullptr;
    const TaskLease lease(task);
    const Execution execution = object->context->execution_with(lease.task());
    execution.check_cancelled();
    const Detection& found = object->detection->detection;
    object->rig = by_hand ? rig_by_template(*by_hand, found, execution, how.max_influences, fixed)
                          : transfer_rig(found, execution, how.symmetric != 0, how.max_influences, fixed);
    // Before the joints are renamed: names identify pairs of joints, and those of the model.
    const RigMeasures measures = rig_measures(found, object->rig);
    if (!by_hand) calibrate_confidence(rig_quality(measures), fixed, object->rig);
    const std::vector<size_t> numbers = kept_joints(how, object->rig);
    if (how.rest_pose != FOCAL_POSE_OF_MESH) object->shown_pose = shown_pose(how.rest_pose, object->rig);
    if (character)
      object->animations = animations_for(object->rig, *object->mesh->mesh, *character, object->rig.warnings);
    rename_joints(how, numbers, object->rig);
    const auto idle = clips_of_former_skeleton(*object->mesh, object->rig.rig.joints);
    if (!idle.empty())
      object->rig.warnings.push_back(
          "animations of the file move its former skeleton, which the mesh does not follow any more: " +
          listed(idle) + "; --animations (animations) plays them on the new one");
    set_verdict(*object, measures);
    if (how.ground_root) put_root(how, *object);
    object->context->report_warnings(object->rig.warnings);
    *out_skeleton = publish(object);
  });
}

focal_status focal_skeleton_destroy(focal_skeleton* skeleton) {
  return remove_handle(skeleton, HandleType::skeleton);
}

focal_status focal_skeleton_info_init(focal_skeleton_info* info, size_t struct_size) {
  return guarded([&] { init_struct(info, struct_size); });
}

focal_status focal_skeleton_get_info(const focal_skeleton* skeleton, focal_skeleton_info* out_info) {
  return guarded([&] {
    const auto object = resolve<SkeletonObject>(skeleton);
    const Rig& rig = object->rig.rig;
    focal_skeleton_info info{};
    info.joint_count = static_cast<uint32_t>(object->rig.rig.joints.size());
    info.warning_count = static_cast<uint32_t>(object->rig.warnings.size());
    info.vertex_count = rig.influences.size();
    info.quality = object->quality;
    info.verdict = static_cast<focal_verdict>(object->verdict);
    info.guessed_joints = object->guessed_joints;
    info.influences_per_vertex = (rig.more.empty() ? 1 : 2) * max_influences;
    const auto count = [](const VertexInfluences& one) {
      return std::count_if(one.begin(), one.end(), [](const Influence& i) { return i.weight > 0; });
    };
    for (size_t v = 0; v < rig.influences.size(); ++v) {
      const auto used =
          static_cast<uint32_t>(count(rig.influences[v]) + (rig.more.empty() ? 0 : count(rig.more[v])));
      info.max_influences = std::max(info.max_influences, used);
      info.unweighted_vertices += used == 0;
    }
    write_result(out_info, info);
  });
}

focal_status focal_joint_init(focal_joint* joint, size_t struct_size) {
  return guarded([&] { init_struct(joint, struct_size); });
}

focal_status focal_skeleton_get_joint(const focal_skeleton* skeleton, uint32_t index,
                                      focal_joint* out_joint) {
  return guarded([&] {
    const auto object = resolve<SkeletonObject>(skeleton);
    check_index(index, object->rig.rig.joints.size(), "the skeleton", "joints");
    write_result(out_joint, to_abi(object->rig, index));
  });
}

focal_status focal_skeleton_weights(const focal_skeleton* skeleton, uint64_t vertex_count,
                                    uint32_t* out_joints, float* out_weights) {
  return guarded([&] {
    require(out_joints, "out_joints");
    require(out_weights, "out_weights");
    const auto object = resolve<SkeletonObject>(skeleton);
    const Rig& rig = object->rig.rig;
    check_count("vertex_count", vertex_count, rig.influences.size(), "the mesh", "vertices");
    const auto put = [&](const Influence& one) {
      *out_joints++ = static_cast<uint32_t>(one.joint);
      *out_weights++ = one.weight;
    };
    for (size_t v = 0; v < rig.influences.size(); ++v) {
      std::ranges::for_each(rig.influences[v], put);
      if (!rig.more.empty()) std::ranges::for_each(rig.more[v], put);
    }
  });
}

const char* focal_skeleton_warning(const focal_skeleton* skeleton, uint32_t index) {
  return guarded_value<const char*>(nullptr, [&] {
    return text_at(resolve<SkeletonObject>(skeleton)->rig.warnings, index, "the skeleton", "warnings");
  });
}

focal_status focal_skeleton_write_gltf(const focal_skeleton* skeleton, const char* path) {
  return guarded([&] {
    const auto object = resolve<SkeletonObject>(skeleton);
    const auto file = path_of(path);
    const SourceFile source = with_skeleton(*object, file);
    object->context->report_warnings(write_document(source.document, file));
  });
}

focal_status focal_skeleton_write_vrm(const focal_skeleton* skeleton, const char* meta, const char* path) {
  return guarded([&] {
    require(meta, "meta");
    const auto object = resolve<SkeletonObject>(skeleton);
    const auto file = path_of(path);
    const auto& joints = object->rig.rig.joints;
    SourceFile source = with_skeleton(*object, file);
    source.document.add_vrm(joints, bone_roles(joints), meta);
    object->context->report_warnings(write_document(source.document, file));
  });
}
