// Whether a rig can be used as it is: what was measured while it was made, one number for it, and a verdict in three words.
#pragma once
#include <limits>
#include <string>
#include <vector>

#include "skeleton/character_rig.h"
#include "skeleton/fixed_joints.h"

namespace focal {

enum class Verdict : int32_t { good = 0, check = 1, failed = 2 };

// NaN: not measured. Shares are 0..1, of the joints, bones or pairs that the measure looks at; lengths are in units of the longest
// side of the body's box unless another unit stands there.
struct RigMeasures {
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

  double category_fit = unknown;     // see Detection
  double map_residual = unknown;     // likewise
  double bulge_agreement = unknown;  // likewise
  double cost_margin = unknown;      // how much more another configuration costs; infinite: none came near
  double surface_distance = unknown, heading_margin = unknown;  // see CharacterRig
  double joint_spread = unknown;                                // mean over the joints of 1 - agreement
  double absent_share = unknown;                                // joints without a found landmark
  double uncovered =
      unknown;  // of sqrt(area): how far a twentieth of the mesh lies, at least, from a training character that the joints pose
  // What needs no learning: a skeleton with any of these is crumpled.
  double outside_share = 0;    // joints that move vertices, far outside the body's box
  double long_share = 0;       // bones too long for any body
  double collapsed_share = 0;  // bones of no length that have one on the training characters
  double merged_share = 0;     // pairs of a left and a right joint nearly in one place
  double crossed_share = 0;    // bones of one side that lead over to the other
  double bone_strain = 0;      // mean |log| of the bones' lengths over those of the training characters
};

// Names of the joints whose own landmarks are all absent: they lie where the rest of the body suggests.
std::vector<std::string> guessed_joints(const Detection& detection);

// rig: made of this detection, with the joints' names as the model or template has them.
RigMeasures rig_measures(const Detection& detection, const CharacterRig& rig);

double rig_quality(const RigMeasures& measures);  // 0..1
Verdict verdict_of(const RigMeasures& measures);
const char* name_of(Verdict verdict);

// Turns how far the training characters agree on each joint into the chance that it lies within 5 % of the longest side of the body's
// box of where it belongs. Joints that are fixed or have no place keep their 1 or 0. rig: of transfer_rig.
void calibrate_confidence(double quality, const FixedJoints& fixed, CharacterRig& rig);

// Sentences on what speaks against the rig, the worst first; empty for one that is good in everything.
std::vector<std::string> doubts_about(const RigMeasures& measures);

}  // namespace focal
