// Whether a rig can be used as it is: measures taken while it was computed, one number, and a verdict in
// three classes.
#pragma once
#include <limits>
#include <string>
#include <vector>

#include "skeleton/character_rig.h"
#include "skeleton/fixed_joints.h"

namespace focal {

enum class Verdict : int32_t { good = 0, check = 1, failed = 2 };

// NaN: not measured. Shares are 0..1 of the joints, bones or pairs concerned; lengths are in units of the
// longest side of the body's bounding box unless stated otherwise.
struct RigMeasures {
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

  double category_fit = unknown;     // see Detection
  double map_residual = unknown;     // likewise
  double bulge_agreement = unknown;  // likewise
  double cost_margin = unknown;      // extra cost of the second-best configuration; infinite: none is close
  double surface_distance = unknown, heading_margin = unknown;  // see CharacterRig
  double joint_spread = unknown;                                // mean over the joints of 1 - agreement
  double absent_share = unknown;                                // joints without a found landmark
  // In sqrt(area): the distance, exceeded by a twentieth of the mesh, from a training character posed by the
  // joints.
  double uncovered = unknown;
  // Measures that need no training: a skeleton with any of these is collapsed.
  double outside_share = 0;    // joints that move vertices, far outside the body's box
  double long_share = 0;       // bones longer than any body allows
  double collapsed_share = 0;  // bones of no length that have one on the training characters
  double merged_share = 0;     // pairs of a left and a right joint that nearly coincide
  double crossed_share = 0;    // bones of one side that cross over to the other
  double bone_strain = 0;      // mean |log| of the bones' lengths relative to the training characters
};

// Names of the joints whose own landmarks are all absent: the rest of the body places them.
std::vector<std::string> guessed_joints(const Detection& detection);

// rig: of this detection, with the joints' names as in the model or template.
RigMeasures rig_measures(const Detection& detection, const CharacterRig& rig);

double rig_quality(const RigMeasures& measures);  // 0..1
Verdict verdict_of(const RigMeasures& measures);
const char* name_of(Verdict verdict);

// Converts the agreement of the training characters on each joint to the probability that its error is below
// 5 % of the longest side of the body's bounding box. Joints that are fixed or have no position keep their 1
// or 0. rig: of transfer_rig.
void calibrate_confidence(double quality, const FixedJoints& fixed, CharacterRig& rig);

// Warnings about the rig, the worst first; empty for one without defects.
std::vector<std::string> doubts_about(const RigMeasures& measures);

}  // namespace focal
