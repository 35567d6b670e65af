// A part of the body with many short bones, such as a hand. The whole body's proxy gives it too few vertices; cut out of the
// caller's own triangles it is analysed at a resolution of its own.
#pragma once
#include <vector>

#include "mesh/similarity.h"
#include "model/training_set.h"

namespace focal {

// Joints of the skeleton whose parts are worth it: bones branch there, and those beyond are many and short beside the edges of a
// proxy. characters: rigs with the skeleton's names, and the square root of the area of each one's surface, in the same units.
struct SizedRig {
  const Rig* rig;
  double size;
};
std::vector<int32_t> detail_joints(const std::vector<SkeletonJoint>& skeleton,
                                   const std::vector<SizedRig>& characters);

// Per joint: whether it is the root or hangs on it. Parents come before their children.
template <class AnyJoint>
std::vector<char> at_or_below(const std::vector<AnyJoint>& joints, int32_t root) {
  std::vector<char> result(joints.size(), 0);
  for (size_t j = 0; j < joints.size(); ++j)
    result[j] = static_cast<int32_t>(j) == root || (joints[j].parent >= 0 && result[joints[j].parent]);
  return result;
}

// The joints of such a part: its root's parent, where it has one, its root, and all that hang on it, in the skeleton's order.
std::vector<int32_t> joints_of_part(const std::vector<SkeletonJoint>& skeleton, int32_t root);

inline constexpr double root_trust =
    3;  // of the root's place beside one of the joints beyond it, where frames are fitted

// A frame of which +Y leads from the part's root to where its bones end and X across them, with the root at its origin.
// places: of the joints of the part; first of them the root's.
Similarity frame_of(const std::vector<Vector3>& places);

struct DetailRegion {
  TriangleMesh mesh;                         // in the part's frame
  std::vector<VertexInfluences> influences;  // of the character's joints, one a vertex
  std::vector<int32_t> source_vertex;        // per vertex: the character's, or -1 where the cut runs
};

// Cuts the part out of the triangles: what the joints of the part move, above `start` in the part's frame. frame: from the part's
// frame to the triangles' coordinates.
DetailRegion cut_region(const TriangleMesh& mesh, const std::vector<VertexInfluences>& influences,
                        const std::vector<char>& is_of_part, const Similarity& frame, double start);

}  // namespace focal
