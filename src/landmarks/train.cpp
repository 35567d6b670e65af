#include "landmarks/train.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "analysis/surface_analysis.h"
#include "augmentation/corruption.h"
#include "base/error.h"
#include "base/random.h"
#include "descriptors/descriptor.h"
#include "landmarks/confidence.h"
#include "landmarks/exemplar_maps.h"
#include "landmarks/features.h"
#include "landmarks/orientation.h"
#include "landmarks/placement.h"
#include "model/landmark_model.h"
#include "paper/paper.h"

namespace focal {
namespace {

constexpr double disc_radius = 0.04;         // of sqrt(area), as in detection
constexpr int32_t folds = 3;                 // of the cross-fitted confidence
constexpr int32_t augmented_samples = 1500;  // of each corrupted copy; more of them do not help
// For all shapes and copies, so that models of many shapes stay small; fewer with an orientation, which makes
// features more informative.
constexpr double max_samples = 120000, max_oriented_samples = 40000;
constexpr int32_t max_calibration_shapes = 24;  // shapes left out in turn to learn confidence

// The training data of one shape.
struct LearnedShape {
  RowMatrixf targets;  // samples x landmarks: distance to the landmark, NaN where it is absent
  std::vector<std::optional<SurfacePoint>> points;  // the landmarks, on the analysed surface
  RowMatrixf fields;                                // distances of all vertices from the existing landmarks
  ConstellationSample constellation;
};

// A shape for training, or for calibrating the confidence.
struct TrainingExample {
  MarkedShape shape;
  SurfaceAnalysis analysis;
  LearnedShape learned;
  Matrix3 frame = Matrix3::Identity();  // its orientation, see features_of
};
// One training shape, uncorrupted and corrupted.
struct TrainingShape {
  TrainingExample whole;
  std::vector<TrainingExample> augmented;
};

void validate_method(const TrainParams& params) {
  const auto is_listed = [](int32_t number, const auto& kinds) {
    return number >= 0 && number < static_cast<int32_t>(kinds.size());
  };
  if (!is_listed(params.descriptor, descriptor_kinds()) || !is_listed(params.distance, distance_kinds()))
    throw Error(Status::invalid_argument, "there is no such descriptor or distance", "start from a preset");
  const DistanceKind& distance = distance_kinds()[params.distance];
  if (params.preset == Preset::default_preset && !distance.is_geodesic)
    throw Error(
        Status::unsupported,
        "preset default needs a geodesic distance: " + std::string(distance.name) + " is not geodesic",
        "choose a geodesic distance, or preset paper");
}

void validate(const TrainingSet& set, const TrainParams& params) {
  const auto L = set.landmark_names.size();
  if (L == 0)
    throw Error(Status::invalid_argument, "the training set has no landmark names",
                "name at least one landmark");
  if (params.tree_count < 1 || params.components_per_split < 1 || params.min_leaf_samples < 1 ||
      params.eigenpair_count < 8 || params.max_samples_per_shape < 1 || params.proxy_vertices < 0 ||
      params.augmented_copies < 0 || !(params.sampling_rate > 0 && params.sampling_rate <= 1))
    throw Error(Status::invalid_argument, "a training parameter is out of its range", "start from a preset");
  if (params.preset == Preset::paper && params.proxy_vertices != 0)
    throw Error(Status::invalid_argument, "preset paper analyses a surface as it is, without a proxy",
                "set proxy_vertices to 0");
  validate_method(params);
  if (set.shapes.size() < 2)
    throw Error(Status::too_few_shapes,
                "the training set has " + std::to_string(set.shapes.size()) + " mesh" +
                    (set.shapes.size() == 1 ? "" : "es"),
                "mark the landmarks on at least two meshes, better on ten");
  for (size_t l = 0; l < L; ++l) {
    const auto marked = std::count_if(set.shapes.begin(), set.shapes.end(),
                                      [&](const MarkedShape& shape) { return shape.marks[l].has_value(); });
    if (marked < 2)
      throw Error(Status::too_few_shapes,
                  "landmark '" + set.landmark_names[l] + "' is marked on " + std::to_string(marked) +
                      " mesh" + (marked == 1 ? "" : "es"),
                  "mark it on at least two meshes or leave it out");
  }
}

float at_point(const TriangleMesh& mesh, const SurfacePoint& point, const float* field) {
  double value = 0;
  for (int i = 0; i < 3; ++i) value += point.barycentric[i] * field[mesh.triangles(point.triangle, i)];
  return static_cast<float>(value);
}

LearnedShape learn_shape(const MarkedShape& shape, const SurfaceAnalysis& analysis,
                         const Execution& execution) {
  const auto L = static_cast<int32_t>(shape.marks.size());
  LearnedShape result;
  std::vector<SurfacePoint> points;
  std::vector<int32_t> landmark;
  for (int32_t l = 0; l < L; ++l) {
    result.constellation.present.push_back(shape.marks[l].has_value());
    if (shape.marks[l]) points.push_back(*shape.marks[l]), landmark.push_back(l);
  }
  points = to_coarse(analysis.proxy, points);
  result.points.resize(L);
  for (size_t p = 0; p < points.size(); ++p) result.points[landmark[p]] = points[p];
  result.fields = analysis.metric->distances(points, execution);
  const RowMatrixf& fields = result.fields;
  result.targets = RowMatrixf::Constant(analysis.samples.size(), L, NAN);
  auto& constellation = result.constellation;
  constellation.has_chirality = shape.mesh->is_oriented;
  constellation.distance = RowMatrixf::Zero(L, L);
  constellation.directions = {RowMatrixf::Zero(L, L), RowMatrixf::Zero(L, L)};
  const TangentDirections directions =
      tangent_directions(analysis.surface(), points, fields, disc_radius, execution);
  for (size_t a = 0; a < points.size(); ++a) {
    for (size_t s = 0; s < analysis.samples.size(); ++s)
      result.targets(s, landmark[a]) = fields(a, analysis.samples[s]);
    for (size_t b = 0; b < points.size(); ++b) {
      constellation.distance(landmark[a], landmark[b]) =
          at_point(analysis.surface(), points[b], &fields(a, 0));
      constellation.directions.x(landmark[a], landmark[b]) = directions.x(a, b);
      constellation.directions.y(landmark[a], landmark[b]) = directions.y(a, b);
    }
  }
  return result;
}

// Trains parts of a `default` model on the given shapes: forest, targets and reach on all their copies;
// constellation and exemplars on the uncorrupted ones, which represent the category.
void learn_parts(LandmarkModel& model, const std::vector<const TrainingShape*>& shapes,
                 const Execution& execution) {
  std::vector<const TrainingExample*> examples;
  std::vector<int32_t> shape_of;  // per example
  for (const auto* shape : shapes)
    shape_of.push_back(static_cast<int32_t>(examples.size())), examples.push_back(&shape->whole);
  for (size_t s = 0; s < shapes.size(); ++s)
    for (const auto& copy : shapes[s]->augmented)
      shape_of.push_back(static_cast<int32_t>(s)), examples.push_back(&copy);
  model.sample_shape.clear();
  for (size_t i = 0; i < examples.size(); ++i)
    model.sample_shape.insert(model.sample_shape.end(),
                              static_cast<size_t>(examples[i]->learned.targets.rows()), shape_of[i]);
  Eigen::Index rows = 0;
  for (const auto* example : examples) rows += example->learned.targets.rows();
  const auto L = static_cast<Eigen::Index>(model.landmark_names.size());
  RowMatrixf descriptors(rows, feature_count(model.params)), targets(rows, L);
  Eigen::Index row = 0;
  for (const auto* example : examples) {
    const auto& some = example->learned.targets;
    descriptors.middleRows(row, some.rows()) =
        features_of(example->analysis, static_cast<int32_t>(some.rows()), model.params, example->frame);
    targets.middleRows(row, some.rows()) = some;
    row += some.rows();
  }
  model.reach = 1.05f * targets.array().isNaN().select(0, targets).maxCoeff();
  model.targets.resize(rows, L);
  for (Eigen::Index l = 0; l < L; ++l) {
    double sum = 0, count = 0;
    for (Eigen::Index s = 0; s < rows; ++s)
      if (!std::isnan(targets(s, l))) sum += targets(s, l), ++count;
    for (Eigen::Index s = 0; s < rows; ++s) {
      const bool missing = std::isnan(targets(s, l));
      model.targets(s, l) =
          missing ? target_missing
                  : static_cast<uint16_t>(std::lround(targets(s, l) / model.reach * target_steps));
      if (missing)
        targets(s, l) = static_cast<float>(sum / count);  // does not affect the splits of the trees
    }
  }
  std::vector<ConstellationSample> constellations;
  for (const auto* shape : shapes) constellations.push_back(shape->whole.learned.constellation);
  model.constellation = learn_constellation(constellations, static_cast<int32_t>(L));
  model.exemplars.resize(shapes.size());
  parallel_for(execution, static_cast<int64_t>(shapes.size()), [&](int64_t s) {
    const TrainingExample& whole = shapes[s]->whole;
    model.exemplars[s] = remember_shape(whole.analysis, whole.learned.points, whole.learned.fields,
                                        model.reach, whole.shape.rig);
    model.exemplars[s].constellation = whole.learned.constellation;
  });
  const ForestParams forest{.tree_count = model.params.tree_count,
                            .min_leaf_samples = model.params.min_leaf_samples,
                            .min_split_samples = 2 * model.params.min_leaf_samples,
                            .components_per_split = model.params.components_per_split,
                            .seed = model.params.seed};
  if (model.params.oriented && model.params.finds_heading) {
    std::vector<const SurfaceAnalysis*> meshes;
    for (const TrainingExample* example : examples) meshes.push_back(&example->analysis);
    learn_orientation(model, meshes, execution);
  }
  model.forests.assign(1, grow_forest(bin_descriptors(descriptors, execution), targets, forest, execution));
}

// The placements of one shape by a model that was not trained on it, each with its error. id: unique for each
// mesh.
void place_left_out(const LandmarkModel& model, const TrainingExample& example, int32_t id, bool is_whole,
                    std::vector<CalibrationSample>& samples, const Execution& execution) {
  const auto& [shape, analysis, learned, frame] = example;
  const DetectParams detect;
  StageSeconds ignored;
  const auto limit =
      static_cast<int32_t>(sampling_rate_of(detect, model.params) * analysis.surface().vertex_count());
  const Placement placement = place_landmarks(model, analysis, std::clamp(limit, 100, detect.max_samples),
                                              detect, execution, ignored, frame);
  for (size_t l = 0; l < shape.marks.size(); ++l) {
    if (placement.vertex[l] < 0) continue;
    CalibrationSample one{
        static_cast<int32_t>(l), id,      placement.features[l], 1, shape.marks[l].has_value(),
        placement.map_residual,  is_whole};
    if (const auto& truth = learned.points[l])
      one.error =
          (position_of(analysis.surface(), placement.point[l]) - position_of(analysis.surface(), *truth))
              .norm();
    samples.push_back(one);
  }
}

// The shape with the defects of a scan (copy 0) or with a part missing, so that models learn how such meshes
// look.
std::optional<MarkedShape> augmented(const MarkedShape& shape, int32_t copy, Random random,
                                     const Execution& execution) {
  constexpr int32_t smallest = 100;  // minimum number of vertices that must remain
  CorruptedMesh corrupted = intact(shape.mesh->surface, shape.marks);
  if (copy > 0) {
    std::vector<SurfacePoint> marks;
    for (const auto& mark : shape.marks)
      if (mark) marks.push_back(*mark);
    if (marks.empty()) return std::nullopt;
    const SurfacePoint& centre = marks[random.below(static_cast<uint32_t>(marks.size()))];
    corrupted = cut_ball(std::move(corrupted), centre, 0.15 + 0.25 * random.uniform(),
                         copy == 1 ? CutEnd::open : CutEnd::capped, execution);
  } else {
    corrupted = with_holes(with_noise(std::move(corrupted), 0.3 * random.uniform(), random), 20, 2, random);
  }
  execution.check_cancelled();
  if (corrupted.mesh.vertex_count() < smallest ||
      corrupted.mesh.triangle_count() < shape.mesh->surface.triangle_count() / 3)
    return std::nullopt;
  // Analysed like the original shape: a fragment left by a hole must not make it a body of several parts.
  const auto analysed = shape.mesh->is_wrapped ? AnalysedSurface::wrapped : AnalysedSurface::as_it_is;
  MarkedShape result{
      std::make_shared<PreparedMesh>(prepare(std::move(corrupted.mesh), {.analysed = analysed}, execution)),
      {}};
  for (const auto& mark : corrupted.marks) {
    result.marks.emplace_back();
    if (!mark) continue;
    if (const SurfacePoint point = to_surface(*result.mesh, *mark); point.triangle >= 0)
      result.marks.back() = point;
  }
  return result;
}

// Places the landmarks of every shape, uncorrupted and corrupted, by a model that was not trained on it, and
// learns the confidence from the results.
Calibration cross_fit(const LandmarkModel& model, const std::vector<TrainingShape>& shapes,
                      const Execution& execution) {
  const auto count = static_cast<int32_t>(shapes.size());
  const int32_t used_folds = std::min(folds, count);
  std::vector<CalibrationSample> samples;
  Random random(model.params.seed, 77);
  const auto order = sample_without_replacement(random, count, count);
  for (int32_t fold = 0; fold < used_folds; ++fold) {
    execution.begin_stage("confidence", 0.6 + 0.4 * fold / used_folds, 0.6 + 0.4 * (fold + 1) / used_folds);
    LandmarkModel part;
    part.landmark_names = model.landmark_names;
    part.params = model.params;
    std::vector<const TrainingShape*> kept;
    for (int32_t i = 0; i < count; ++i)
      if (i % used_folds != fold) kept.push_back(&shapes[order[i]]);
    learn_parts(part, kept, execution);
    for (int32_t i = fold; i < std::min(count, max_calibration_shapes); i += used_folds) {
      const TrainingShape& left_out = shapes[order[i]];
      int32_t id = (model.params.augmented_copies + 1) * order[i];
      place_left_out(part, left_out.whole, id, true, samples, execution);
      for (const TrainingExample& copy : left_out.augmented)
        place_left_out(part, copy, ++id, false, samples, execution);
      execution.report(static_cast<double>(i + 1) / count);
    }
  }
  return calibrate(samples, static_cast<int32_t>(model.landmark_names.size()));
}

// Random orientation of users' files relative to the training shapes: nearly the same.
Matrix3 random_frame(Random random) {
  constexpr double heading = 0.25, tilt = 0.12;  // standard deviations, radians
  const double angle = heading * random.normal();
  const Vector3 axis(tilt * random.normal(), 0, tilt * random.normal());
  return (Eigen::AngleAxisd(axis.norm(), axis.norm() > 0 ? Vector3(axis.normalized()) : Vector3::UnitX()) *
          Eigen::AngleAxisd(angle, Vector3::UnitY()))
      .toRotationMatrix();
}

TrainingExample make_example(MarkedShape shape, const AnalysisParams& how, const Execution& execution) {
  TrainingExample example{std::move(shape), {}, {}};
  example.analysis = analyse_surface(example.shape.mesh, how, execution);
  return example;
}

std::vector<TrainingShape> make_examples(const TrainingSet& set, const TrainParams& params,
                                         const Execution& execution) {
  const bool paper = params.preset == Preset::paper;
  const int32_t copies = paper ? 1 : 1 + params.augmented_copies;
  const auto share =
      static_cast<int32_t>((params.oriented ? max_oriented_samples : max_samples) /
                           (set.shapes.size() * (paper ? 1.0 : 1 + 0.4 * params.augmented_copies)));
  std::vector<TrainingShape> shapes(set.shapes.size());
  std::vector<std::optional<TrainingExample>> augmented_examples(set.shapes.size() * copies);
  execution.begin_stage("analysis", 0, 0.3);
  std::atomic<int32_t> done{0};
  parallel_for(execution, static_cast<int64_t>(augmented_examples.size()), [&](int64_t i) {
    const int64_t s = i / copies;
    const auto copy = static_cast<int32_t>(i % copies);
    AnalysisParams how = analysis_params_of(params);
    how.sampling_rate = params.sampling_rate, how.max_samples = params.max_samples_per_shape;
    if (!paper) how.max_samples = std::min(how.max_samples, share);
    how.seed = params.seed, how.stream = static_cast<uint64_t>(s);
    if (copy == 0) {
      shapes[s].whole = make_example(set.shapes[s], how, execution.inner());
    } else if (auto bad = augmented(set.shapes[s], static_cast<int32_t>((copy - 1 + s) % 3),
                                    Random(params.seed, 5000 + i), execution.inner())) {
      how.max_samples = std::min({how.max_samples, augmented_samples, 2 * share / 5});
      augmented_examples[i] = make_example(*std::move(bad), how, execution.inner());
      augmented_examples[i]->frame = random_frame(Random(params.seed, 15000 + i));
    }
    if (copy == 0 && set.shapes[s].is_copy)
      shapes[s].whole.frame = random_frame(Random(params.seed, 15000 + i));
    execution.report(static_cast<double>(++done) / static_cast<double>(augmented_examples.size()));
  });
  for (size_t i = 0; i < augmented_examples.size(); ++i)
    if (augmented_examples[i]) shapes[i / copies].augmented.push_back(*std::move(augmented_examples[i]));
  return shapes;
}

}  // namespace

LandmarkModel train(const TrainingSet& set, const TrainParams& params, const Execution& execution) {
  validate(set, params);
  LandmarkModel model;
  model.landmark_names = set.landmark_names;
  model.params = params;
  model.skeleton = set.skeleton;
  model.skeleton_template = set.skeleton_template;
  // Shapes of rigged characters already include other poses and proportions: copies of copies add little.
  if (!set.skeleton.empty()) model.params.augmented_copies = std::min(params.augmented_copies, 1);
  model.params.oriented = params.oriented && !set.skeleton.empty();
  model.shape_count = static_cast<int32_t>(set.shapes.size());
  int64_t vertices = 0;
  for (const auto& shape : set.shapes) vertices += shape.mesh->surface.vertex_count();
  model.mean_vertex_count = static_cast<int32_t>(vertices / model.shape_count);
  std::vector<TrainingShape> shapes = make_examples(set, model.params, execution);
  model.calibration.typical_vote.assign(set.landmark_names.size(), 0);
  if (params.preset == Preset::paper) {
    std::vector<SurfaceAnalysis> analyses;
    for (auto& shape : shapes) analyses.push_back(std::move(shape.whole.analysis));
    train_paper_forests(model, set, analyses, execution);
    return model;
  }
  execution.begin_stage("distances", 0.3, 0.35);
  for (auto& shape : shapes) {
    shape.whole.learned = learn_shape(shape.whole.shape, shape.whole.analysis, execution);
    for (auto& copy : shape.augmented) copy.learned = learn_shape(copy.shape, copy.analysis, execution);
  }
  execution.begin_stage("forest", 0.35, 0.6);
  std::vector<const TrainingShape*> all;
  for (const auto& shape : shapes) all.push_back(&shape);
  learn_parts(model, all, execution);
  if (params.learns_confidence) model.calibration = cross_fit(model, shapes, execution);
  return model;
}

ModelInfo info_of(const LandmarkModel& model) {
  ModelInfo info{model.landmark_names,
                 model.params,
                 model.shape_count,
                 model.mean_vertex_count,
                 model.targets.rows(),
                 0,
                 {}};
  for (const SkeletonJoint& joint : model.skeleton) info.joint_names.push_back(joint.name);
  for (const auto& forest : model.forests)
    for (const auto& tree : forest.trees) info.tree_node_count += static_cast<int64_t>(tree.feature.size());
  return info;
}

}  // namespace focal
