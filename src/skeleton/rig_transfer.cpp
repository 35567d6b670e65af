#include "skeleton/rig_transfer.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "landmarks/exemplar_maps.h"
#include "mesh/section.h"
#include "mesh/similarity.h"
#include "skeleton/body_fit.h"
#include "skeleton/detail_rig.h"
#include "skeleton/mirrored_rig.h"
#include "skeleton/part_weights.h"
#include "skeleton/rig_landmarks.h"
#include "skeleton/taught_weights.h"
#include "skeleton/twist.h"
#include "skeleton/verdict.h"

namespace focal {
namespace {

// Chosen on left-out training characters; see docs/accuracy.md.
constexpr double alike_falloff = 30;    // weight of a shape: exp(-falloff (residual - least residual))
constexpr double place_outlier = 0.02;  // in sqrt(area): positions farther from the consensus count less
constexpr double ring_radius = 0.15;    // in sqrt(area): points farther from the joint have a small weight
constexpr double ring_softness = 0.05;  // weight of a joint's part outside its ring

// A similarity fitted to fewer points has a random rotation: the points around the joint are used instead.
constexpr double fewest_points = 5;
constexpr int few_points = 12;

// The rig that one training shape predicts for the new character, in the coordinates of the full surface.
struct Opinion {
  double weight = 0;
  std::vector<std::optional<Vector3>> place;
  std::vector<Matrix3> turn;  // of the joint, where it has a position
  std::vector<Vector3> tip;
};

std::vector<ShapeMap> maps_of(const Detection& detection, const Execution& execution) {
  const LandmarkModel& model = *detection.model;
  if (model.skeleton.empty())
    throw Error(Status::invalid_argument, "the model was not learned from rigged characters",
                "train one with --rigs, or focal_training_set_add_rig");
  const SurfaceAnalysis& analysis = analysis_of(detection);
  std::vector<ShapeMap> maps = detection.maps;
  if (maps.empty()) {
    const std::vector<int32_t> landmark = placed_landmarks(detection);
    if (landmark.size() < 3)
      throw Error(Status::invalid_argument, "fewer than three landmarks were found on the mesh",
                  "check that it belongs to the category that the model was trained on");
    const RowMatrixf fields = analysis.metric->distances(places_of(detection, landmark), execution);
    maps = map_shapes(model.exemplars, detection.exemplars, model.reach, analysis, landmark, fields,
                      {.map = {.first = 20, .last = 120, .step = 8}}, execution);
  }
  find_exact_images(maps, model.exemplars, analysis, execution);
  std::erase_if(maps, [&](const ShapeMap& one) { return !model.exemplars[one.shape].rig; });
  return maps;
}

// Number of points of equal weight that would share the weight in the same way.
double points_that_count(const Vector& weight) { return std::pow(weight.sum(), 2) / weight.squaredNorm(); }

// Weights of the points around a position.
Vector surroundings_of(const Vector3& place, const Exemplar& shape) {
  const Eigen::Index points = shape.positions.rows();
  const Vector away = (shape.positions.rowwise() - place.transpose()).rowwise().norm();
  std::vector<double> sorted(away.begin(), away.end());
  const auto nth = sorted.begin() + std::min<std::ptrdiff_t>(few_points, points - 1);
  std::nth_element(sorted.begin(), nth, sorted.end());
  const double radius = std::max(*nth, 1e-9);
  return (shape.samples.weight.head(points).cast<double>().array() *
          (-(away.array() / radius).square()).exp())
      .matrix();
}

Opinion opinion_of(const std::vector<SkeletonJoint>& skeleton, const Exemplar& shape,
                   const std::vector<int32_t>& image, const MatrixX3& vertices) {
  const Eigen::Index points = shape.positions.rows();
  MatrixX3 images(points, 3);
  for (Eigen::Index i = 0; i < points; ++i) images.row(i) = vertices.row(image[i]);
  const ShapeRig& rig = *shape.rig;
  const RowMatrixf below = weights_below(skeleton, rig.influences);
  const Vector area = shape.samples.weight.head(points).cast<double>();
  Opinion result;
  for (size_t j = 0; j < skeleton.size(); ++j) {
    result.place.emplace_back(), result.turn.push_back(Matrix3::Identity()), result.tip.push_back(rig.tip[j]);
    if (!rig.bind[j]) continue;
    Vector own = Vector::Zero(points), ring = Vector::Zero(points);
    for (Eigen::Index i = 0; i < points; ++i) {
      for (const Influence& one : rig.influences[i])
        if (one.joint == static_cast<int32_t>(j)) own[i] = one.weight * area[i];
      const double share = below(i, static_cast<Eigen::Index>(j));
      const double away = (shape.positions.row(i).transpose() - rig.bind[j]->topRightCorner<3, 1>()).norm();
      ring[i] = area[i] * 4 * share * (1 - share) * std::exp(-std::pow(away / ring_radius, 2));
    }
    if (ring.sum() < 1e-6) ring.setZero();
    Vector near = ring + ring_softness * own;
    if (!(near.sum() > 1e-9)) continue;
    if (!(own.sum() > 1e-9)) own = near;
    for (Vector* weight : {&near, &own})
      if (points_that_count(*weight) < fewest_points)
        *weight = surroundings_of(rig.bind[j]->topRightCorner<3, 1>(), shape);
    const Similarity round = fit_similarity(shape.positions, images, near);
    const Similarity part = fit_similarity(shape.positions, images, own);
    result.place.back() = round(rig.bind[j]->topRightCorner<3, 1>());
    result.turn.back() = part.rotation * rig.bind[j]->topLeftCorner<3, 3>();
    result.tip.back() = part(rig.tip[j]);
  }
  return result;
}

// A robust mean of positions: Cauchy weights around the current one. Returns the mean distance of the
// positions from it.
std::pair<Vector3, double> consensus(const std::vector<std::pair<Vector3, double>>& places) {
  constexpr int rounds = 10;
  Vector3 middle = Vector3::Zero();
  double total = 0;
  for (const auto& [p, w] : places) middle += w * p, total += w;
  middle /= total;
  double spread = 0;
  for (int round = 0; round < rounds; ++round) {
    Vector3 sum = Vector3::Zero();
    double all = 0, away = 0;
    for (const auto& [p, w] : places) {
      const double d = (p - middle).norm(), trusted = w / (1 + std::pow(d / place_outlier, 2));
      sum += trusted * p, all += trusted, away += trusted * d;
    }
    middle = sum / all, spread = away / all;
  }
  return {middle, spread};
}

// The consensus of the shapes on the joints. Their axes are those of the training characters, rotated with
// their parts of the surface, so that rotations of an animation have the same meaning.
struct Joints {
  std::vector<Vector3> place, tip;
  std::vector<Matrix3> turn;
  std::vector<double> confidence;
};

Joints agreed_joints(const std::vector<SkeletonJoint>& skeleton, const std::vector<Opinion>& opinions,
                     std::vector<std::string>& warnings) {
  Joints result;
  for (size_t j = 0; j < skeleton.size(); ++j) {
    std::vector<std::pair<Vector3, double>> places, tips;
    Matrix3 turn = Matrix3::Zero();
    for (const Opinion& one : opinions) {
      if (!one.place[j]) continue;
      places.emplace_back(*one.place[j], one.weight), tips.emplace_back(one.tip[j], one.weight);
      turn += one.weight * one.turn[j];
    }
    const int32_t p = skeleton[j].parent;
    if (places.empty()) {  // placed by its parent
      result.place.push_back(p >= 0 ? result.place[p] : Vector3::Zero());
      result.tip.push_back(result.place.back()),
          result.turn.push_back(p >= 0 ? result.turn[p] : Matrix3::Identity());
      result.confidence.push_back(0);
      warnings.push_back("joint '" + skeleton[j].name +
                         "' has no part of the surface to follow; it is placed at its parent");
      continue;
    }
    const auto [place, spread] = consensus(places);
    result.place.push_back(place), result.tip.push_back(consensus(tips).first);
    result.turn.push_back(nearest_rotation(turn));
    result.confidence.push_back(1 / (1 + std::pow(spread / place_outlier, 2)));
  }
  return result;
}

std::vector<int32_t> parents_of(const std::vector<SkeletonJoint>& skeleton) {
  std::vector<int32_t> result;
  for (const SkeletonJoint& joint : skeleton) result.push_back(joint.parent);
  return result;
}

// Disagreement of the shapes on a rotation about an axis, as the variance of their mean.
double variance_about(const Vector3& axis, const Matrix3& mean, const std::vector<Opinion>& opinions,
                      size_t joint) {
  double squares = 0, total = 0, total_squares = 0;
  for (const Opinion& one : opinions) {
    if (!one.place[joint]) continue;
    squares += one.weight * std::pow(twist_about(one.turn[joint] * mean.transpose(), axis), 2);
    total += one.weight, total_squares += one.weight * one.weight;
  }
  return total > 0 ? squares / total * (total_squares / (total * total)) : 1;
}

// The rig of the first training character; it exists, or there would be no maps.
const ShapeRig& first_rig(const LandmarkModel& model) {
  return *std::find_if(model.exemplars.begin(), model.exemplars.end(), [](const Exemplar& shape) {
            return shape.rig.has_value();
          })->rig;
}

void settle_twists(const LandmarkModel& model, const std::vector<Opinion>& opinions, Joints& joints) {
  const ShapeRig& first = first_rig(model);
  std::vector<Vector3> way = bone_directions(parents_of(model.skeleton), joints.place, joints.tip);
  for (Vector3& one : way) one = one.norm() > 1e-9 ? Vector3(one.normalized()) : Vector3::Zero();
  std::vector<TwistedJoint> turned;
  for (size_t j = 0; j < model.skeleton.size(); ++j) {
    const auto& bind = first.bind[j];
    turned.push_back({model.skeleton[j].parent, joints.turn[j],
                      bind ? Matrix3(bind->topLeftCorner<3, 3>()) : joints.turn[j], way[j],
                      variance_about(way[j], joints.turn[j], opinions, j)});
  }
  const std::vector<double> by = twist_corrections(turned);
  for (size_t j = 0; j < by.size(); ++j)
    if (!way[j].isZero())
      joints.turn[j] = Eigen::AngleAxisd(by[j], way[j]).toRotationMatrix() * joints.turn[j];
}

// Converts the caller's coordinates to those of the full surface.
FixedJoints on_full(const FixedJoints& fixed, const PreparedMesh& mesh) {
  FixedJoints result(fixed.size());
  for (size_t j = 0; j < fixed.size(); ++j)
    if (fixed[j]) result[j] = (*fixed[j] - mesh.centre) / mesh.scale;
  return result;
}

// Sets fixed joints, in the caller's coordinates, and moves those that follow them.
void hold_fixed(const std::vector<SkeletonJoint>& skeleton, const FixedJoints& fixed,
                const PreparedMesh& mesh, Joints& joints) {
  for (size_t j = 0; j < fixed.size(); ++j)
    if (fixed[j]) joints.confidence[j] = 1;
  follow(on_full(fixed, mesh), fixed_joint_reach,
         {parents_of(skeleton), joints.place, joints.tip, joints.turn});
}

// A joint that moves vertices belongs inside the body; controls may be anywhere.
void draw_inside(Joints& joints, const FixedJoints& fixed, const RowMatrixf& weights, TriangleMesh surface) {
  const RayCaster rays(std::move(surface));
  for (size_t j = 0; j < joints.place.size(); ++j)
    if ((fixed.empty() || !fixed[j]) && weights.col(static_cast<Eigen::Index>(j)).maxCoeff() > 0)
      joints.place[j] = drawn_inside(rays, joints.place[j]);
}

std::vector<Matrix4> rest_pose(const LandmarkModel& model, const std::vector<Joint>& joints) {
  std::vector<Matrix4> rest;
  const ShapeRig& first = first_rig(model);
  for (size_t j = 0; j < joints.size(); ++j) {
    rest.push_back(joints[j].bind);
    const int32_t p = joints[j].parent;
    if (p >= 0) rest[j] = rest[p] * joints[p].bind.inverse() * joints[j].bind;
    if (const auto& bind = first.bind[j]) rest[j].topLeftCorner<3, 3>() = bind->topLeftCorner<3, 3>();
  }
  return rest;
}

// A joint whose own landmarks are all absent is placed by the rest of the body. One sentence for all of them.
void warn_of_absent(const Detection& detection, std::vector<std::string>& warnings) {
  constexpr size_t most_named = 3;
  const std::vector<std::string> joints = guessed_joints(detection);
  if (joints.empty()) return;
  std::string names;
  for (size_t i = 0; i < std::min(joints.size(), most_named); ++i)
    names += (i ? ", '" : "'") + joints[i] + "'";
  if (joints.size() > most_named) names += ", ...";
  warnings.push_back(
      joints.size() == 1
          ? "joint " + names + ": none of its landmarks was found on this mesh, its place is a guess"
          : std::to_string(joints.size()) + " joints (" + names +
                "): none of their landmarks was found on this mesh, each of their places is a guess");
}

// Converts between the coordinates of the analysed surface and those of the full one.
struct ToFull {
  explicit ToFull(const Proxy& proxy) {
    if (!proxy.is_full()) scale = proxy.coarse->scale, offset = proxy.coarse->centre;
  }
  Vector3 operator()(const Vector3& p) const { return offset + scale * p; }
  Vector3 back(const Vector3& p) const { return (p - offset) / scale; }

