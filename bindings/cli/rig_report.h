// What the ways to a skeleton report alike.
#pragma once
#include "handles.h"
#include "output.h"

namespace focal_cli {

Json joints_json(const focal_skeleton* skeleton);   // name, parent, position, tip, confidence of each
Json weights_json(const focal_skeleton* skeleton);  // max_influences, unweighted_vertices
void add_skeleton_warnings(Json& warnings, const focal_skeleton* skeleton);
void print_joints(const Json& joints);  // a table

}  // namespace focal_cli
