#include "skeleton/body_fit.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "landmarks/shape_starts.h"
#include "skeleton/character_rig.h"

namespace focal {
namespace {

// Chosen on left-out characters of game packs and of the generator.
constexpr size_t max_from_maps = 6, max_reversed = 4, max_laid_over = 8, max_kept_over = 4;  // fits
constexpr double sure_bulge = 0.25;     // maps with at least this bulge agreement have the correct heading
constexpr double sure_residual = 0.07;  // if a fit from them ends this near to the body
// Weight of the detection's advantage in energy relative to the logarithm of the residuals' ratio: the forest
// knows front and back of every part, a fit only the outline.
constexpr double advantage_weight = 1.0 / 600;
constexpr double sure_advantage = 30;    // smaller advantages are checked by fits
constexpr double residual_falloff = 30;  // weight of a fit: exp(-falloff (residual / least residual - 1))
constexpr double agreement = 0.05;       // in sqrt(area): fits with more distant joints get a small weight
constexpr double start_weight = 0.7;     // of the maps' joints relative to all fits
constexpr FitRounds from_maps{.coarse = 10, .fine = 5, .map_weight = 0.3};
constexpr FitRounds from_posture{.coarse = 10, .fine = 5}, glance{.coarse = 8, .fine = 0};
constexpr FitRounds from_exchanged{.coarse = 25, .fine = 10};  // the trunk has to rotate back

struct Start {
  int32_t shape = 0;
  Posture posture;
  const std::vector<int32_t>* images = nullptr;
};

class Fitting {
 public:
  Fitting(const Detection& detection, const PlacedSkeleton& start, const Execution& execution)
      : detection_(detection),
        model_(*detection.model),
        start_(start),
        execution_(execution),
        target_(detection.analysis->surface()),
        fits_(model_.exemplars.size()) {
    std::vector<Joint> joints;
    for (const SkeletonJoint& joint : start.joints) joints.push_back({joint.name, joint.parent});
    counterpart_ = other_sides(joints);
  }

  bool has_sides() const {
    return std::any_of(counterpart_.begin(), counterpart_.end(), [](int32_t one) { return one >= 0; });
  }

  // Appends the fits, in the order of the starts.
  void add(const std::vector<Start>& starts, const FitRounds& rounds, std::vector<FittedShape>& fits) {
    static const std::vector<int32_t> no_images;
    std::vector<int32_t> shapes;
    for (const Start& from : starts) shapes.push_back(from.shape);
    make_fits(shapes);
    const size_t before = fits.size();
    fits.resize(before + starts.size());
    parallel_for(execution_, static_cast<int64_t>(starts.size()), [&](int64_t i) {
      const Start& from = starts[i];
      const ArticulatedFit& fit = *fits_[from.shape];
      FittedShape& one = fits[before + i];
      one.shape = from.shape, one.posture = from.posture;
      fit.run(rounds, from.images ? *from.images : no_images, one.posture);
      one.residual = fit.residual(one.posture);
    });
  }

  std::vector<Start> from_maps(const std::vector<ShapeMap>& maps) const {
    std::vector<const ShapeMap*> order;
    for (const ShapeMap& one : maps) order.push_back(&one);
    std::stable_sort(order.begin(), order.end(),
                     [](const ShapeMap* a, const ShapeMap* b) { return a->map.residual < b->map.residual; });
    order.resize(std::min(order.size(), max_from_maps));
    std::vector<Start> starts;
    for (const ShapeMap* one : order) starts.push_back({one->shape, as_placed(one->shape), &one->map.image});
    return starts;
  }

  // Exchanges left and right.
  std::vector<Start> reversed(std::vector<FittedShape> fits) const {
    keep_best(fits, max_reversed);
    const Matrix3 about_up = Eigen::AngleAxisd(EIGEN_PI, Vector3::UnitY()).toRotationMatrix();
    std::vector<Start> starts;
    for (const FittedShape& one : fits) {
      Start& start = starts.emplace_back(Start{one.shape, one.posture});
      for (size_t j = 0; j < counterpart_.size(); ++j) {
        const size_t from = counterpart_[j] < 0 ? j : static_cast<size_t>(counterpart_[j]);
        start.posture.place[j] = one.posture.place[from];
        start.posture.turn[j] = one.posture.turn[from] * about_up;
        start.posture.length[j] = one.posture.length[from], start.posture.girth[j] = one.posture.girth[from];
      }
    }
    return starts;
  }

