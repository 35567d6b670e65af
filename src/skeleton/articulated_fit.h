// Fits a training character to another body by bending its joints and scaling its bones in length and girth
// until the surfaces match. Unlike a map it cannot fold or exchange parts, so it places joints where maps of
// dissimilar bodies are blurred, and its residual shows the orientation of a body. Based on articulated
// iterative closest points (S. Pellegrini, K. Schindler, D. Nardi, "A Generalisation of the ICP Algorithm for
// Articulated Bodies", 2008), with point-to-plane distances and linear blend skinning.
#pragma once
#include <vector>

#include "mesh/nearest_vertex.h"
#include "mesh/triangle_mesh.h"
#include "model/landmark_model.h"

namespace focal {

// The surface to fit to, of area 1. Keeps references to its arguments.
struct FitTarget {
  explicit FitTarget(const TriangleMesh& surface);

  MatrixX3 positions, normals;
  Vector area;  // per vertex, sum 1
  NearestVertex tree;
};

// For each joint of a skeleton: position, rotation from the bind pose, and the scales of its part along and
// around its bone (logarithms).
struct Posture {
  std::vector<Vector3> place;
  std::vector<Matrix3> turn;
  Vector length, girth;
};

struct FitRounds {
  int32_t coarse = 10, fine = 5;  // rounds with a subset of the points, then with all
  double map_weight = 0;          // of the points' images relative to the surface's distance, decreasing to 0
};

class ArticulatedFit {
 public:
  // counterpart: per joint the one on the other side, or -1. shape has a rig. Keeps references to all three
  // arguments.
  ArticulatedFit(const std::vector<SkeletonJoint>& skeleton, const Exemplar& shape,
                 const std::vector<int32_t>& counterpart, const FitTarget& target);

  // images: one vertex of the target per point, or empty.
  void run(const FitRounds& rounds, const std::vector<int32_t>& images, Posture& posture) const;
  // Mean distance of the two surfaces in both directions, with penalties for different normals and bent
  // joints.
  double residual(const Posture& posture) const;
  MatrixX3 points(const Posture& posture) const;

  bool has(size_t joint) const { return shape_.rig->bind[joint].has_value(); }
  Vector3 bind_place(size_t joint) const { return shape_.rig->bind[joint]->topRightCorner<3, 1>(); }
  const Vector3& bone(size_t joint) const { return axis_[joint]; }  // unit direction in the bind pose
  Vector3 carried(const Posture& posture, size_t joint, const Vector3& place) const;

 private:
  struct Part {  // coordinates of a point that one joint moves: along its bone and away from it
    int32_t slot = 0;
    double weight = 0;
    Vector3 along = Vector3::Zero(), away = Vector3::Zero();
  };
  struct System;

  void choose_moving();
  void cut_into_parts();
  void estimate_normals();
  MatrixX3 normals(const Posture& posture) const;
  void add_bones(const Posture& posture, System& system) const;
  void add_point(const Posture& posture, Eigen::Index point, const Matrix3& metric, const Vector3& gap,
                 System& system) const;
  void unbend(Posture& posture) const;
  void move(const Vector& step, Posture& posture) const;
  void take_along(Posture& posture) const;
  // Calls pair(point, vertex, gap, weight) once for each corresponding point and vertex of the target.
  // Returns their mean distance, see residual.
  template <class Pair>
  double for_each_pair(const MatrixX3& points, const MatrixX3& normals, Eigen::Index stride,
                       Pair&& pair) const;

  const std::vector<SkeletonJoint>& skeleton_;
  const Exemplar& shape_;
  const std::vector<int32_t>& counterpart_;
  const FitTarget& target_;
  Vector weight_;                // of the points, sum 1
  MatrixX3 normals_;             // of the points
  std::vector<int32_t> moving_;  // joints that move on their own; small parts follow their parent
  std::vector<int32_t> slot_;    // per joint its number among them or that of the joint it follows; -1: none
  std::vector<int32_t> parent_;  // per moving joint the slot of its parent, or -1
  std::vector<Vector3> axis_;
  std::vector<std::vector<Part>> parts_;
};

}  // namespace focal
