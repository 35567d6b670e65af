#include "landmarks/train.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "base/error.h"
#include "base/random.h"
#include "landmarks/atlas.h"
#include "landmarks/confidence.h"
#include "landmarks/model_parts.h"
#include "landmarks/paper.h"
#include "landmarks/placement.h"
#include "landmarks/surface_analysis.h"
#include "mesh/damage.h"

namespace focal {
namespace {

constexpr double disc_radius = 0.04;  // of sqrt(area), as in detection
constexpr int32_t folds = 3;          // of the cross-fitted confidence

// What the training keeps of one shape.
struct LearnedShape {
  RowMatrixf targets;  // samples x landmarks: distance to the mark, NaN where there is none
  std::vector<std::optional<SurfacePoint>> points;  // the marks, on the analysed surface
  RowMatrixf fields;                                // distances of all vertices from those that are there
  ConstellationSample constellation;
};

void validate(const TrainingSet& set, const TrainParams& params) {
  const auto L = set.landmark_names.size();
  if (L == 0)
    throw Error(Status::invalid_argument, "the training set has no landmark names",
                "name at least one landmark");
  if (params.tree_count < 1 || params.components_per_split < 1 || params.min_leaf_samples < 1 ||
      params.eigenpair_count < 8 || params.max_samples_per_shape < 1 || params.proxy_vertices < 0 ||
      !(params.sampling_rate > 0 && params.sampling_rate <= 1))
    throw Error(Status::invalid_argument, "a training parameter is out of its range", "start from a preset");
  if (params.preset == Preset::paper && params.proxy_vertices != 0)
    throw Error(Status::invalid_argument, "preset paper analyses a surface as it is, without a proxy",
                "set proxy_vertices to 0");
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
  result.fields = analysis.heat.distances(points, execution);
  const RowMatrixf& fields = result.fields;
  result.targets = RowMatrixf::Constant(analysis.samples.size(), L, NAN);
  auto& constellation = result.constellation;
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

// Fills the parts of a `default` model that the given shapes teach: forest, targets, reach, constellation.
void learn_parts(LandmarkModel& model, const std::vector<const SurfaceAnalysis*>& analyses,
                 const std::vector<const LearnedShape*>& learned, const Execution& execution) {
  Eigen::Index rows = 0;
  for (const auto* shape : learned) rows += shape->targets.rows();
  const auto L = static_cast<Eigen::Index>(model.landmark_names.size());
  RowMatrixf descriptors(rows, analyses[0]->descriptors.cols()), targets(rows, L);
  std::vector<ConstellationSample> constellations;
  Eigen::Index row = 0;
  for (size_t s = 0; s < learned.size(); ++s) {
    descriptors.middleRows(row, learned[s]->targets.rows()) = analyses[s]->descriptors;
    targets.middleRows(row, learned[s]->targets.rows()) = learned[s]->targets;
    row += learned[s]->targets.rows();
    constellations.push_back(learned[s]->constellation);
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
      if (missing) targets(s, l) = static_cast<float>(sum / count);  // has no say in where the trees split
    }
  }
  model.constellation = learn_constellation(constellations, static_cast<int32_t>(L));
  model.atlas.resize(learned.size());
  parallel_for(execution, static_cast<int64_t>(learned.size()), [&](int64_t s) {
    model.atlas[s] = remember_shape(*analyses[s], learned[s]->points, learned[s]->fields, model.reach);
  });
  const ForestParams forest{.tree_count = model.params.tree_count,
                            .min_leaf_samples = model.params.min_leaf_samples,
                            .min_split_samples = 2 * model.params.min_leaf_samples,
                            .components_per_split = model.params.components_per_split,
                            .seed = model.params.seed};
  model.forests.assign(1, grow_forest(bin_descriptors(descriptors, execution), targets, forest, execution));
}

// The placements of one shape by a model that has not seen it, each with its error. id: another one for each mesh.
void judge_shape(const LandmarkModel& model, const MarkedShape& shape, const SurfaceAnalysis& analysis,
                 int32_t id, bool is_whole, std::vector<JudgedPlacement>& judged,
                 const Execution& execution) {
  const DetectParams detect;
  StageSeconds ignored;
  const auto limit =
      static_cast<int32_t>(sampling_rate_of(detect, model.params) * analysis.surface().vertex_count());
  const Placement placement = place_landmarks(model, analysis, std::clamp(limit, 100, detect.max_samples),
                                              detect, execution, ignored);
  for (size_t l = 0; l < shape.marks.size(); ++l) {
    if (placement.vertex[l] < 0) continue;
    JudgedPlacement one{
        static_cast<int32_t>(l), id,      placement.evidence[l], 1, shape.marks[l].has_value(),
        placement.map_residual,  is_whole};
    if (shape.marks[l]) {
      const SurfacePoint truth = to_coarse(analysis.proxy, std::span(&*shape.marks[l], 1))[0];
      one.error =
          (position_of(analysis.surface(), placement.point[l]) - position_of(analysis.surface(), truth))
              .norm();
    }
    judged.push_back(one);
  }
}

// The same shape as a scanner spoils it, or with a part missing: what such meshes look like has to be learned too.
std::optional<MarkedShape> spoiled(const MarkedShape& shape, bool cut, Random random) {
  constexpr int32_t smallest = 100;  // vertices that make a shape still, when some have gone
  DamagedMesh damaged = undamaged(shape.mesh->surface, shape.marks);
  if (cut) {
    std::vector<SurfacePoint> marks;
    for (const auto& mark : shape.marks)
      if (mark) marks.push_back(*mark);
    if (marks.empty()) return std::nullopt;
    const SurfacePoint& centre = marks[random.below(static_cast<uint32_t>(marks.size()))];
    damaged = cut_ball(std::move(damaged), centre, 0.15 + 0.25 * random.uniform(), CutEnd::open);
  } else {
    damaged = with_holes(with_noise(std::move(damaged), 0.3 * random.uniform(), random), 20, 2, random);
  }
  if (damaged.mesh.vertex_count() < smallest ||
      damaged.mesh.triangle_count() < shape.mesh->surface.triangle_count() / 3)
    return std::nullopt;
  MarkedShape result{std::make_shared<PreparedMesh>(prepare(std::move(damaged.mesh))), {}};
  for (const auto& mark : damaged.marks) {
    result.marks.emplace_back();
    if (!mark) continue;
    if (const SurfacePoint point = to_surface(*result.mesh, *mark); point.triangle >= 0)
      result.marks.back() = point;
  }
  return result;
}

// Places the landmarks of every shape, whole and spoiled, by a model that has not seen it, and learns from the outcome
// how far to trust.
Calibration cross_fit(const LandmarkModel& model, const TrainingSet& set,
                      const std::vector<SurfaceAnalysis>& analyses, const std::vector<LearnedShape>& learned,
                      const Execution& execution) {
  const auto count = static_cast<int32_t>(set.shapes.size());
  const int32_t used_folds = std::min(folds, count);
  std::vector<JudgedPlacement> judged;
  Random random(model.params.seed, 77);
  const auto order = sample_without_replacement(random, count, count);
  for (int32_t fold = 0; fold < used_folds; ++fold) {
    execution.begin_stage("confidence", 0.5 + 0.5 * fold / used_folds, 0.5 + 0.5 * (fold + 1) / used_folds);
    LandmarkModel part;
    part.landmark_names = model.landmark_names;
    part.params = model.params;
    std::vector<const SurfaceAnalysis*> kept;
    std::vector<const LearnedShape*> lessons;
    for (int32_t i = 0; i < count; ++i)
      if (i % used_folds != fold) kept.push_back(&analyses[order[i]]), lessons.push_back(&learned[order[i]]);
    learn_parts(part, kept, lessons, execution);
    for (int32_t i = fold; i < count; i += used_folds) {
      const MarkedShape& shape = set.shapes[order[i]];
      judge_shape(part, shape, analyses[order[i]], 3 * order[i], true, judged, execution);
      for (int32_t kind = 1; kind <= 2; ++kind) {
        const auto bad = spoiled(shape, kind == 2, Random(model.params.seed, 5000 + 3 * order[i] + kind));
        if (!bad) continue;
        judge_shape(part, *bad, analyse_for(model.params, bad->mesh, DetectParams{}, execution),
                    3 * order[i] + kind, false, judged, execution);
      }
      execution.report(static_cast<double>(i + 1) / count);
    }
  }
  return calibrate(judged, static_cast<int32_t>(model.landmark_names.size()));
}

std::vector<SurfaceAnalysis> analyse_all(const TrainingSet& set, const TrainParams& params,
                                         const Execution& execution) {
  std::vector<SurfaceAnalysis> analyses(set.shapes.size());
  execution.begin_stage("analysis", 0, 0.2);
  std::atomic<int32_t> done{0};
  parallel_for(execution, static_cast<int64_t>(set.shapes.size()), [&](int64_t s) {
    AnalysisParams how = analysis_params_of(params);
    how.sampling_rate = params.sampling_rate, how.max_samples = params.max_samples_per_shape;
    how.seed = params.seed, how.stream = static_cast<uint64_t>(s);
    analyses[s] = analyse_surface(set.shapes[s].mesh, how, execution.inner());
    execution.report(static_cast<double>(++done) / static_cast<double>(analyses.size()));
  });
  return analyses;
}

template <class T>
std::vector<const T*> pointers(const std::vector<T>& values) {
  std::vector<const T*> result;
  for (const T& value : values) result.push_back(&value);
  return result;
}

}  // namespace

LandmarkModel train(const TrainingSet& set, const TrainParams& params, const Execution& execution) {
  validate(set, params);
  LandmarkModel model;
  model.landmark_names = set.landmark_names;
  model.params = params;
  model.shape_count = static_cast<int32_t>(set.shapes.size());
  int64_t vertices = 0;
  for (const auto& shape : set.shapes) vertices += shape.mesh->surface.vertex_count();
  model.mean_vertex_count = static_cast<int32_t>(vertices / model.shape_count);
  const std::vector<SurfaceAnalysis> analyses = analyse_all(set, params, execution);
  model.calibration.typical_vote.assign(set.landmark_names.size(), 0);
  if (params.preset == Preset::paper) {
    train_paper_forests(model, set, analyses, execution);
    return model;
  }
  execution.begin_stage("distances", 0.2, 0.25);
  std::vector<LearnedShape> learned;
  for (size_t s = 0; s < set.shapes.size(); ++s)
    learned.push_back(learn_shape(set.shapes[s], analyses[s], execution));
  execution.begin_stage("forest", 0.25, 0.5);
  learn_parts(model, pointers(analyses), pointers(learned), execution);
  model.calibration = cross_fit(model, set, analyses, learned, execution);
  return model;
}

ModelInfo info_of(const LandmarkModel& model) {
  ModelInfo info{model.landmark_names,    model.params,         model.shape_count,
                 model.mean_vertex_count, model.targets.rows(), 0};
  for (const auto& forest : model.forests)
    for (const auto& tree : forest.trees) info.tree_node_count += static_cast<int64_t>(tree.feature.size());
  return info;
}

}  // namespace focal
