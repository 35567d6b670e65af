// Weights for a skeleton that is there already.
#include <Eigen/Geometry>
#include <string>
#include <utility>

#include "arguments.h"
#include "base/error.h"
#include "boundary.h"
#include "gltf/document.h"
#include "skeleton.h"
#include "skeleton/own_skeleton.h"
#include "structs.h"
#include "task.h"

namespace focal {

template <>
struct StructTraits<focal_bind_params> {
  static constexpr const char* name = "focal_bind_params";
  static constexpr size_t first_size = sizeof(focal_bind_params);
  static focal_bind_params defaults() {
    focal_bind_params params{};
    params.max_influences = max_influences;
    return params;
  }
};
static_assert(sizeof(void*) != 8 ||
              (sizeof(focal_bind_params) == 64 && offsetof(focal_bind_params, joint_moves) == 56));

namespace {

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
  if (!mesh.document)
    throw Error(Status::invalid_argument, "the mesh has no glTF file to take a skeleton from",
                "pass joints, or load it with focal_mesh_load_gltf and focal_mesh_params.keep_source_file 1");
  const auto rig = mesh.document->rig(mesh.primitives);
  if (!rig)
    throw Error(Status::invalid_argument, "the mesh has no skin, hence no joints to keep",
                "rig it with a model, or pass joints");
  return own_skeleton_of(*rig);
}

}  // namespace
}  // namespace focal

using namespace focal;

focal_status focal_bind_params_init(focal_bind_params* params, size_t struct_size) {
  return guarded([&] { init_struct(params, struct_size); });
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
    execution.check_cancelled();
    object->rig = weights_for(skeleton, object->mesh->mesh, how.max_influences, execution);
    object->verdict = Verdict::good, object->quality = 1;
    object->context->report_warnings(object->rig.warnings);
    *out_skeleton = publish(object);
  });
}
