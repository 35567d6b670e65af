// A skeleton and skin weights for one detected mesh: what the ways of making them have in common.
#pragma once
#include <limits>
#include <string>
#include <vector>

#include "landmarks/detect.h"
#include "mesh/rig.h"

namespace focal {

struct CharacterRig {
  Rig rig;                   // in the coordinates of mesh->source; influences a source vertex
  std::vector<Vector3> tip;  // per joint the far end of its part, in the same coordinates
  // Where each joint goes when the character takes the rest pose of those it was learned from: turned as theirs are, with bones
  // of its own length, its roots where they are. Empty: none is known.
  std::vector<Matrix4> rest;
  // Per joint 0..1: how far the training characters agree on it, until calibrate_confidence (verdict.h) makes a probability of it.
  std::vector<double> confidence;
  // Of a training character that was fitted to the body: its distance from it, of sqrt(area), and the share by which one that faces
  // the other way lies farther off, infinite: none was tried. NaN: none was fitted.
  double surface_distance = std::numeric_limits<double>::quiet_NaN();
  double heading_margin = std::numeric_limits<double>::quiet_NaN();
  std::vector<char> left_out = {};  // per joint: the mesh has no such part, nothing is moved; empty: none is
  std::vector<std::string> warnings;
};

inline Vector3 place_of(const Joint& joint) { return joint.bind.topRightCorner<3, 1>(); }
std::vector<std::string> names_of(const std::vector<Joint>& joints);

// Per joint where its bones lead from it, summed; to its tip where there are none. parent: -1: a root.
std::vector<Vector3> bone_directions(const std::vector<int32_t>& parent, const std::vector<Vector3>& place,
                                     const std::vector<Vector3>& tip);

// From the coordinates of the analysed surface to those of the caller's mesh.
struct ToCaller {
  explicit ToCaller(const SurfaceAnalysis& analysis);
  Vector3 operator()(const Vector3& p) const { return offset + scale * p; }

  double scale = 1;
  Vector3 offset = Vector3::Zero();
};

// Puts the heaviest weights of a row (one a joint, >= 0), `most` of 1 to 8, where a vertex of the rig has its influences.
void put_influences(const Eigen::Ref<const Eigen::RowVectorXf>& weights, int32_t most, size_t vertex,
                    Rig& rig);
// All of one vertex, with what is in `more`; and the same back, at most as many as there is room for.
std::vector<Influence> influences_of(const Rig& rig, size_t vertex);
void put_influences(const std::vector<Influence>& influences, size_t vertex, Rig& rig);
// Room for the influences of so many vertices, none of which any joint moves yet.
void clear_influences(size_t vertices, int32_t most, Rig& rig);

// From weights at the vertices of the analysed surface (vertices x joints, >= 0) to the heaviest of each source vertex.
void put_influences_on_source(const RowMatrixf& weights, const SurfaceAnalysis& analysis, int32_t most,
                              Rig& rig, const Execution& execution);

// Per joint the one on the other side by its name (see mirrored_name), -1: none.
std::vector<int32_t> other_sides(const std::vector<Joint>& joints);

// Both sides get bones of the same length, each joint moved along its bone; pairs are told by their names (see mirrored_name).
// Of a pair the side that is known better counts more. The limbs keep their pose.
void make_bones_symmetric(CharacterRig& character);

}  // namespace focal
