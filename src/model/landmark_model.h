// The contents of a model. See landmark_model.h for what a caller needs to know of it.
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

// Turns how well a landmark fits into a probability; learned on shapes left out of the forest that judged them.
struct Calibration {
  static constexpr int32_t feature_count = 9;  // see landmarks/confidence.h
  std::vector<float> typical_vote;       // per landmark: vote a sample at the true place, 0 when unknown
  float weight[feature_count + 1] = {};  // logistic regression: it lies where it should; the last is the bias
  float absent_weight[feature_count + 1] = {};  // likewise: it is not on this mesh at all
  float typical_length[2] = {};  // mean features of spread and gap: they stand in where no map was made
  float typical_residual = 0;    // of the maps from the training shapes; 0: no maps
  float near_error = 0.02f, far_error = 0.5f;  // mean error when right and when wrong, of sqrt(area)
  float fit_centre = 0, fit_scale = 1;         // category fit: logistic of a mesh's mean evidence
};

// One training shape as functional maps need it; see landmarks/exemplar_maps.h.
inline constexpr int32_t eigenfunction_zero = 32768;  // what stands for 0 among 16-bit eigenfunctions
struct Exemplar {
  SpectralSamples samples;   // points spread over it, then its marks, which weigh nothing
  float step = 1;            // the eigenfunctions are whole multiples of it, fewer than 32768
  TargetMatrix distances;    // points x landmarks, from the marks, as targets are kept
  std::vector<char> marked;  // per landmark
  // Of a rigged shape: where the points lie, in the coordinates of its surface, and its rig with one entry of influences a point.
  MatrixX3 positions;
  std::optional<ShapeRig> rig;
  RowMatrixf bulge;                   // points x radii, see descriptors/bulge.h; empty in old models
  ConstellationSample constellation;  // of its marks; nothing in old models
};

// A part of the body with many short bones (a hand) that is analysed once more by itself; see skeleton/detail_region.h.
struct DetailModel {
  int32_t joint = 0;            // of the skeleton: the part's root
  std::vector<int32_t> joints;  // per joint of the part's own skeleton: its number in the whole one
  std::vector<Vector3>
      reference;     // likewise: where it lies in the part's frame, in the mean of the training shapes
  double start = 0;  // the part is cut off at this height of its frame
  std::shared_ptr<const LandmarkModel> model;
};

struct LandmarkModel : std::enable_shared_from_this<LandmarkModel> {
  std::vector<std::string> landmark_names;
  TrainParams params;
  int32_t shape_count = 0;
  int32_t mean_vertex_count = 0;
  // default: one forest for all landmarks, its leaves keep samples (rows of targets).
  // paper: one forest a landmark, its leaves keep means; targets is empty.
  std::vector<RegressionForest> forests;
  TargetMatrix targets;  // samples x landmarks
  float reach = 0;       // largest target, of sqrt(area)
  std::vector<int32_t>
      sample_shape;  // per row of targets: the shape of the exemplars that it is of, or a copy of; empty in old models
  // Of models that learned an orientation, see landmarks/orientation.h: from what no motion changes to where a point lies and faces,
  // and the same from what no turn about the up axis changes.
  RegressionForest rising, facing;
  RowMatrixf facing_targets;  // samples of their leaves x (position, normal)
  std::vector<Exemplar> exemplars;
  ConstellationStatistics constellation;
  Calibration calibration;
  std::vector<SkeletonJoint> skeleton;  // of the rigged training shapes; empty without any
  std::string skeleton_template;        // of marked ones: a skeleton over the landmarks, as JSON; empty: none
  std::vector<DetailModel>
      details;  // parts of it with many short bones; of models that are not such a part themselves
};

}  // namespace focal