  double scale = 1;
  Vector3 offset = Vector3::Zero();
};

PlacedSkeleton on_analysed(const std::vector<SkeletonJoint>& skeleton, const Joints& joints,
                           const ToFull& to_full) {
  PlacedSkeleton result{skeleton, joints.place, joints.tip, joints.turn};
  for (auto* places : {&result.place, &result.tip})
    for (Vector3& p : *places) p = to_full.back(p);
  return result;
}

// vertices: of the analysed surface, in the coordinates of the full one.
std::vector<Opinion> opinions_of(const std::vector<ShapeMap>& maps, const LandmarkModel& model,
                                 const MatrixX3& vertices, const Execution& execution) {
  float least = std::numeric_limits<float>::infinity();
  for (const ShapeMap& one : maps) least = std::min(least, one.map.residual);
  std::vector<Opinion> opinions(maps.size());
  parallel_for(execution, static_cast<int64_t>(maps.size()), [&](int64_t m) {
    opinions[m] = opinion_of(model.skeleton, model.exemplars[maps[m].shape], maps[m].map.image, vertices);
    opinions[m].weight = std::exp(-alike_falloff * (maps[m].map.residual - least));
  });
  return opinions;
}

// Known landmarks determine the heading.
bool may_reverse(const Detection& detection) {
  return detection.model->params.finds_heading && !detection.has_fixed;
}

// Adds the fits to the maps, whose weight depends on the fits.
void add_fits(const BodyFit& fit, const LandmarkModel& model, const ToFull& to_full,
              std::vector<Opinion>& opinions) {
  double sum = 0;
  for (const Opinion& one : opinions) sum += one.weight;
  for (Opinion& one : opinions) one.weight *= fit.start_share / sum;
  for (const FittedShape& shape : fit.shapes) {
    Opinion& one = opinions.emplace_back();
    one.weight = shape.share;
    for (size_t j = 0; j < shape.tip.size(); ++j) {
      const auto& bind = model.exemplars[shape.shape].rig->bind[j];
      one.place.emplace_back();
      if (bind) one.place.back() = to_full(shape.posture.place[j]);
      one.tip.push_back(to_full(shape.tip[j]));
      one.turn.push_back(bind ? Matrix3(shape.posture.turn[j] * bind->topLeftCorner<3, 3>())
                              : Matrix3(Matrix3::Identity()));
    }
  }
}

}  // namespace

CharacterRig transfer_rig(const Detection& detection, const Execution& execution, bool symmetric,
                          int32_t influences, const FixedJoints& fixed) {
  const LandmarkModel& model = *detection.model;
  execution.begin_stage("maps", 0, 0.3);
  const std::vector<ShapeMap> maps = maps_of(detection, execution);
  if (maps.empty())
    throw Error(Status::invalid_argument, "none of the model's shapes has a rig",
                "train with rigged characters");
  execution.begin_stage("joints", 0.3, 0.8);
  const SurfaceAnalysis& analysis = *detection.analysis;
  const ToFull to_full(analysis.proxy);
  const MatrixX3 vertices =
      (to_full.scale * analysis.surface().positions).rowwise() + to_full.offset.transpose();
  std::vector<Opinion> opinions = opinions_of(maps, model, vertices, execution);
  CharacterRig result;
  std::vector<std::string> of_maps;  // warnings that the fits may resolve
  const Joints mapped = agreed_joints(model.skeleton, opinions, of_maps);
  FixedJoints known = on_full(fixed, *detection.mesh);
  for (auto& one : known)
    if (one) one = to_full.back(*one);
  const BodyFit fit = fit_to_body(detection, maps, on_analysed(model.skeleton, mapped, to_full),
                                  may_reverse(detection), known, execution);
  add_fits(fit, model, to_full, opinions);
  result.surface_distance = fit.shapes[0].residual, result.heading_margin = fit.heading_margin;
  if (fit.is_reversed)
    result.warnings.push_back(
        "the skeleton faces the other way than the detected landmarks: a training character fits the mesh "
        "better that way");
  Joints joints = agreed_joints(model.skeleton, opinions, result.warnings);
  settle_twists(model, opinions, joints);
  hold_fixed(model.skeleton, fixed, *detection.mesh, joints);
  warn_of_absent(detection, result.warnings);
  execution.begin_stage("weights", 0.8, 1);
  const PlacedSkeleton placed = on_analysed(model.skeleton, joints, to_full);
  const std::vector<ShapeMap> fitted = maps_of_fits(fit, model, analysis, execution);
  std::vector<double> share;
  for (const FittedShape& one : fit.shapes) share.push_back(one.share);
  const SurfaceWeights weights = taught_weights({model, fitted, share}, analysis, placed, execution);
  draw_inside(joints, fixed, weights.weights, {vertices, analysis.surface().triangles});
  const PreparedMesh& full = *detection.mesh;
  const auto to_caller = [&](const Vector3& p) -> Vector3 { return full.centre + full.scale * p; };
  for (size_t j = 0; j < model.skeleton.size(); ++j) {
    Joint joint{model.skeleton[j].name, model.skeleton[j].parent};
    joint.bind.topLeftCorner<3, 3>() = joints.turn[j];
    joint.bind.topRightCorner<3, 1>() = to_caller(joints.place[j]);
    result.rig.joints.push_back(std::move(joint));
    result.tip.push_back(to_caller(joints.tip[j]));
  }
  result.confidence = joints.confidence;
  put_influences_by_parts(weights, placed, analysis, influences, result.rig, execution);
  refine_details(detection, influences, result, execution);
  if (symmetric) make_symmetric(full.source, fixed, result);
  follow(fixed, fixed_joint_reach * full.scale, result);  // changed by details and symmetry
  result.rest = rest_pose(model, result.rig.joints);
  if (symmetric) make_rest_symmetric(result);
  return result;
}

}  // namespace focal
