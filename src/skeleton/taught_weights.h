// Skin weights on the analysed surface, from those of rigged training shapes that are posed onto the joints found.
#pragma once
#include <vector>

#include "landmarks/exemplar_maps.h"
#include "model/model_info.h"

namespace focal {

// In the coordinates of the analysed surface.
struct PlacedSkeleton {
  const std::vector<SkeletonJoint>& joints;
  std::vector<Vector3> place, tip;
  std::vector<Matrix3> turn;
};

// The training shapes in use: a map of each, and how much its word counts.
struct Teachers {
  const LandmarkModel& model;
  const std::vector<ShapeMap>& maps;
  const std::vector<double>& weight;
};

struct SurfaceWeights {
  RowMatrixf weights;  // vertices of the analysed surface x joints, each row of sum 1
  // What sharpens them to what the training shapes have, which means of several blur: weights become their powers.
  float exponent = 1;
};

// Each vertex takes the mean over the shapes of the weights at the points that lie nearest, both along the map and in space
// once the shape's joints are moved to those found. Then a vertex loses what comes from joints far from it: along the
// surface, in space, or that no training shape has together with its main joint.
SurfaceWeights taught_weights(const Teachers& teachers, const SurfaceAnalysis& analysis,
                              const PlacedSkeleton& skeleton, const Execution& execution);

// How far places lie from each joint's bones, which lead to its children or else to its tip.
RowMatrixf bone_distances(const PlacedSkeleton& skeleton, const MatrixX3& places);

// Weights as powers of themselves, scaled to sum 1; hard enough ones go to one joint altogether.
void sharpen(Eigen::Ref<Eigen::RowVectorXf> weights, float exponent);

}  // namespace focal
