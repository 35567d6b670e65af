// Joints and skin weights: of a detected mesh, or weights for a skeleton that is there already.
#include <Eigen/Geometry>
#include <algorithm>

#include "arguments.h"
#include "boundary.h"
#include "objects.h"
#include "skeleton/bone_roles.h"
#include "skeleton/own_skeleton.h"
#include "skeleton/template_file.h"
#include "structs.h"

using namespace focal;

FOCAL_STRUCT_WITH_DEFAULTS(focal_skeleton_params, offsetof(focal_skeleton_params, max_influences),
                           with_max_influences<focal_skeleton_params>);
static_assert(sizeof(void*) != 8 || (sizeof(focal_skeleton_params) == 80 &&
                                     offsetof(focal_skeleton_params, joint_name_count) == 16 &&
                                     offsetof(focal_skeleton_params, fixed_joint_count) == 64));
FOCAL_STRUCT(focal_skeleton_info, 32);
static_assert(sizeof(focal_skeleton_info) == 56 && offsetof(focal_skeleton_info, unweighted_vertices) == 24 &&
              offsetof(focal_skeleton_info, quality) == 32 &&
              offsetof(focal_skeleton_info, guessed_joints) == 44);
FOCAL_STRUCT(focal_joint, sizeof(focal_joint));
static_assert(sizeof(void*) != 8 || (sizeof(focal_joint) == 64 && offsetof(focal_joint, tip) == 52));
FOCAL_STRUCT_WITH_DEFAULTS(focal_bind_params, sizeof(focal_bind_params),
                           with_max_influences<focal_bind_params>);
static_assert(sizeof(void*) != 8 ||
              (sizeof(focal_bind_params) == 64 && offsetof(focal_bind_params, joint_moves) == 56));

