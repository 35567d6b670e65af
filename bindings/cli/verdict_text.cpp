#include "verdict_text.h"

#include "handles.h"
#include "text_table.h"

namespace focal_cli {

RigVerdict verdict_of(const focal_skeleton* skeleton, const focal_detection* detection) {
  auto info = initialised(focal_skeleton_info_init);
  check(focal_skeleton_get_info(skeleton, &info));
  auto found = initialised(focal_detection_info_init);
  check(focal_detection_get_info(detection, &found));
  return {info.verdict, info.quality, found.category_fit, info.joint_count, info.guessed_joints};
}

const char* verdict_name(focal_verdict verdict) {
  return verdict == FOCAL_VERDICT_GOOD ? "good" : verdict == FOCAL_VERDICT_CHECK ? "check" : "failed";
}

std::string verdict_text(const RigVerdict& verdict) {
  std::string text =
      std::string(verdict_name(verdict.verdict)) + ", quality " + percent_text(verdict.quality, 0);
  if (verdict.guessed_joints > 0)
    text += "; " + std::to_string(verdict.guessed_joints) + " of " + std::to_string(verdict.joints) +
            (verdict.guessed_joints == 1 ? " joints is a guess" : " joints are guesses");
  return text;
}

std::string verdict_hint(const RigVerdict& verdict) {
  constexpr double foreign = 0.1;  // category fit
  if (verdict.verdict == FOCAL_VERDICT_GOOD) return "";
  if (verdict.category_fit < foreign)
    return "the mesh is unlike the training characters: use a model of its category, or train on characters "
           "like "
           "it too";
  if (verdict.guessed_joints > 0)
    return "mark the points that were not found (fixed points in Python, C and Blender), or train on more "
           "characters like this one";
  return "look at it; mark points that are wrong (fixed points in Python, C and Blender), or train on more "
         "characters like this one";
}

void add_verdict(Json& report, const RigVerdict& verdict) {
  report["verdict"] = verdict_name(verdict.verdict);
  report["quality"] = verdict.quality;
  report["guessed_joints"] = verdict.guessed_joints;
}

}  // namespace focal_cli