  // Exchanges each pair of limbs that hang down side by side, mainly legs, where they are crossed: in a
  // stride, maps can confuse them.
  std::vector<Start> with_exchanged_limbs(const FittedShape& one) const {
    const ArticulatedFit& fit = *fits_[one.shape];
    std::vector<Start> starts;
    for (size_t j = 0; j < counterpart_.size(); ++j) {
      const int32_t other = counterpart_[j];
      if (other <= static_cast<int32_t>(j) || !fit.has(j) || !fit.has(other)) continue;
      const int32_t parent = start_.joints[j].parent;
      if (parent >= 0 && counterpart_[parent] >= 0) continue;  // within a limb
      const std::vector<size_t> limb = limb_from(j);
      if (limb.size() < 3 || fit.bone(j).dot(fit.bone(other)) < 0.5) continue;
      if (!is_crossed(one.posture, limb)) continue;
      Start& start = starts.emplace_back(Start{one.shape, one.posture});
      if (parent >= 0) untwist(fit, static_cast<size_t>(parent), start.posture);
      for (const size_t from : limb) {
        const auto to = static_cast<size_t>(counterpart_[from]);
        take_place(fit, one.posture, from, to, start.posture);
        take_place(fit, one.posture, to, from, start.posture);
      }
    }
    return starts;
  }

  // Training shapes in their own pose with the extents of the body, with the same heading or both.
  std::vector<Start> laid_over(bool either_way) {
    const SurfaceAnalysis& analysis = *detection_.analysis;
    const Matrix3 about_up = Eigen::AngleAxisd(EIGEN_PI, Vector3::UnitY()).toRotationMatrix();
    std::vector<Start> starts;
    std::vector<Matrix3> frames{detection_.frame};
    if (either_way) frames.push_back(about_up * detection_.frame);
    for (const Matrix3& frame : frames) {
      std::vector<int32_t> shapes =
          lay_shapes_over(model_, analysis, frame, max_laid_over, 0, execution_).exemplars;
      std::erase_if(shapes, [&](int32_t shape) { return !model_.exemplars[shape].rig; });
      make_fits(shapes);
      for (const int32_t shape : shapes) starts.push_back({shape, as_it_stands(shape, frame)});
    }
    std::vector<FittedShape> fits;
    add(starts, glance, fits);
    keep_best(fits, max_kept_over);
    starts.clear();
    for (const FittedShape& one : fits) starts.push_back({one.shape, one.posture});
    return starts;
  }

  bool has_other_side(size_t joint) const { return counterpart_[joint] >= 0; }

  // Whether the joints are nearer to the start with its sides exchanged.
  bool is_reversed(const FittedShape& fit) const {
    double as_it_is = 0, exchanged = 0;
    for (size_t j = 0; j < counterpart_.size(); ++j)
      if (counterpart_[j] >= 0) {
        as_it_is += (fit.posture.place[j] - start_.place[j]).norm();
        exchanged += (fit.posture.place[j] - start_.place[counterpart_[j]]).norm();
      }
    return exchanged < as_it_is;
  }

  // The detection's evidence that the start faces as the body does: negative where maps exchanged its sides,
  // compared with a training shape in the detected frame.
  double heading_advantage(const FittedShape& any) const {
    const ArticulatedFit& fit = *fits_[any.shape];
    double along = 0;
    for (size_t j = 0; j < counterpart_.size(); ++j)
      if (const int32_t other = counterpart_[j];
          other > static_cast<int32_t>(j) && fit.has(j) && fit.has(other))
        along += (fit.bind_place(j) - fit.bind_place(other))
                     .dot(detection_.frame * (start_.place[j] - start_.place[other]));
    return along < 0 ? -detection_.heading_advantage : detection_.heading_advantage;
  }

