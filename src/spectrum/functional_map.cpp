#include "spectrum/functional_map.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/aligned_array.h"
#include "base/multiversion.h"
#include "linear/block_kernels.h"

namespace focal {
namespace {

constexpr int lanes = 32;
constexpr int64_t tile = 4;  // of the block kernels: rows are in groups of four
constexpr int between = PlacesBetween::vertices;
// In sqrt(area), one and a half times the distance of spread vertices: with 3 landmarks 5 of 24 toys lose
// one, and 10 when all nearest vertices are used.
constexpr double neighbourhood = 0.06;

int64_t round_up(int64_t n, int64_t to) { return (n + to - 1) / to * to; }

// Rows of a matrix, 32 of them interleaved: entry (i, c) is at [(i / 32 * columns + c) * 32 + i % 32]. The
// last block is padded with copies of the last row.
class RowBlocks {
 public:
  template <class RowOf>  // RowOf(i): pointer to `columns` floats
  RowBlocks(int64_t rows, int64_t columns, const RowOf& row_of)
      : columns_(columns), blocks_((rows + lanes - 1) / lanes), data_(blocks_ * columns * lanes) {
    for (int64_t i = 0; i < blocks_ * lanes; ++i) {
      const float* row = row_of(std::min(i, rows - 1));
      float* to = data_.data() + i / lanes * columns * lanes + i % lanes;
      for (int64_t c = 0; c < columns; ++c) to[c * lanes] = row[c];
    }
  }
  int64_t blocks() const { return blocks_; }
  const float* block(int64_t b) const { return data_.data() + b * columns_ * lanes; }

 private:
  int64_t columns_, blocks_;
  AlignedArray<float> data_;
};

constexpr float worst = -std::numeric_limits<float>::infinity();

// The nearest targets of a point, best score first, the first of equal ones. The point is between all but the
// last of them: that one's score is where the weights become 0, so that they are continuous when another
// target takes its place.
template <int kept>
struct NearestFew {
  float score[kept];
  int32_t target[kept];

  void add(float next, int32_t number) {
    int at = kept - 1;
    for (; at > 0 && next > score[at - 1]; --at) score[at] = score[at - 1], target[at] = target[at - 1];
    score[at] = next, target[at] = number;
  }
  // Weights of the first kept - 1; they sum to 1. near(i): a factor of 0 to 1, 1 for the first.
  template <class Near>
  void weigh(float* weight, const Near& near) const {
    int last = kept - 1;
    while (last > 0 && score[last] == worst) --last;
    float sum = 0;
    for (int i = 0; i < kept - 1; ++i) {
      const float ahead = i < last ? score[i] - score[last] : 0;
      sum += weight[i] = ahead * ahead * near(i);
    }
    for (int i = 0; i < kept - 1; ++i) weight[i] = sum > 0 ? weight[i] / sum : static_cast<float>(i == 0);
  }
};

FOCAL_MULTIVERSION(
    void mark_better(const float* score, int64_t rows, const float* least, int32_t* better),
    for (int64_t r = 0; r < rows; ++r) {
      int32_t any = 0;
      for (int j = 0; j < lanes; ++j) any |= score[r * lanes + j] > least[r] ? 1 : 0;
      better[r] = any;
    })

// Nearest targets by blocks: score = place . target - |target|^2 / 2 is largest where the distance is
// smallest.
template <int kept>
class NearestSearch {
 public:
  NearestSearch(int64_t places, int32_t targets)
      : rows_(places),
        padded_(round_up(places, tile)),
        targets_(targets),
        score_(std::min(chunk, padded_) * lanes),
        least_(padded_),
        found_(places) {
    std::fill_n(least_.data(), least_.size(), worst);
    for (auto& few : found_) std::fill_n(few.score, kept, worst), std::fill_n(few.target, kept, 0);
  }

  // places: padded rows; target: k x 32.
  void look_at(const StridedView<float>& places, int64_t k, const float* target, int32_t block) {
    float half[lanes] = {};
    for (int64_t c = 0; c < k; ++c)
      for (int j = 0; j < lanes; ++j) half[j] += target[c * lanes + j] * target[c * lanes + j];
    for (int64_t begin = 0; begin < padded_; begin += chunk) {
      const int64_t rows = std::min(chunk, padded_ - begin);
      for (int64_t r = 0; r < rows; ++r)
        for (int j = 0; j < lanes; ++j) score_.data()[r * lanes + j] = -half[j] / 2;
      multiply_add({places.data + begin * places.row_step, places.row_step, places.inner_step}, rows, k,
                   target, score_.data());
      keep_better(block, begin, std::min(rows, rows_ - begin));
    }
  }

  const std::vector<NearestFew<kept>>& result() const { return found_; }

