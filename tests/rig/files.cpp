// How well the skeletons of some rigged files are put on the meshes of others, measured against the skeletons that these have.
// Not a test with bounds: the figures go into docs/accuracy.md.
//   focal_rig_files --onto FILE.glb [--onto FILE.glb ...] CHARACTER.glb [CHARACTER.glb ...]
#include <cstdio>
#include <cstring>
#include <iostream>

#include "base/stopwatch.h"
#include "landmarks/train.h"
#include "mesh/section.h"
#include "model/landmark_model.h"
#include "rig/rigged_file.h"
#include "rig/skeleton_metrics.h"
#include "skeleton/rig_transfer.h"

namespace {

using namespace focal;

const Execution execution;  // one a core

// Joints that move vertices, and those between them and their root.
std::vector<Joint> deforming(const Rig& rig) {
  std::vector<bool> used(rig.joints.size(), false);
  for (const VertexInfluences& one : rig.influences)
    for (const Influence& influence : one)
      if (influence.weight > 0) used[influence.joint] = true;
  std::vector<int32_t> number(rig.joints.size(), -1);
  std::vector<Joint> result;
  for (size_t j = 0; j < rig.joints.size(); ++j) {
    const int32_t p = rig.joints[j].parent;
    if (!used[j]) {
      number[j] = p < 0 ? -1 : number[p];  // stands for the nearest above
      continue;
    }
    result.push_back(rig.joints[j]);
    result.back().parent = p < 0 ? -1 : number[p];
    number[j] = static_cast<int32_t>(result.size()) - 1;
  }
  return result;
}

void judge(const std::shared_ptr<const LandmarkModel>& model, const std::string& file) {
  const RiggedMesh truth = focal_test::read_rig(file);
  Stopwatch watch;
  const CharacterRig found = transfer_rig(detect(model, truth.mesh, DetectParams{}, execution), execution);
  const double seconds = watch.lap();
  const TriangleMesh& body = truth.mesh->source;
  const double unit = (body.positions.colwise().maxCoeff() - body.positions.colwise().minCoeff()).maxCoeff();
  const std::vector<Joint> joints = deforming(truth.rig), mine = deforming(found.rig);
  double error = 0;
  int same = 0, inside = 0;
  std::string outside;
  for (const Joint& joint : mine) {
    const bool within = winding_number(body, place_of(joint)) > 0.5;
    inside += within;
    if (!within) outside += " " + joint.name;
    for (const Joint& other : joints)
      if (other.name == joint.name) error += (place_of(joint) - place_of(other)).norm() / unit, ++same;
  }
  const auto m = focal_test::compare_skeletons(mine, joints, body);
  std::printf("%-20s %6zu %6zu %6d %6d %8.2f %8.2f %8.2f %8.2f %7.1f %7.1f %7.1f %6.2f %s\n",
              std::filesystem::path(file).stem().string().c_str(), joints.size(), mine.size(), inside, same,
              100 * error / std::max(same, 1), 100 * m.joints_to_joints, 100 * m.joints_to_bones,
              100 * m.bones_to_bones, 100 * m.iou, 100 * m.precision, 100 * m.recall, seconds,
              outside.c_str());
}

}  // namespace

int main(int count, char** arguments) {
  std::vector<std::string> onto, characters;
  for (int i = 1; i < count; ++i)
    if (!std::strcmp(arguments[i], "--onto") && i + 1 < count)
      onto.push_back(arguments[++i]);
    else
      characters.push_back(arguments[i]);
  if (onto.empty() || characters.empty())
    return std::cerr << "usage: focal_rig_files --onto FILE.glb CHARACTER.glb ...\n", 2;
  std::vector<RiggedMesh> rigs;
  for (const auto& file : characters) rigs.push_back(focal_test::read_rig(file));
  const auto model =
      std::make_shared<const LandmarkModel>(train(training_set_of(rigs, {}), TrainParams{}, execution));
  std::printf("%-20s %6s %6s %6s %6s %8s %8s %8s %8s %7s %7s %7s %6s %s\n", "mesh", "true", "found", "inside",
              "same", "joints %", "J2J %", "J2B %", "B2B %", "IoU %", "prec %", "rec %", "sec", "outside");
  for (const auto& file : onto) judge(model, file);
  return 0;
}
