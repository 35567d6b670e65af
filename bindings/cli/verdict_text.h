// What the library thinks of a rig, and what to do about it.
#pragma once
#include <string>

#include "output.h"

namespace focal_cli {

// Of a skeleton made of this detection.
struct RigVerdict {
  focal_verdict verdict = FOCAL_VERDICT_GOOD;
  double quality = 0, category_fit = 0;
  uint32_t joints = 0, guessed_joints = 0;

  bool failed() const { return verdict == FOCAL_VERDICT_FAILED; }
};
RigVerdict verdict_of(const focal_skeleton* skeleton, const focal_detection* detection);

const char* verdict_name(focal_verdict verdict);            // good, check, failed
std::string verdict_text(const RigVerdict& verdict);        // one line
std::string verdict_hint(const RigVerdict& verdict);        // empty for a good one
void add_verdict(Json& report, const RigVerdict& verdict);  // "verdict", "quality", "guessed_joints"

}  // namespace focal_cli
