// A body part with many short bones, such as a hand. The whole body's proxy has too few vertices there, so
// the part is cut out of the caller's own triangles and analysed at its own resolution.
#pragma once
#include <vector>

#include "mesh/similarity.h"
#include "model/training_set.h"

namespace focal {

// Joints of the skeleton whose parts qualify: bones branch there, and those beyond are many and short
// relative to the edges of a proxy. characters: rigs with the skeleton's names, and the square root of the
// area of each one's surface, in the same units.
struct SizedRig {
  const Rig* rig;
  double size;
};
std::vector<int32_t> detail_joints(const std::vector<SkeletonJoint>& skeleton,
                                   const std::vector<SizedRig>& characters);

// For each joint whether it is the root or a descendant of it. Parents come before their children.
template <class AnyJoint>
std::vector<char> at_or_below(const std::vector<AnyJoint>& joints, int32_t root) {
  std::vector<char> result(joints.size(), 0);
  for (size_t j = 0; j < joints.size(); ++j)
    result[j] = static_cast<int32_t>(j) == root || (joints[j].parent >= 0 && result[joints[j].parent]);
  return result;
}

// The joints of such a part: its root's parent, if it has one, its root, and all descendants, in the
// skeleton's order.
std::vector<int32_t> joints_of_part(const std::vector<SkeletonJoint>& skeleton, int32_t root);

// Weight of the root's position relative to one of the joints beyond it, when frames are fitted.
inline constexpr double root_trust = 3;

// A frame with +Y from the part's root to the end of its bones and X across them, with the root at its
// origin. places: of the joints of the part; first of them the root's.
Similarity frame_of(const std::vector<Vector3>& places);

struct DetailRegion {
  TriangleMesh mesh;                         // in the part's frame
  std::vector<VertexInfluences> influences;  // of the character's joints, one entry per vertex
  std::vector<int32_t> source_vertex;        // per vertex: the character's, or -1 on the cut
};

// Cuts the part out of the triangles: the surface that the part's joints move, above `start` in the part's
// frame. frame: from the part's frame to the triangles' coordinates.
DetailRegion cut_region(const TriangleMesh& mesh, const std::vector<VertexInfluences>& influences,
                        const std::vector<char>& is_of_part, const Similarity& frame, double start);

}  // namespace focal