  void finish(FittedShape& one) const {
    const ArticulatedFit& fit = *fits_[one.shape];
    one.points = fit.points(one.posture);
    for (size_t j = 0; j < start_.place.size(); ++j)
      one.tip.push_back(fit.has(j) ? fit.carried(one.posture, j, model_.exemplars[one.shape].rig->tip[j])
                                   : start_.tip[j]);
  }

  static void keep_best(std::vector<FittedShape>& fits, size_t most) {
    std::stable_sort(fits.begin(), fits.end(),
                     [](const FittedShape& a, const FittedShape& b) { return a.residual < b.residual; });
    fits.resize(std::min(fits.size(), most));
  }

 private:
  // Whether a limb is on the other side than the roots of the body's other limbs, because the ends of limbs
  // swing.
  bool is_crossed(const Posture& posture, const std::vector<size_t>& limb) const {
    Vector3 of_limb = Vector3::Zero(), of_roots = Vector3::Zero();
    for (size_t j = 0; j < counterpart_.size(); ++j) {
      const int32_t other = counterpart_[j], parent = start_.joints[j].parent;
      if (other <= static_cast<int32_t>(j)) continue;
      const Vector3 way = posture.place[j] - posture.place[other];
      if (std::find(limb.begin(), limb.end(), j) != limb.end())
        of_limb += way;
      else if (parent < 0 || counterpart_[parent] < 0)
        of_roots += way;
    }
    return of_limb.dot(of_roots) < 0;
  }

  // A joint without a side gets the rotation of the next one, like the trunk above the hips.
  void untwist(const ArticulatedFit& fit, size_t joint, Posture& posture) const {
    for (size_t j = 0; j < counterpart_.size(); ++j)
      if (start_.joints[j].parent == static_cast<int32_t>(joint) && counterpart_[j] < 0 && fit.has(j))
        posture.turn[joint] = posture.turn[j];
  }

  // A joint and its descendants that have a counterpart.
  std::vector<size_t> limb_from(size_t root) const {
    std::vector<char> is_in(start_.joints.size(), 0);
    std::vector<size_t> limb;
    for (size_t j = root; j < start_.joints.size(); ++j) {
      const int32_t parent = start_.joints[j].parent;
      if (counterpart_[j] < 0 || (j != root && (parent < 0 || !is_in[parent]))) continue;
      is_in[j] = 1;
      limb.push_back(j);
    }
    return limb;
  }

  // Moves joint `to` to the position of `from`, with its bone along the other's.
  static void take_place(const ArticulatedFit& fit, const Posture& before, size_t from, size_t to,
                         Posture& posture) {
    if (!fit.has(from) || !fit.has(to)) return;
    posture.place[to] = before.place[from];
    posture.turn[to] = before.turn[from] *
                       Eigen::Quaterniond::FromTwoVectors(fit.bone(to), fit.bone(from)).toRotationMatrix();
    posture.length[to] = before.length[from], posture.girth[to] = before.girth[from];
  }

  // Creates the fits that do not exist yet.
  void make_fits(std::vector<int32_t> shapes) {
    std::sort(shapes.begin(), shapes.end());
    shapes.erase(std::unique(shapes.begin(), shapes.end()), shapes.end());
    std::erase_if(shapes, [&](int32_t shape) { return fits_[shape] != nullptr; });
    parallel_for(execution_, static_cast<int64_t>(shapes.size()), [&](int64_t i) {
      const int32_t s = shapes[i];
      fits_[s] = std::make_unique<ArticulatedFit>(start_.joints, model_.exemplars[s], counterpart_, target_);
    });
  }

  Posture unmoved() const {
    const auto joints = static_cast<Eigen::Index>(start_.place.size());
    return {start_.place, std::vector<Matrix3>(start_.place.size(), Matrix3::Identity()),
            Vector::Zero(joints), Vector::Zero(joints)};
  }

