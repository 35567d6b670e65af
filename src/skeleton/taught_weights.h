// Skin weights on the analysed surface, from those of rigged training shapes posed to the detected joints.
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

// The training shapes in use: a map and a weight for each.
struct Teachers {
  const LandmarkModel& model;
  const std::vector<ShapeMap>& maps;
  const std::vector<double>& weight;
};

struct SurfaceWeights {
  RowMatrixf weights;  // vertices of the analysed surface x joints, each row of sum 1
  // Exponent that restores the sharpness of the training shapes' weights, which averaging reduces.
  float exponent = 1;
};

// Each vertex gets the mean over the shapes of the weights at the points nearest to it, both in the map's
// embedding and in space after the shape's joints are moved to the detected ones. Then weights of distant
// joints are removed: distant along the surface, in space, or never combined with the main joint on a
// training shape.
SurfaceWeights taught_weights(const Teachers& teachers, const SurfaceAnalysis& analysis,
                              const PlacedSkeleton& skeleton, const Execution& execution);

// Distance of positions from each joint's bones, which lead to its children or else to its tip.
RowMatrixf bone_distances(const PlacedSkeleton& skeleton, const MatrixX3& places);

// Raises weights to a power, scaled to sum 1; sufficiently hard ones go to one joint entirely.
void sharpen(Eigen::Ref<Eigen::RowVectorXf> weights, float exponent);

}  // namespace focal
