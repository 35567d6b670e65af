// The contents of a model. See model_info.h for the part that callers need.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "constellation/constellation.h"
#include "forest/regression_forest.h"
#include "model/model_info.h"
#include "model/training_set.h"
#include "spectrum/functional_map.h"

namespace focal {

using TargetMatrix = Eigen::Matrix<uint16_t, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
inline constexpr uint16_t target_missing = 65535;  // the landmark is absent on the sample's shape
inline constexpr uint16_t target_steps = 65534;    // target / target_steps * reach = distance

// Converts the features of a placed landmark into a probability; learned on shapes that the judging forest
// was not trained on.
struct Calibration {
  static constexpr int32_t feature_count = 9;  // see landmarks/confidence.h
  std::vector<float> typical_vote;       // per landmark: vote per sample at the true place, 0 when unknown
  float weight[feature_count + 1] = {};  // logistic regression for "correctly placed"; the last is the bias
  float absent_weight[feature_count + 1] = {};  // the same for "absent on this mesh"
  float typical_length[2] = {};                // mean spread and gap features, used where no map was computed
  float typical_residual = 0;                  // of the maps from the training shapes; 0: no maps
  float near_error = 0.02f, far_error = 0.5f;  // mean error when correct and when wrong, in sqrt(area)
  float fit_centre = 0, fit_scale = 1;         // category fit: logistic of a mesh's mean evidence
};

// One training shape as stored for functional maps; see landmarks/exemplar_maps.h.
inline constexpr int32_t eigenfunction_zero = 32768;  // represents 0 among the 16-bit eigenfunctions
struct Exemplar {
  SpectralSamples samples;   // points spread over the shape, then its landmarks with weight 0
  float step = 1;            // the eigenfunctions are integer multiples of it, below 32768
  TargetMatrix distances;    // points x landmarks, from the landmarks, encoded like targets
  std::vector<char> marked;  // per landmark
  // Of a rigged shape: positions of the points in the coordinates of its surface, and its rig with one entry
  // of influences per point.
  MatrixX3 positions;
  std::optional<ShapeRig> rig;
  RowMatrixf bulge;                   // points x radii, see descriptors/bulge.h; empty in old models
  ConstellationSample constellation;  // of its landmarks; empty in old models
};

// A body part with many short bones (a hand) that gets a second analysis of its own; see
// skeleton/detail_region.h.
struct DetailModel {
  int32_t joint = 0;            // of the skeleton: the part's root
  std::vector<int32_t> joints;  // per joint of the part's own skeleton: its number in the whole skeleton
  // Per joint as well: its position in the part's frame, averaged over the training shapes.
  std::vector<Vector3> reference;
  double start = 0;  // the part is cut off at this coordinate along the axis of its frame
  std::shared_ptr<const LandmarkModel> model;
};

struct LandmarkModel : std::enable_shared_from_this<LandmarkModel> {
  std::vector<std::string> landmark_names;
  TrainParams params;
  int32_t shape_count = 0;
  int32_t mean_vertex_count = 0;
  // default: one forest for all landmarks whose leaves store samples (rows of targets).
  // paper: one forest per landmark whose leaves store means; targets is empty.
  std::vector<RegressionForest> forests;
  TargetMatrix targets;  // samples x landmarks
  float reach = 0;       // largest target, in sqrt(area)
  // Per row of targets: the exemplar's shape that the sample is from, or a copy of; empty in old models.
  std::vector<int32_t> sample_shape;
  // Of models with a learned orientation, see landmarks/orientation.h: predicts position and normal of a
  // point from the features that no motion changes, and from those that no rotation about the up axis
  // changes.
  RegressionForest rising, facing;
  RowMatrixf facing_targets;  // samples of their leaves x (position, normal)
  std::vector<Exemplar> exemplars;
  ConstellationStatistics constellation;
  Calibration calibration;
  std::vector<SkeletonJoint> skeleton;  // of rigged training shapes; empty without any
  std::string skeleton_template;        // of marked shapes: template over the landmarks, as JSON; empty: none
  // Body parts with many short bones; empty in the models of such parts.
  std::vector<DetailModel> details;
};

}  // namespace focal