 private:
  void keep_better(int32_t block, int64_t begin, int64_t rows) {
    int32_t better[chunk];
    mark_better(score_.data(), rows, least_.data() + begin, better);
    const int32_t first = block * lanes, count = std::min(lanes, targets_ - first);
    for (int64_t r = 0; r < rows; ++r) {
      if (!better[r]) continue;
      NearestFew<kept>& few = found_[begin + r];
      for (int j = 0; j < count; ++j)
        if (score_.data()[r * lanes + j] > few.score[kept - 1])
          few.add(score_.data()[r * lanes + j], first + j);
      least_.data()[begin + r] = few.score[kept - 1];
    }
  }

  static constexpr int64_t chunk = 256;
  int64_t rows_, padded_;
  int32_t targets_;
  AlignedArray<float> score_, least_;
  std::vector<NearestFew<kept>> found_;
};

RowMatrixf padded_rows(const Eigen::Ref<const RowMatrixf, 0, Eigen::OuterStride<>>& rows) {
  RowMatrixf result = RowMatrixf::Zero(round_up(rows.rows(), tile), rows.cols());
  result.topRows(rows.rows()) = rows;
  return result;
}

// numbers: of the targets, or null.
void place_between(const NearestFew<between + 1>& found, const MatrixX3& positions,
                   const std::vector<int32_t>* numbers, int64_t at, PlacesBetween& places) {
  int32_t* vertex = &places.vertex[at * between];
  for (int i = 0; i < between; ++i) vertex[i] = numbers ? (*numbers)[found.target[i]] : found.target[i];
  found.weigh(&places.weight[at * between], [&](int i) {
    if (positions.rows() == 0) return 1.0F;
    const double square = (positions.row(vertex[i]) - positions.row(vertex[0])).squaredNorm();
    const double inside = std::max(1 - square / (neighbourhood * neighbourhood), 0.0);
    return static_cast<float>(inside * inside);
  });
}

template <int kept>
std::vector<NearestFew<kept>> few_nearest_rows(const RowMatrixf& places, const RowMatrixf& targets) {
  const RowMatrixf padded = padded_rows(places);
  const RowBlocks blocks(targets.rows(), targets.cols(), [&](int64_t i) { return targets.row(i).data(); });
  NearestSearch<kept> search(places.rows(), static_cast<int32_t>(targets.rows()));
  for (int64_t b = 0; b < blocks.blocks(); ++b)
    search.look_at({padded.data(), padded.cols(), 1}, padded.cols(), blocks.block(b),
                   static_cast<int32_t>(b));
  return search.result();
}

// One map during its computation.
class ZoomOut {
 public:
  ZoomOut(const SpectralSamples& from, const SpectralTargets& to, PlacesBetween initial,
          const MapParams& params)
      : from_(from),
        to_(to),
        params_(params),
        most_(std::min({int64_t{params.last}, int64_t{from.Phi.cols()}, int64_t{to.Phi.cols()}}) / tile *
              tile),
        points_(padded_rows(from.Phi.leftCols(most_))),
        weighted_(RowMatrixf::Zero(points_.rows(), most_)),
        spread_(static_cast<int64_t>(to.spread.size()), most_,
                [&](int64_t i) { return to.Phi.row(to.spread[i]).data(); }) {
    const auto known = from.Phi.rows();
    weighted_.topRows(known) = from.weight.asDiagonal() * points_.topRows(known);
    gram_ = Eigen::LLT<Eigen::MatrixXf>(points_.transpose() * weighted_).matrixL();
    map_.places = std::move(initial);
    map_.image.resize(from.Phi.rows());
  }

  FunctionalMap run(const Execution& execution) {
    const auto most = static_cast<int32_t>(most_);
    for (int32_t k = std::min(params_.first, most);; k = std::min(k + params_.step, most)) {
      execution.check_cancelled();
      fit(k);
      if (k == most) break;
      assign_spread(k);
    }
    const int64_t known = from_.Phi.rows();
    const int64_t exact = params_.exact_from < known ? params_.exact_from / tile * tile : known;
    execution.check_cancelled();
    if (exact > 0) assign_spread(most);
    execution.check_cancelled();
    if (exact < known) assign_all(most, exact);
    measure();
    return std::move(map_);
  }

 private:
  // C = (Phi^T W Phi)^-1 Phi^T W Phi_to(images): the least-squares fit. Images are between vertices: with
  // whole vertices a rounding error could decide between two, change the fit, and move more points from round
  // to round.
  void fit(int32_t k) {
    const int64_t rows = points_.rows(), known = from_.Phi.rows();
    map_.C.resize(k, k);
    AlignedArray<float> images(rows * lanes), product(round_up(k, tile) * lanes);
    for (int32_t begin = 0; begin < k; begin += lanes) {
      const int32_t count = std::min(lanes, k - begin);
      std::fill_n(images.data(), images.size(), 0.0f);
      for (int64_t i = 0; i < known * between; ++i) {
        const float weight = map_.places.weight[i];
        const float* from = to_.Phi.row(map_.places.vertex[i]).data() + begin;
        float* to = images.data() + i / between * lanes;
        for (int32_t c = 0; c < count; ++c) to[c] += weight * from[c];
      }
      std::fill_n(product.data(), product.size(), 0.0f);
      multiply_add({weighted_.data(), 1, weighted_.cols()}, k, rows, images.data(), product.data());
      map_.C.middleCols(begin, count) =
          Eigen::Map<const RowMatrixf>(product.data(), k, lanes).leftCols(count);
    }
    // A leading block of a Cholesky factor is the factor of the leading block.
    const auto L = gram_.topLeftCorner(k, k).triangularView<Eigen::Lower>();
    L.solveInPlace(map_.C);
    L.transpose().solveInPlace(map_.C);
  }

