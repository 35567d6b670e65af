// The rig that a character gets: made of a detection, judged, posed, named and animated; and put into a glTF file.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "gltf/output_file.h"
#include "skeleton/bone_names.h"
#include "skeleton/skeleton_template.h"
#include "skeleton/verdict.h"

namespace focal {

enum class RestPose : int32_t { of_mesh = 0, of_teachers = 1, t = 2, a = 3 };

struct CharacterParams {
  std::optional<SkeletonTemplate> by_template =
      {};                               // nothing: the skeleton of its rigged training characters
  bool symmetric = false;               // see make_symmetric; a template says so itself
  int32_t influences = max_influences;  // of one vertex at most, 1 to 8
  FixedJoints fixed = {};               // in the coordinates of mesh->source
  bool drop_helpers = false;
  RestPose rest_pose = RestPose::of_mesh;
  BoneNames names = BoneNames::as_trained;
  std::vector<std::optional<std::string>> own_names = {};  // per joint of the model or template; or none
  bool ground_root = false;
  const SourceFile* file = nullptr;        // of the mesh; null: none
  const SourceFile* animations = nullptr;  // of a character to take them from; null: none
  double scale = 1;                        // of the mesh's lengths, those of that character being 1
};

struct Character {
  CharacterRig rig;
  Verdict verdict = Verdict::good;
  double quality = 1;
  uint32_t guessed_joints = 0;
  std::vector<JointAnimation> animations;
  std::vector<Matrix4> shown_pose;  // per joint, as the file shows them; empty: in the pose of the mesh
};

// Throws what rig_by_template, transfer_rig and animations_for throw, and invalid_argument: no such rest pose.
Character make_character(const Detection& detection, const CharacterParams& params,
                         const Execution& execution);

// Adds the skeleton in place of the one that `own`, the mesh's own file, may have. mesh: the file's, merged.
void put_skeleton(const Character& character, const TriangleMesh& mesh, const SourceFile* own,
                  SourceFile& file);

struct InfluenceCount {
  uint32_t most = 0;        // of one vertex
  uint64_t unweighted = 0;  // vertices that no joint moves
};
InfluenceCount count_influences(const Rig& rig);

}  // namespace focal
