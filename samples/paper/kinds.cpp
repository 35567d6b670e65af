#include "kinds.h"

#include <map>

namespace paper {
namespace {

const std::map<std::string, Kinds>& listed() {
  static const Kinds human = {
      {"head_top", "middle_finger.L", "middle_finger.R", "toe.L", "toe.R"},
      {"elbow_outer.L", "elbow_outer.R", "knee_front.L", "knee_front.R", "shoulder.L", "shoulder.R"},
      {"navel", "lower_back"}};
  static const std::map<std::string, Kinds> sets = {
      {"scape", human},
      {"human07", human},
      {"lion",
       {{"front_paw_outer.L", "front_paw_outer.R", "back_paw_outer.L", "back_paw_outer.R", "tail_tip",
         "nose_top"},
        {"tail_base_top"},
        {"belly"}}},
      {"teddy",
       {{"arm_tip.L", "arm_tip.R", "leg_tip.L", "leg_tip.R"}, {"ear_tip.L", "ear_tip.R"}, {"belly", "back"}}},
      {"ant",
       {{"leg1_tip.L", "leg1_tip.R", "leg2_tip.L", "leg2_tip.R", "leg3_tip.L", "leg3_tip.R", "leg4_tip.L",
         "leg4_tip.R", "head", "tail"},
        {},
        {"neck_top", "body_top", "leg4_base.L", "leg4_base.R"}}},
      {"hand",
       {{"thumb_tip", "index_tip", "middle_tip", "ring_tip", "little_tip"},
        {"thumb_base", "index_base", "middle_base", "ring_base", "little_base", "valley_index_thumb",
         "valley_middle_index", "valley_ring_middle", "valley_little_ring"},
        {}}},
      {"humanoid",
       {{"crown", "handTip.L", "handTip.R", "toeTip.L", "toeTip.R"},
        {"elbow.L", "elbow.R", "knee.L", "knee.R", "shoulder.L", "shoulder.R"},
        {"navel", "chest"}}},
      {"quadruped",
       {{"frontToe.L", "frontToe.R", "hindToe.L", "hindToe.R", "tailTip", "nose"},
        {"elbow.L", "elbow.R"},
        {"belly", "withers"}}},
      {"sample hand",
       {{"thumbTip", "indexTip", "middleTip", "ringTip", "littleTip"},
        {"thumbKnuckle", "indexKnuckle", "middleKnuckle", "ringKnuckle", "littleKnuckle"},
        {"palm", "backOfHand"}}},
      {"insect",
       {{"frontTip.L", "frontTip.R", "middleTip.L", "middleTip.R", "hindTip.L", "hindTip.R", "abdomenTip"},
        {"frontKnee.L", "frontKnee.R", "hindKnee.L", "hindKnee.R"},
        {"thorax", "sternum"}}}};
  return sets;
}

}  // namespace

std::vector<std::string> Kinds::all() const {
  std::vector<std::string> names = tips;
  names.insert(names.end(), between.begin(), between.end());
  names.insert(names.end(), flat.begin(), flat.end());
  return names;
}

std::vector<std::string> Kinds::examples() const {
  std::vector<std::string> names;
  for (const auto* kind : {&tips, &between, &flat}) {
    for (const std::string& name : *kind) {
      if (kind == &flat || name.ends_with(".L") || name == kind->back()) {
        names.push_back(name);
        break;
      }
    }
  }
  return names;
}

Kinds kinds_of(const std::string& set, const std::vector<std::string>& landmarks) {
  const auto found = listed().find(set);
  return found == listed().end() ? Kinds{{}, landmarks, {}} : found->second;
}

namespace {

template <class Row>
const Row* row_of(const std::map<std::string, Row>& table, const std::string& set) {
  const auto found = table.find(set);
  return found == table.end() ? nullptr : &found->second;
}

}  // namespace

const PaperErrors* paper_errors_of(const std::string& set) {
  static const std::map<std::string, PaperErrors> table = {{"scape", {2.46, 2.57, 2.14, 2.46}},
                                                           {"lion", {2.85, 3.09, 4.16, 3.04}},
                                                           {"teddy", {3.79, 4.67, 4.21, 4.12}},
                                                           {"ant", {4.01, -1, 4.92, 4.27}},
                                                           {"hand", {3.24, 4.82, -1, 3.87}}};
  return row_of(table, set);
}

const PaperSeconds* paper_seconds_of(const std::string& set) {
  static const std::map<std::string, PaperSeconds> table = {
      {"scape", {9.56, 8.31, 66.12, 3.82, 3.09, 0.03, 1.33}},
      {"lion", {3.70, 0.85, 13.45, 1.51, 0.34, 0.03, 0.48}},
      {"teddy", {9.49, 10.63, 68.10, 3.81, 4.34, 0.03, 1.19}},
      {"ant", {6.42, 3.32, 26.63, 2.52, 1.27, 0.02, 0.74}},
      {"hand", {6.71, 3.69, 21.59, 2.64, 1.49, 0.02, 0.86}}};
  return row_of(table, set);
}

}  // namespace paper
