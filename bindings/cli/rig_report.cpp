#include "rig_report.h"

#include <iostream>

#include "text_table.h"

namespace focal_cli {
namespace {

focal_skeleton_info info_of(const focal_skeleton* skeleton) {
  auto info = initialised(focal_skeleton_info_init);
  check(focal_skeleton_get_info(skeleton, &info));
  return info;
}

}  // namespace

Json joints_json(const focal_skeleton* skeleton) {
  std::vector<focal_joint> joints(info_of(skeleton).joint_count);
  Json list = Json::array();
  for (uint32_t i = 0; i < joints.size(); ++i) {
    joints[i] = initialised(focal_joint_init);
    check(focal_skeleton_get_joint(skeleton, i, &joints[i]));
    const int32_t parent = joints[i].parent;
    list.push_back({{"name", joints[i].name},
                    {"parent", parent < 0 ? Json() : Json(joints[static_cast<size_t>(parent)].name)},
                    {"position", triple(joints[i].position)},
                    {"tip", triple(joints[i].tip)},
                    {"confidence", joints[i].confidence}});
  }
  return list;
}

Json weights_json(const focal_skeleton* skeleton) {
  const focal_skeleton_info info = info_of(skeleton);
  return {{"max_influences", info.max_influences}, {"unweighted_vertices", info.unweighted_vertices}};
}

void add_skeleton_warnings(Json& warnings, const focal_skeleton* skeleton) {
  const uint32_t count = info_of(skeleton).warning_count;
  for (uint32_t i = 0; i < count; ++i) warnings.push_back(focal_skeleton_warning(skeleton, i));
}

void print_joints(const Json& joints) {
  std::vector<std::vector<std::string>> rows = {{"joint", "parent", "x", "y", "z", "confidence"}};
  for (const Json& joint : joints) {
    std::vector<std::string> row = {joint["name"],
                                    joint["parent"].is_null() ? "-" : joint["parent"].get<std::string>()};
    for (size_t axis = 0; axis < 3; ++axis)
      row.push_back(fixed_text(joint["position"][axis].get<double>(), 4));
    row.push_back(percent_text(joint["confidence"].get<double>(), 0));
    rows.push_back(std::move(row));
  }
  print_table(std::cout, rows);
}

}  // namespace focal_cli
