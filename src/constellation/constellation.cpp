#include "constellation/constellation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/multiversion.h"
#include "base/random.h"

namespace focal {
namespace {

constexpr float pair_clip = 8, chirality_clip = 4;
constexpr float min_gain = 1e-5f;  // a move must gain more than rounding

// sum over b of min((x y_b - y x_b - mean_b)^2 / (2 sd_b^2), clip); inverse = 1 / (sd sqrt 2).
FOCAL_INLINE float chirality_body(float x, float y, const float* xs, const float* ys, const float* mean,
                                  const float* inverse, const float* here, int32_t count) {
  constexpr int width = 16;  // fixed, so that every vector width adds in the same order
  float part[width] = {};
  for (int32_t b = 0; b < count; b += width)  // arrays are padded with inverse = 0
    for (int k = 0; k < width; ++k) {
      const float z = (x * ys[b + k] - y * xs[b + k] - mean[b + k]) * inverse[b + k] * here[b + k];
      part[k] += std::min(z * z, chirality_clip);
    }
  float sum = 0;
  for (const float p : part) sum += p;
  return sum;
}
FOCAL_MULTIVERSION(float chirality_cost(float x, float y, const float* xs, const float* ys, const float* mean,
                                        const float* inverse, const float* here, int32_t count),
                   return chirality_body(x, y, xs, ys, mean, inverse, here, count);)

// Statistics in the layout of the inner loop: rows padded to a multiple of 16, inverse deviations, zero where
// two of the three landmarks are the same.
struct Tables {
  int32_t L, padded;
  std::vector<float> mean, inverse;  // [c][a][padded b]
  RowMatrixf distance_mean, distance_inverse;

  explicit Tables(const ConstellationStatistics& s) : L(s.landmarks), padded((s.landmarks + 15) / 16 * 16) {
    mean.assign(static_cast<size_t>(L) * L * padded, 0);
    inverse = mean;
    for (int32_t c = 0; c < L; ++c)
      for (int32_t a = 0; a < L; ++a)
        for (int32_t b = 0; b < L; ++b) {
          if (c == a || c == b || a == b) continue;
          mean[row(c, a) + b] = s.chirality_mean[s.index(c, a, b)];
          inverse[row(c, a) + b] = std::sqrt(0.5f) / s.chirality_sd[s.index(c, a, b)];
        }
    distance_mean = s.distance_mean;
    distance_inverse = std::sqrt(0.5f) * s.distance_sd.cwiseInverse();
    distance_inverse.diagonal().setZero();
  }
  size_t row(int32_t c, int32_t a) const { return (static_cast<size_t>(c) * L + a) * padded; }
};

// One descent: the chosen candidate of every landmark, and the tangent directions from each chosen one to all
// others.
class Descent {
 public:
  // start: one candidate per landmark, or -1.
  Descent(const Tables& tables, const ConstellationCandidates& candidates, const ConstellationParams& params,
          const std::vector<int32_t>& start)
      : t_(tables),
        c_(candidates),
        chosen_(tables.L, -1),
        xs_(RowMatrixf::Zero(tables.L, tables.padded)),
        ys_(xs_),
        row_x_(tables.padded),
        row_y_(tables.padded),
        here_(tables.padded, 0) {
    const double others = std::max(1, t_.L - 1);
    unary_ = static_cast<float>(params.unary_weight);
    pair_ = static_cast<float>(params.pair_weight / others);
    certain_ = static_cast<float>(params.certain_weight);
    chirality_ = static_cast<float>(2 * params.chirality_weight / (others * std::max(1, t_.L - 2)));
    for (int32_t l = 0; l < t_.L; ++l) choose(l, start[l]);
  }

  void choose(int32_t l, int32_t candidate) {
    chosen_[l] = candidate;
    here_[l] = candidate >= 0;
    if (candidate < 0) return;
    for (int32_t o = 0; o < t_.L; ++o) {
      if (chosen_[o] < 0) continue;
      xs_(o, l) = c_.directions.x(chosen_[o], candidate), ys_(o, l) = c_.directions.y(chosen_[o], candidate);
      xs_(l, o) = c_.directions.x(candidate, chosen_[o]), ys_(l, o) = c_.directions.y(candidate, chosen_[o]);
    }
  }