  // The joints as the maps agree on them.
  Posture as_placed(int32_t shape) const {
    const ShapeRig& rig = *model_.exemplars[shape].rig;
    Posture result = unmoved();
    double sum = 0;
    int32_t count = 0;
    for (size_t j = 0; j < start_.joints.size(); ++j) {
      if (!rig.bind[j]) continue;
      result.turn[j] = start_.turn[j] * rig.bind[j]->topLeftCorner<3, 3>().transpose();
      const int32_t p = start_.joints[j].parent;
      if (p < 0 || !rig.bind[p]) continue;
      const double to = (start_.place[j] - start_.place[p]).norm();
      const double from = (rig.bind[j]->topRightCorner<3, 1>() - rig.bind[p]->topRightCorner<3, 1>()).norm();
      constexpr double min_length = 1e-3;
      if (to > min_length && from > min_length) sum += std::log(to / from), ++count;
    }
    const double size = std::clamp(sum / std::max(count, 1), -0.5, 0.5);
    result.length.setConstant(size), result.girth.setConstant(size / 2);
    return result;
  }

  Posture as_it_stands(int32_t shape, const Matrix3& frame) const {
    const Exemplar& of = model_.exemplars[shape];
    const ArticulatedFit& fit = *fits_[shape];
    const Vector weight = of.samples.weight.head(of.positions.rows()).cast<double>();
    const Extents own = extents_of(of.positions, weight);
    const Extents body = extents_of(target_.positions * frame.transpose(), target_.area);
    const Vector3 scale = scale_onto(own, body);
    const double mean_scale = std::log(body.deviation.cwiseQuotient(own.deviation.cwiseMax(1e-9)).prod()) / 3;
    Posture result = unmoved();
    for (size_t j = 0; j < start_.joints.size(); ++j) {
      if (!fit.has(j)) continue;
      result.place[j] = frame.transpose() * (scale.cwiseProduct(fit.bind_place(j) - own.mean) + body.mean);
      result.turn[j] = frame.transpose();
      const double along = std::log(scale.cwiseProduct(fit.bone(j)).norm());
      const auto at = static_cast<Eigen::Index>(j);
      result.length[at] = along;
      result.girth[at] = std::clamp(1.5 * mean_scale - 0.5 * along, -1.0, 1.0);  // preserves the volume
    }
    return result;
  }

