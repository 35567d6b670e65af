// A root on the ground comes first and above all; nothing else changes.
#include <doctest/doctest.h>

#include "skeleton/rig_edits.h"

using namespace focal;

TEST_CASE("the root lies below the hips on the ground, the rest is numbered one higher") {
  CharacterRig character;
  for (const auto& [name, parent] : {std::pair{"hips", -1}, {"head", 0}, {"prop", -1}}) {
    Joint joint{name, parent};
    joint.bind.topRightCorner<3, 1>() = Vector3(0.25, 1, -0.5);
    character.rig.joints.push_back(joint);
    character.tip.emplace_back(0, 2, 0), character.confidence.push_back(0.5),
        character.rest.push_back(joint.bind);
  }
  character.rig.influences = {{{{1, 0.75F}, {0, 0.25F}}}, {}};
  TriangleMesh mesh;
  mesh.positions.resize(2, 3);
  mesh.positions << 0, -0.125, 0, 0, 2, 0;
  add_ground_root("root", mesh, character);
  const auto& joints = character.rig.joints;
  REQUIRE(joints.size() == 4);
  CHECK(joints[0].name == "root");
  CHECK(joints[0].parent == -1);
  CHECK(Vector3(joints[0].bind.topRightCorner<3, 1>()) == Vector3(0.25, -0.125, -0.5));
  CHECK(joints[1].parent == 0);
  CHECK(joints[2].parent == 1);
  CHECK(joints[3].parent == 0);
  CHECK(character.rig.influences[0][0].joint == 2);
  CHECK(character.rig.influences[0][1].joint == 1);
  CHECK(character.rig.influences[0][2].joint == 0);  // no weight, no joint
  CHECK(character.rig.influences[1][0].weight == 0);
  CHECK(character.tip.size() == 4);
  CHECK(character.confidence == std::vector<double>{1, 0.5, 0.5, 0.5});
  CHECK(character.rest[0] == joints[0].bind);
}