  // The terms of the energy that depend on the position of landmark l.
  float cost(int32_t l, int32_t candidate) {
    float pairs = 0, triples = 0;
    for (int32_t o = 0; o < t_.L; ++o) row_x_[o] = row_y_[o] = 0;
    for (int32_t o = 0; o < t_.L; ++o) {
      if (o == l || chosen_[o] < 0) continue;
      row_x_[o] = c_.directions.x(candidate, chosen_[o]), row_y_[o] = c_.directions.y(candidate, chosen_[o]);
      pairs += weight_of(l, o) * pair_cost(l, candidate, o);
    }
    for (int32_t o = 0; o < t_.L; ++o) {
      if (o == l || chosen_[o] < 0) continue;
      // At l, from o to every b (each pair is counted twice: halved); at o, from l to every b.
      const size_t at_l = t_.row(l, o), at_o = t_.row(o, l);
      triples += 0.5f * chirality_cost(row_x_[o], row_y_[o], row_x_.data(), row_y_.data(), &t_.mean[at_l],
                                       &t_.inverse[at_l], here_.data(), t_.padded);
      triples +=
          chirality_cost(c_.directions.x(chosen_[o], candidate), c_.directions.y(chosen_[o], candidate),
                         &xs_(o, 0), &ys_(o, 0), &t_.mean[at_o], &t_.inverse[at_o], here_.data(), t_.padded);
    }
    return unary_ * c_.unary[candidate] + pair_ * pairs + chirality_ * triples;
  }

  void run(Random& random) {
    std::vector<int32_t> order(t_.L);
    std::iota(order.begin(), order.end(), 0);
    for (bool moved = true; moved;) {
      moved = false;
      for (int32_t i = t_.L - 1; i > 0; --i) std::swap(order[i], order[random.below(i + 1)]);
      for (const int32_t l : order) moved = improve(l) || moved;
    }
  }

  double energy() {  // each term once
    double sum = 0;
    for (int32_t l = 0; l < t_.L; ++l) {
      if (chosen_[l] < 0) {
        if (c_.start[l] < c_.start[l + 1]) sum += absent_cost_;
        continue;
      }
      sum += unary_ * c_.unary[chosen_[l]];
      for (int32_t o = 0; o < t_.L; ++o) {
        if (o == l || chosen_[o] < 0) continue;
        if (o < l) sum += pair_ * weight_of(l, o) * pair_cost(l, chosen_[l], o);
        sum += 0.5 * chirality_ *
               chirality_cost(xs_(l, o), ys_(l, o), &xs_(l, 0), &ys_(l, 0), &t_.mean[t_.row(l, o)],
                              &t_.inverse[t_.row(l, o)], here_.data(), t_.padded);
      }
    }
    return sum;
  }

  float residual(int32_t l, int32_t candidate) const {
    float sum = 0;
    int32_t count = 0;
    for (int32_t o = 0; o < t_.L; ++o)
      if (o != l && chosen_[o] >= 0 && candidate >= 0) sum += pair_cost(l, candidate, o), ++count;
    return count ? sum / static_cast<float>(count) : 0;
  }
  ConstellationChoice result() {
    ConstellationChoice choice;
    choice.energy = energy();
    for (int32_t l = 0; l < t_.L; ++l) {
      choice.left_out.push_back(chosen_[l] < 0);
      choice.candidate.push_back(best_option(l).candidate);
      choice.residual.push_back(residual(l, choice.candidate[l]));
    }
    return choice;
  }
  const std::vector<int32_t>& chosen() const { return chosen_; }
  void allow_absence(double cost) { absent_cost_ = static_cast<float>(cost); }

  struct Option {
    int32_t candidate = -1;
    float cost = std::numeric_limits<float>::infinity();
  };
  // The candidate that fits the others best, also for a landmark that is left out.
  Option best_option(int32_t l) {
    Option best;
    if (chosen_[l] >= 0) best = {chosen_[l], cost(l, chosen_[l]) - min_gain};
    for (int32_t k = c_.start[l]; k < c_.start[l + 1]; ++k) {
      if (k == chosen_[l]) continue;
      if (const float next = cost(l, k); next < best.cost) best = {k, next};
    }
    return best;
  }

 private:
  bool is_certain(int32_t l) const { return !c_.certain.empty() && c_.certain[l]; }
  float weight_of(int32_t l, int32_t o) const { return is_certain(l) || is_certain(o) ? certain_ : 1; }
  float pair_cost(int32_t l, int32_t candidate, int32_t o) const {
    const float z = (c_.distance(candidate, chosen_[o]) - t_.distance_mean(l, o)) * t_.distance_inverse(l, o);
    return std::min(z * z, pair_clip);
  }

  bool improve(int32_t l) {
    const Option option = best_option(l);
    const int32_t best = is_certain(l) || option.cost < absent_cost_ ? option.candidate : -1;
    if (best == chosen_[l]) return false;
    choose(l, best);
    return true;
  }