  void assign_spread(int32_t k) {
    take(nearest(spread_, static_cast<int32_t>(to_.spread.size()), k, 0), 0, &to_.spread);
  }

  void assign_all(int32_t k, int64_t first) {
    const RowBlocks all(to_.Phi.rows(), k, [&](int64_t i) { return to_.Phi.row(i).data(); });
    take(nearest(all, static_cast<int32_t>(to_.Phi.rows()), k, first), first, nullptr);
  }

  void take(const std::vector<NearestFew<between + 1>>& found, int64_t first,
            const std::vector<int32_t>* numbers) {
    for (size_t y = 0; y < found.size(); ++y) {
      const int64_t at = first + static_cast<int64_t>(y);
      place_between(found[y], to_.positions, numbers, at, map_.places);
      map_.image[at] = map_.places.vertex[at * between];
    }
  }

  // For each point from `first` on, the nearest targets in the embedding of the points.
  std::vector<NearestFew<between + 1>> nearest(const RowBlocks& targets, int32_t count, int32_t k,
                                               int64_t first) const {
    NearestSearch<between + 1> search(from_.Phi.rows() - first, count);
    const RowMatrixf C = map_.C;
    AlignedArray<float> moved(static_cast<size_t>(k) * lanes);
    for (int64_t b = 0; b < targets.blocks(); ++b) {
      std::fill_n(moved.data(), moved.size(), 0.0f);
      multiply_add({C.data(), k, 1}, k, k, targets.block(b), moved.data());
      search.look_at({points_.row(first).data(), points_.cols(), 1}, k, moved.data(),
                     static_cast<int32_t>(b));
    }
    return search.result();
  }

  void measure() {
    const Eigen::Index k = map_.C.rows();
    double away = 0, size = 0;
    for (size_t y = 0; y < map_.image.size(); ++y) {
      const Eigen::VectorXf image = map_.C * to_.Phi.row(map_.image[y]).head(k).transpose();
      const auto place = points_.row(y).head(k).transpose();
      away += from_.weight[y] * (place - image).squaredNorm(), size += from_.weight[y] * place.squaredNorm();
    }
    map_.residual = static_cast<float>(std::sqrt(away / size));
  }

  const SpectralSamples& from_;
  const SpectralTargets& to_;
  const MapParams& params_;
  int64_t most_;  // eigenfunctions of the last round
  RowMatrixf points_, weighted_;
  RowBlocks spread_;
  Eigen::MatrixXf gram_;
  FunctionalMap map_;
};

}  // namespace

FunctionalMap zoom_out(const SpectralSamples& from, const SpectralTargets& to, PlacesBetween initial,
                       const MapParams& params, const Execution& execution) {
  return ZoomOut(from, to, std::move(initial), params).run(execution);
}

std::vector<int32_t> nearest_rows(const RowMatrixf& places, const RowMatrixf& targets) {
  std::vector<int32_t> numbers;
  for (const auto& nearest : few_nearest_rows<1>(places, targets)) numbers.push_back(nearest.target[0]);
  return numbers;
}

PlacesBetween nearest_between(const RowMatrixf& places, const RowMatrixf& targets,
                              const MatrixX3& positions) {
  PlacesBetween result;
  result.vertex.resize(places.rows() * between), result.weight.resize(result.vertex.size());
  const auto found = few_nearest_rows<between + 1>(places, targets);
  for (size_t i = 0; i < found.size(); ++i)
    place_between(found[i], positions, nullptr, static_cast<int64_t>(i), result);
  return result;
}

std::vector<int32_t> farthest_points(const MatrixX3& positions, int32_t count, int32_t first) {
  const auto n = static_cast<int32_t>(positions.rows());
  Vector away = Vector::Constant(n, std::numeric_limits<double>::infinity());
  std::vector<int32_t> chosen;
  for (int32_t next = first; static_cast<int32_t>(chosen.size()) < std::min(count, n);) {
    chosen.push_back(next);
    away = away.cwiseMin((positions.rowwise() - positions.row(next)).rowwise().squaredNorm());
    Eigen::Index farthest = 0;
    away.maxCoeff(&farthest);
    next = static_cast<int32_t>(farthest);
  }
  return chosen;
}

}  // namespace focal
