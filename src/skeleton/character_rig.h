// A skeleton and skin weights for one detected mesh: the common part of the methods that create them.
#pragma once
#include <limits>
#include <string>
#include <vector>

#include "landmarks/detect.h"
#include "mesh/rig.h"

namespace focal {

struct CharacterRig {
  Rig rig;                   // in the coordinates of mesh->source; one entry of influences per source vertex
  std::vector<Vector3> tip;  // per joint the far end of its part, in the same coordinates
  // Each joint in the rest pose of the training characters: with their rotations, bones of its own lengths,
  // and unmoved roots. Empty: unknown.
  std::vector<Matrix4> rest;
  // Per joint 0..1: agreement of the training characters, until calibrate_confidence (verdict.h) converts it
  // to a probability.
  std::vector<double> confidence;
  // Of a training character that was fitted to the body: its distance from it, in sqrt(area), and the
  // fraction by which one with the opposite heading is farther, infinite: none was tried. NaN: none was
  // fitted.
  double surface_distance = std::numeric_limits<double>::quiet_NaN();
  double heading_margin = std::numeric_limits<double>::quiet_NaN();
  // Per joint: the mesh has no such part, the joint moves no vertex; empty: none.
  std::vector<char> left_out = {};
  std::vector<std::string> warnings;
};

inline Vector3 place_of(const Joint& joint) { return joint.bind.topRightCorner<3, 1>(); }
std::vector<std::string> names_of(const std::vector<Joint>& joints);

// For each joint the sum of the directions to its children, or to its tip without children. parent: -1: a
// root.
std::vector<Vector3> bone_directions(const std::vector<int32_t>& parent, const std::vector<Vector3>& place,
                                     const std::vector<Vector3>& tip);

// Converts coordinates of the analysed surface to those of the caller's mesh.
struct ToCaller {
  explicit ToCaller(const SurfaceAnalysis& analysis);
  Vector3 operator()(const Vector3& p) const { return offset + scale * p; }

  double scale = 1;
  Vector3 offset = Vector3::Zero();
};

// Stores the `most` (1 to 8) largest weights of a row (one per joint, >= 0) as the influences of a vertex of
// the rig.
void put_influences(const Eigen::Ref<const Eigen::RowVectorXf>& weights, int32_t most, size_t vertex,
                    Rig& rig);
// All influences of one vertex, including those in `more`; and the inverse, limited to the available space.
std::vector<Influence> influences_of(const Rig& rig, size_t vertex);
void put_influences(const std::vector<Influence>& influences, size_t vertex, Rig& rig);
// Allocates empty influences for this number of vertices.
void clear_influences(size_t vertices, int32_t most, Rig& rig);

// Converts weights at the vertices of the analysed surface (vertices x joints, >= 0) to the largest of each
// source vertex.
void put_influences_on_source(const RowMatrixf& weights, const SurfaceAnalysis& analysis, int32_t most,
                              Rig& rig, const Execution& execution);

// For each joint the counterpart by its name (see mirrored_name), -1: none.
std::vector<int32_t> other_sides(const std::vector<Joint>& joints);

// Gives both sides bones of the same length by moving each joint along its bone; pairs are recognised by
// their names (see mirrored_name). Of a pair the side of higher confidence counts more. The limbs keep their
// pose.
void make_bones_symmetric(CharacterRig& character);

}  // namespace focal