  const Detection& detection_;
  const LandmarkModel& model_;
  const PlacedSkeleton& start_;
  const Execution& execution_;
  FitTarget target_;
  std::vector<int32_t> counterpart_;
  // Per shape of the exemplars, those created so far.
  std::vector<std::unique_ptr<const ArticulatedFit>> fits_;
};

double apart(const std::vector<Vector3>& a, const std::vector<Vector3>& b) {
  double sum = 0;
  for (size_t j = 0; j < a.size(); ++j) sum += (a[j] - b[j]).norm();
  return sum / static_cast<double>(a.size());
}

double agreement_of(const std::vector<Vector3>& a, const std::vector<Vector3>& b) {
  return 1 / (1 + std::pow(apart(a, b) / agreement, 4));
}

// Mean distance from fixed joints that have a counterpart; empty without such joints.
std::optional<double> away_from(const FixedJoints& fixed, const Fitting& fitting, const FittedShape& fit) {
  std::optional<double> sum;
  for (size_t j = 0; j < fixed.size(); ++j)
    if (fixed[j] && fitting.has_other_side(j))
      sum = sum.value_or(0) + (fit.posture.place[j] - *fixed[j]).norm();
  return sum;
}

// Keeps the fits with the heading of the fixed joints or, without these, of the best fit; best first.
void choose_heading(const Fitting& fitting, bool may_reverse, const FixedJoints& fixed, BodyFit& result) {
  std::vector<FittedShape> kept[2];
  for (FittedShape& one : result.shapes)
    kept[may_reverse && fitting.is_reversed(one) ? 1 : 0].push_back(std::move(one));
  for (auto& fits : kept) Fitting::keep_best(fits, fits.size());
  if (!kept[0].empty() && !kept[1].empty()) {
    const double margin = std::log(kept[1][0].residual / kept[0][0].residual) +
                          advantage_weight * fitting.heading_advantage(kept[0][0]);
    const auto as_it_is = away_from(fixed, fitting, kept[0][0]),
               reversed = away_from(fixed, fitting, kept[1][0]);
    result.is_reversed = as_it_is ? *reversed < *as_it_is : margin < 0;
    if (!as_it_is) result.heading_margin = std::abs(margin);
  } else {
    result.is_reversed = kept[0].empty();
  }
  result.shapes = std::move(kept[result.is_reversed ? 1 : 0]);
}

}  // namespace

BodyFit fit_to_body(const Detection& detection, const std::vector<ShapeMap>& maps,
                    const PlacedSkeleton& start, bool may_reverse, const FixedJoints& fixed,
                    const Execution& execution) {
  Fitting fitting(detection, start, execution);
  BodyFit result;
  fitting.add(fitting.from_maps(maps), from_maps, result.shapes);
  const bool is_known = away_from(fixed, fitting, result.shapes[0]).has_value();
  const double nearest = std::ranges::min(result.shapes, {}, &FittedShape::residual).residual;
  const bool is_sure = detection.bulge_agreement >= sure_bulge && nearest < sure_residual &&
                       fitting.heading_advantage(result.shapes[0]) >= sure_advantage;
  if (detection.model->params.oriented && (is_known || !is_sure)) {
    may_reverse = may_reverse && fitting.has_sides();
    if (may_reverse) fitting.add(fitting.reversed(result.shapes), from_posture, result.shapes);
    fitting.add(fitting.laid_over(may_reverse), from_posture, result.shapes);
  }
  choose_heading(fitting, may_reverse, fixed, result);
  if (!is_sure && may_reverse && fitting.has_sides()) {
    fitting.add(fitting.with_exchanged_limbs(result.shapes[0]), from_exchanged, result.shapes);
    Fitting::keep_best(result.shapes, result.shapes.size());
  }
  double sum = 0;
  const FittedShape& best = result.shapes[0];
  for (FittedShape& one : result.shapes) {
    one.share = std::exp(-residual_falloff * (one.residual / best.residual - 1)) *
                agreement_of(one.posture.place, best.posture.place);
    sum += one.share;
  }
  result.start_share = start_weight * sum * agreement_of(start.place, best.posture.place);
  constexpr double min_share = 1e-3;
  std::erase_if(result.shapes, [](const FittedShape& one) { return one.share < min_share; });
  for (FittedShape& one : result.shapes) fitting.finish(one);
  return result;
}

std::vector<ShapeMap> maps_of_fits(const BodyFit& fit, const LandmarkModel& model,
                                   const SurfaceAnalysis& analysis, const Execution& execution) {
  constexpr Eigen::Index functions = 100;
  const NearestVertex tree(analysis.surface().positions);
  std::vector<ShapeMap> result(fit.shapes.size());
  parallel_for(execution, static_cast<int64_t>(result.size()), [&](int64_t m) {
    const FittedShape& one = fit.shapes[m];
    const SpectralSamples& samples = model.exemplars[one.shape].samples;
    const Eigen::Index points = one.points.rows();
    const Eigen::Index k =
        std::min({functions, analysis.eigenfunctions.cols(), static_cast<Eigen::Index>(samples.Phi.cols())});
    ShapeMap& map = result[m];
    map.shape = one.shape, map.map.residual = static_cast<float>(one.residual);
    Eigen::MatrixXf there(points, k);
    for (Eigen::Index i = 0; i < points; ++i) {
      map.map.image.push_back(tree.nearest(one.points.row(i)).first);
      there.row(i) = samples.weight[i] * analysis.eigenfunctions.row(map.map.image.back()).head(k);
    }
    map.map.C = samples.Phi.topLeftCorner(points, k).transpose() * there;
  });
  return result;
}

}  // namespace focal