namespace {

static_assert(FOCAL_VERDICT_GOOD == static_cast<int>(Verdict::good) &&
              FOCAL_VERDICT_CHECK == static_cast<int>(Verdict::check) &&
              FOCAL_VERDICT_FAILED == static_cast<int>(Verdict::failed));
static_assert(FOCAL_POSE_OF_TEACHERS == static_cast<int>(RestPose::of_teachers) &&
              FOCAL_POSE_A == static_cast<int>(RestPose::a) &&
              FOCAL_BONE_NAMES_RIGIFY_METARIG == static_cast<int>(BoneNames::rigify_metarig));

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

// The caller's, else the one that the model carries; nothing: its skeleton is that of rigged characters.
std::optional<SkeletonTemplate> template_of(const focal_skeleton_params& params, const ModelObject& model) {
  std::optional<SkeletonTemplate> result = model.by_template;
  if (params.skeleton_template) result = parse_skeleton_template(params.skeleton_template);
  if (result && params.animations)
    throw Error(Status::invalid_argument, "animations were asked for together with a template",
                "they need the joints of the training characters of the model; leave one of the two out");
  if (result) result->symmetric |= params.symmetric != 0;
  return result;
}

std::vector<std::optional<std::string>> own_names(const focal_skeleton_params& params, size_t joints) {
  if (params.joint_names ? params.joint_name_count != joints : params.joint_name_count != 0)
    throw Error(Status::invalid_argument,
                "focal_skeleton_params.joint_name_count is " + std::to_string(params.joint_name_count) +
                    ", the skeleton has " + std::to_string(joints) + " joints",
                "give one name, or NULL, for each joint of the model or template");
  std::vector<std::optional<std::string>> names(params.joint_names ? joints : 0);
  for (size_t j = 0; j < names.size(); ++j)
    if (params.joint_names[j]) names[j] = params.joint_names[j];
  return names;
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

// character: whose animations are taken; or null.
CharacterParams checked(const focal_skeleton_params& params, const DetectionObject& detection,
                        const MeshObject* character) {
  check(params);
  CharacterParams result;
  result.by_template = template_of(params, *detection.model);
  const size_t joints =
      result.by_template ? result.by_template->joints.size() : detection.model->info.joint_names.size();
  result.own_names = own_names(params, joints);
  result.fixed = fixed_joints(params, joints);
  result.symmetric = params.symmetric != 0;
  result.influences = params.max_influences;
  result.drop_helpers = params.drop_helpers != 0;
  result.rest_pose = static_cast<RestPose>(params.rest_pose);
  result.names = static_cast<BoneNames>(params.names);
  result.ground_root = params.ground_root != 0;
  result.file = detection.mesh->file.get();
  if (!character) return result;
  result.animations = &file_of(*character, "the character has no glTF file to take animations from");
  result.scale = detection.mesh->mesh->scale / character->mesh->scale;
  return result;
}

// The mesh's own file with the skeleton, and with the landmarks where some were looked for.
SourceFile with_skeleton(const SkeletonObject& object, const std::filesystem::path& path) {
  const TriangleMesh& mesh = object.mesh->mesh->source;
  const SourceFile* const own = object.mesh->file.get();
  SourceFile source = source_file(own, mesh, path);
  if (object.keeps_joints)
    source.document.replace_weights(source.primitives, object.character.rig.rig);
  else
    put_skeleton(object.character, mesh, own, source);
  if (object.detection) put_landmarks(*object.detection, source);
  return source;
}

constexpr double max_joints = 65536;

[[noreturn]] void fail(uint64_t joint, const std::string& what, const std::string& hint) {
  throw Error(Status::invalid_argument, "joint " + std::to_string(joint) + " " + what, hint);
}

Vector3 triple_at(const float* values, uint64_t joint) {
  return Eigen::Map<const Eigen::Vector3f>(values + 3 * joint).cast<double>();
}

Joint joint_at(const focal_bind_params& params, uint64_t j) {
  if (!params.joint_names[j] || !*params.joint_names[j]) fail(j, "has no name", "give every joint a name");
  const int32_t parent = params.joint_parents[j];
  if (parent < -1 || parent >= static_cast<int32_t>(j))
    fail(j, "hangs on joint " + std::to_string(parent) + ", which does not come before it",
         "list parents first; -1 stands for a root");
  Joint joint{params.joint_names[j], parent};
  const Vector3 place = triple_at(params.joint_positions, j);
  if (!place.allFinite()) fail(j, "lies at no place", "pass finite positions");
  joint.bind.topRightCorner<3, 1>() = place;
  if (params.joint_rotations) {
    Eigen::Quaterniond q(Eigen::Map<const Eigen::Vector4f>(params.joint_rotations + 4 * j).cast<double>());
    if (!(q.coeffs().allFinite() && q.norm() > 1e-6)) fail(j, "is turned by no rotation", "pass quaternions");
    joint.bind.topLeftCorner<3, 3>() = q.normalized().toRotationMatrix();
  }
  return joint;
}

OwnSkeleton given_skeleton(const focal_bind_params& params) {
  check_range("focal_bind_params.joint_count", static_cast<double>(params.joint_count), 1, max_joints);
  require(params.joint_parents, "focal_bind_params.joint_parents");
  require(params.joint_positions, "focal_bind_params.joint_positions");
  OwnSkeleton result;
  for (uint64_t j = 0; j < params.joint_count; ++j) {
    result.joints.push_back(joint_at(params, j));
    result.moves.push_back(!params.joint_moves || params.joint_moves[j] != 0);
    result.tip.emplace_back();
    if (!params.joint_tips) continue;
    if (const Vector3 tip = triple_at(params.joint_tips, j); tip.allFinite()) result.tip.back() = tip;
  }
  return result;
}

OwnSkeleton skeleton_in_file(const focal_bind_params& params, const MeshObject& mesh) {
  if (params.joint_count > 0 || params.joint_parents || params.joint_positions || params.joint_rotations ||
      params.joint_tips || params.joint_moves)
    throw Error(Status::invalid_argument, "focal_bind_params.joint_names is NULL, other fields are not",
                "give all joints, or none to take those of the mesh's own file");
  const SourceFile& file =
      file_of(mesh, "the mesh has no glTF file to take a skeleton from", "pass joints, or ");
  const auto rig = file.document.rig(file.primitives);
  if (!rig)
    throw Error(Status::invalid_argument, "the mesh has no skin, hence no joints to keep",
                "rig it with a model, or pass joints");
  return own_skeleton_of(*rig);
}

focal_joint to_abi(const CharacterRig& rig, size_t index) {
  const Joint& from = rig.rig.joints[index];
  focal_joint to{};
  to.parent = from.parent;
  to.name = from.name.c_str();
  to.confidence = rig.confidence[index];
  position_out(place_of(from), to.position);
  position_out(rig.tip[index], to.tip);
  const Eigen::Quaterniond q(Matrix3(from.bind.topLeftCorner<3, 3>()));
  for (int i = 0; i < 4; ++i) to.rotation[i] = static_cast<float>(q.coeffs()[i]);
  return to;
}

}  // namespace

uint32_t focal_model_joint_count(const focal_model* model) {
  return guarded_value<uint32_t>([&] { return resolve<ModelObject>(model)->info.joint_names.size(); });
}

const char* focal_model_joint_name(const focal_model* model, uint32_t index) {
  return guarded_value<const char*>(
      [&] { return text_at(resolve<ModelObject>(model)->info.joint_names, index, "the model", "joints"); });
}

focal_status focal_skeleton_create(const focal_detection* detection, const focal_skeleton_params* params,
                                   focal_task* task, focal_skeleton** out_skeleton) {
  return guarded([&] {
    require(out_skeleton, "out_skeleton");
    const auto object = std::make_shared<SkeletonObject>();
    object->detection = resolve<DetectionObject>(detection);
    object->mesh = object->detection->mesh, object->context = object->detection->model->context;
    const focal_skeleton_params how = read_struct(params);
    const auto character = how.animations ? resolve<MeshObject>(how.animations) : nullptr;
    const CharacterParams wanted = checked(how, *object->detection, character.get());
    const TaskLease lease(task);
    const Execution execution = object->context->execution_with(lease.task());
    object->character = make_character(object->detection->detection, wanted, execution);
    object->context->report_warnings(object->character.rig.warnings);
    *out_skeleton = publish(object, *object->context);
  });
}

focal_status focal_skeleton_bind(const focal_context* context, const focal_mesh* mesh,
                                 const focal_bind_params* params, focal_task* task,
                                 focal_skeleton** out_skeleton) {
  return guarded([&] {
    require(out_skeleton, "out_skeleton");
    const auto object = std::make_shared<SkeletonObject>();
    object->context = resolve<ContextObject>(context);
    object->mesh = resolve<MeshObject>(mesh);
    const focal_bind_params how = read_struct(params);
    check_range("focal_bind_params.max_influences", how.max_influences, 1, 2 * max_influences);
    object->keeps_joints = !how.joint_names;
    const OwnSkeleton skeleton =
        object->keeps_joints ? skeleton_in_file(how, *object->mesh) : given_skeleton(how);
    const TaskLease lease(task);
    const Execution execution = object->context->execution_with(lease.task());
    object->character.rig = weights_for(skeleton, object->mesh->mesh, how.max_influences, execution);
    object->context->report_warnings(object->character.rig.warnings);
    *out_skeleton = publish(object, *object->context);
  });
}

focal_status focal_skeleton_destroy(focal_skeleton* skeleton) {
  return remove_handle(skeleton, HandleType::skeleton);
}

focal_status focal_skeleton_get_info(const focal_skeleton* skeleton, focal_skeleton_info* out_info) {
  return guarded([&] {
    const auto object = resolve<SkeletonObject>(skeleton);
    const Character& character = object->character;
    const Rig& rig = character.rig.rig;
    focal_skeleton_info info{};
    info.joint_count = static_cast<uint32_t>(rig.joints.size());
    info.warning_count = static_cast<uint32_t>(character.rig.warnings.size());
    info.vertex_count = rig.influences.size();
    info.quality = character.quality;
    info.verdict = static_cast<focal_verdict>(character.verdict);
    info.guessed_joints = character.guessed_joints;
    info.influences_per_vertex = (rig.more.empty() ? 1 : 2) * max_influences;
    const InfluenceCount used = count_influences(rig);
    info.max_influences = used.most;
    info.unweighted_vertices = used.unweighted;
    write_result(out_info, info);
  });
}

focal_status focal_skeleton_get_joint(const focal_skeleton* skeleton, uint32_t index,
                                      focal_joint* out_joint) {
  return guarded([&] {
    const auto object = resolve<SkeletonObject>(skeleton);
    check_index(index, object->character.rig.rig.joints.size(), "the skeleton", "joints");
    write_result(out_joint, to_abi(object->character.rig, index));
  });
}

focal_status focal_skeleton_weights(const focal_skeleton* skeleton, uint64_t vertex_count,
                                    uint32_t* out_joints, float* out_weights) {
  return guarded([&] {
    require(out_joints, "out_joints");
    require(out_weights, "out_weights");
    const auto object = resolve<SkeletonObject>(skeleton);
    const Rig& rig = object->character.rig.rig;
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
  return guarded_value<const char*>([&] {
    return text_at(resolve<SkeletonObject>(skeleton)->character.rig.warnings, index, "the skeleton",
                   "warnings");
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
    const auto& joints = object->character.rig.rig.joints;
    SourceFile source = with_skeleton(*object, file);
    source.document.add_vrm(joints, bone_roles(joints), meta);
    object->context->report_warnings(write_document(source.document, file));
  });
}