  const Tables& t_;
  const ConstellationCandidates& c_;
  float unary_, pair_, chirality_, certain_;
  float absent_cost_ = std::numeric_limits<float>::infinity();
  std::vector<int32_t> chosen_;
  RowMatrixf xs_, ys_;  // [at l][to o], chosen ones only
  std::vector<float> row_x_, row_y_, here_;
};

// Whether three quarters of the landmarks have about the same position.
bool is_like(const ConstellationChoice& a, const ConstellationChoice& b,
             const ConstellationCandidates& candidates) {
  constexpr float elsewhere = 0.1f;  // in sqrt(area)
  size_t differing = 0;
  for (size_t l = 0; l < a.candidate.size(); ++l)
    differing += a.candidate[l] >= 0 && candidates.distance(a.candidate[l], b.candidate[l]) > elsewhere;
  return 4 * differing < a.candidate.size();
}

}  // namespace

std::vector<ConstellationChoice> choose_constellations(const ConstellationStatistics& statistics,
                                                       const ConstellationCandidates& candidates,
                                                       const ConstellationParams& params,
                                                       const Execution& execution) {
  const Tables tables(statistics);
  std::vector<std::vector<int32_t>> minima(params.restarts);
  parallel_for(execution, params.restarts, [&](int64_t r) {
    Random random(params.seed, 2000 + r);
    std::vector<int32_t> start;
    for (int32_t l = 0; l < tables.L; ++l) {
      const int32_t options = candidates.start[l + 1] - candidates.start[l];
      const int32_t option = options > 0 && r ? static_cast<int32_t>(random.below(options)) : 0;
      start.push_back(options > 0 ? candidates.start[l] + option : -1);
    }
    Descent descent(tables, candidates, params, start);
    descent.run(random);
    minima[r] = descent.chosen();
  });
  std::sort(minima.begin(), minima.end());  // many restarts end in the same minimum
  minima.erase(std::unique(minima.begin(), minima.end()), minima.end());
  std::vector<ConstellationChoice> results(minima.size());
  parallel_for(execution, static_cast<int64_t>(minima.size()), [&](int64_t m) {
    Random random(params.seed, 4000 + m);
    Descent descent(tables, candidates, params, minima[m]);
    descent.allow_absence(params.absent_cost);  // only now: at the start all positions are wrong
    descent.run(random);
    results[m] = descent.result();
  });
  std::stable_sort(results.begin(), results.end(),
                   [](const auto& a, const auto& b) { return a.energy < b.energy; });
  std::vector<ConstellationChoice> distinct;
  for (auto& result : results) {
    if (result.energy > results.front().energy + params.energy_margin) break;
    if (std::none_of(distinct.begin(), distinct.end(),
                     [&](const auto& better) { return is_like(result, better, candidates); }))
      distinct.push_back(result);
    if (static_cast<int32_t>(distinct.size()) == params.max_choices) break;
  }
  return distinct;
}

ConstellationStatistics learn_constellation(std::span<const ConstellationSample> samples, int32_t landmarks) {
  // Corrects for the variation that few shapes cannot show: a new body can be larger or smaller than all of
  // them. The share of a distance was chosen by cross-validation on training splits (teddy 2.96 -> 2.71
  // edges, faust5k 1.25 -> 1.24).
  constexpr float distance_floor = 0.02f, distance_share = 0.08f, chirality_floor = 0.15f;
  ConstellationStatistics result;
  result.landmarks = landmarks;
  result.distance_mean = RowMatrixf::Zero(landmarks, landmarks);
  // Never present together: no information.
  result.distance_sd = RowMatrixf::Constant(landmarks, landmarks, 1e3f);
  const size_t triples = static_cast<size_t>(landmarks) * landmarks * landmarks;
  result.chirality_mean.assign(triples, 0);
  result.chirality_sd.assign(triples, 1e3f);
  const auto moments = [&](const auto& present, const auto& value, float floor, float share, float& mean,
                           float& sd) {
    double sum = 0, squares = 0;
    int32_t count = 0;
    for (const auto& sample : samples)
      if (present(sample)) {
        const double x = value(sample);
        sum += x, squares += x * x, ++count;
      }
    if (!count) return;
    mean = static_cast<float>(sum / count);
    const double variance = std::max(0.0, squares / count - mean * mean) + std::pow(share * mean, 2);
    sd = std::max(floor, static_cast<float>(std::sqrt(variance)));
  };
  for (int32_t c = 0; c < landmarks; ++c)
    for (int32_t a = 0; a < landmarks; ++a) {
      if (c == a) continue;
      moments([&](const auto& s) { return s.present[c] && s.present[a]; },
              [&](const auto& s) { return (s.distance(c, a) + s.distance(a, c)) / 2; }, distance_floor,
              distance_share, result.distance_mean(c, a), result.distance_sd(c, a));
      for (int32_t b = 0; b < landmarks; ++b)
        if (b != a && b != c)
          moments(
              [&](const auto& s) { return s.has_chirality && s.present[c] && s.present[a] && s.present[b]; },
              [&](const auto& s) { return s.directions.chirality(c, a, b); }, chirality_floor, 0,
              result.chirality_mean[result.index(c, a, b)], result.chirality_sd[result.index(c, a, b)]);
    }
  return result;
}

}  // namespace focal
