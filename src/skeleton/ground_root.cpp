#include "skeleton/ground_root.h"

namespace focal {
namespace {

void shift(std::vector<VertexInfluences>& all) {
  for (VertexInfluences& vertex : all)
    for (Influence& one : vertex)
      if (one.weight > 0) ++one.joint;
}

}  // namespace

void add_ground_root(const std::string& name, const TriangleMesh& mesh, CharacterRig& character) {
  auto& joints = character.rig.joints;
  Joint root{name};
  const Vector3 above = joints.front().bind.topRightCorner<3, 1>();
  root.bind.topRightCorner<3, 1>() = Vector3(above[0], mesh.positions.col(1).minCoeff(), above[2]);
  for (Joint& joint : joints) ++joint.parent;  // it becomes the parent of the roots
  joints.insert(joints.begin(), root);
  character.tip.insert(character.tip.begin(), above);
  character.confidence.insert(character.confidence.begin(), 1);
  if (!character.left_out.empty()) character.left_out.insert(character.left_out.begin(), 0);
  if (!character.rest.empty()) character.rest.insert(character.rest.begin(), root.bind);
  shift(character.rig.influences), shift(character.rig.more);
}

}  // namespace focal
