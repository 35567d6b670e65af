// Landmarks that follow from a skeleton and its skin weights: points of the rings where a joint's part of the surface begins,
// and the tips of the parts where a chain ends.
#pragma once
#include <vector>

#include "model/training_set.h"

namespace focal {

// vertices x joints: the weight of each joint and all that hangs on it.
RowMatrixf weights_below(const std::vector<SkeletonJoint>& skeleton,
                         const std::vector<VertexInfluences>& influences);

// Per joint the vertex of its own part that lies farthest from it; the joint's place when it has no part.
std::vector<Vector3> joint_tips(const TriangleMesh& surface, const ShapeRig& rig);

// Names the landmarks of a set of shapes in like poses and marks them on each; at most so many, none nearly where another is.
void mark_by_skeleton(TrainingSet& set, int32_t most);

}  // namespace focal
