// Landmarks derived from a skeleton and its skin weights: points of the rings where a joint's part of the
// surface starts, and the tips of the parts at the end of a chain.
#pragma once
#include <vector>

#include "model/training_set.h"

namespace focal {

// vertices x joints: the weight of each joint and its descendants.
RowMatrixf weights_below(const std::vector<SkeletonJoint>& skeleton,
                         const std::vector<VertexInfluences>& influences);

// For each joint the vertex of its own part that is farthest from it; the joint's position when it has no
// part.
std::vector<Vector3> joint_tips(const TriangleMesh& surface, const ShapeRig& rig);

// Names the landmarks of a set of shapes in similar poses and sets them on each; at most `most`, with a
// minimum distance between them.
void mark_by_skeleton(TrainingSet& set, int32_t most);

}  // namespace focal
