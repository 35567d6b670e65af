#include "analysis/device_surface.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <vector>

#include "analysis/leaf_votes.h"
#include "compute/module_loader.h"
#include "descriptors/si_hks.h"
#include "geodesics/heat_method.h"

namespace focal {
namespace {

// The forest's trees, concatenated.
struct FlatForest {
  std::vector<int32_t> node_start = {0}, leaf_start_start = {0}, leaf_sample_start = {0};
  std::vector<int32_t> feature, child, leaf_start, leaf_sample;
  std::vector<float> threshold;
};

template <class T>
void append(std::vector<T>& to, const std::vector<T>& from, std::vector<int32_t>* start = nullptr) {
  to.insert(to.end(), from.begin(), from.end());
  if (start) start->push_back(static_cast<int32_t>(to.size()));
}

FlatForest flat(const RegressionForest& forest) {
  FlatForest result;
  for (const RegressionTree& tree : forest.trees) {
    append(result.feature, tree.feature, &result.node_start);
    append(result.child, tree.child), append(result.threshold, tree.threshold);
    append(result.leaf_start, tree.leaf_start, &result.leaf_start_start);
    append(result.leaf_sample, tree.leaf_samples, &result.leaf_sample_start);
  }
  return result;
}

std::shared_ptr<void> upload_forest(const Backend& backend, const LandmarkModel& model, int32_t components) {
  const FlatForest forest = flat(model.forests[0]);
  const LeafVoteShape shape = leaf_vote_shape(model);
  ComputeForest data{};
  data.trees = static_cast<int32_t>(model.forests[0].trees.size());
  data.landmarks = static_cast<int32_t>(model.targets.cols());
  data.components = components;
  data.node_start = forest.node_start.data(), data.leaf_start_start = forest.leaf_start_start.data();
  data.leaf_sample_start = forest.leaf_sample_start.data();
  data.feature = forest.feature.data(), data.child = forest.child.data();
  data.threshold = forest.threshold.data();
  data.leaf_start = forest.leaf_start.data(), data.leaf_sample = forest.leaf_sample.data();
  data.training_samples = model.targets.rows(), data.target = model.targets.data();
  data.bins = shape.bins, data.target_to_bin = shape.target_to_bin, data.bin_width = shape.bin_width;
  data.kernel_half = static_cast<int32_t>(shape.kernel.size()), data.kernel = shape.kernel.data();
  data.decay = shape.decay.data();
  void* made = nullptr;
  backend.call(backend.table().forest_create, backend.device(), &data, &made);
  return {made, backend.table().forest_destroy};
}

// Detects a device that fails silently.
template <class T>
void require_numbers(const T* values, int64_t count) {
  if (Eigen::Map<const Eigen::Array<T, Eigen::Dynamic, 1>>(values, count).allFinite()) return;
  throw BackendFailure({0, "the device returned invalid results"});
}

}  // namespace

DeviceSurface::DeviceSurface(const Backend& backend, const MatrixX3& positions, const Operators& operators,
                             double heat_time, bool keep_negative_heat)
    : backend_(backend), vertices_(static_cast<int32_t>(operators.L.rows())) {
  RowMatrixf coefficient(operators.triangles.rows(), 4);
  coefficient << operators.half_cotangent.cast<float>(), operators.face_area.cast<float>();
  ComputeSurface data{};
  data.vertices = vertices_, data.faces = static_cast<int32_t>(operators.triangles.rows());
  data.column_start = operators.L.outerIndexPtr(), data.row = operators.L.innerIndexPtr();
  data.value = operators.L.valuePtr(), data.mass = operators.mass.data();
  data.position = positions.data();
  data.corner = operators.triangles.data(), data.coefficient = coefficient.data();
  data.area = operators.area, data.heat_time = heat_time, data.keep_negative_heat = keep_negative_heat;
  backend_.call(backend_.table().surface_create, backend_.device(), &data, &surface_);
}

void DeviceSurface::close() {
  const std::scoped_lock lock(mutex_);
  if (surface_) backend_.table().surface_destroy(surface_);
  surface_ = nullptr;
}

bool DeviceSurface::is_open() const {
  const std::scoped_lock lock(mutex_);
  return surface_ != nullptr;
}

Eigenbasis DeviceSurface::spectrum(const EigenParams& params) const {
  const std::scoped_lock lock(mutex_);
  Eigenbasis basis{Vector(params.count), {}};
  RowMatrix phi(vertices_, params.count);
  backend_.call(backend_.table().spectrum, surface_, params.count, params.tolerance, basis.lambda.data(),
                phi.data());
  require_numbers(basis.lambda.data(), basis.lambda.size()), require_numbers(phi.data(), phi.size());
  basis.Phi = phi;
  for (int32_t j = 0; j < params.count; ++j) fix_sign(basis.Phi.col(j));
  return basis;
}

RowMatrixf DeviceSurface::si_hks(const Vector& lambda, double area, std::span<const int32_t> vertices) const {
  const SiHksMaps maps = si_hks_maps(lambda, area);
  const ComputeSignature signature{static_cast<int32_t>(maps.decay.rows()),
                                   maps.frequencies,
                                   si_hks_dimension,
                                   maps.scale,
                                   maps.decay.data(),
                                   maps.fourier.data(),
                                   maps.spline.data()};
  return signatures(signature, si_hks_dimension, vertices);
}

RowMatrixf DeviceSurface::spectral_signatures(const Matrix& weights, double scale,
                                              std::span<const int32_t> vertices) const {
  ComputeSignature signature{};  // column-major here is the transposed row-major there
  signature.times = static_cast<int32_t>(weights.cols()), signature.scale = scale;
  signature.decay = weights.data();
  return signatures(signature, signature.times, vertices);
}

RowMatrixf DeviceSurface::signatures(const ComputeSignature& signature, int32_t components,
                                     std::span<const int32_t> vertices) const {
  const std::scoped_lock lock(mutex_);
  RowMatrixf result(vertices.size(), components);
  backend_.call(backend_.table().signatures, surface_, &signature, vertices.data(),
                static_cast<int32_t>(vertices.size()), result.data());
  require_numbers(result.data(), result.size());
  return result;
}

void DeviceSurface::distances(std::span<const Distance::Source> sources, float* out) const {
  const std::scoped_lock lock(mutex_);
  std::vector<ComputeSource> data;
  for (const auto& source : sources) {
    ComputeSource to{};
    std::copy_n(source.vertex, 3, to.vertex), std::copy_n(source.weight, 3, to.weight);
    to.corner_distance = source.corner_distance;
    data.push_back(to);
  }
  backend_.call(backend_.table().distances, surface_, data.data(), static_cast<int32_t>(data.size()), out);
  require_numbers(out, int64_t{vertices_} * static_cast<int64_t>(sources.size()));
}

RowMatrixf DeviceSurface::votes(const LandmarkModel& model, std::span<const int32_t> samples,
                                const Eigen::Ref<const RowMatrixf>& descriptors) const {
  const std::scoped_lock lock(mutex_);
  const auto components = static_cast<int32_t>(descriptors.cols());
  const auto forest =
      backend_.kept(model.weak_from_this(), [&] { return upload_forest(backend_, model, components); });
  RowMatrixf result(vertices_, VoteTables::padded(static_cast<int32_t>(model.targets.cols())));
  backend_.call(backend_.table().votes, surface_, forest.get(), samples.data(), descriptors.data(),
                static_cast<int32_t>(samples.size()), static_cast<int32_t>(result.cols()), result.data());
  require_numbers(result.data(), result.size());
  return result;
}

std::vector<std::vector<int32_t>> DeviceSurface::peaks(int32_t landmarks, int32_t count,
                                                       double radius) const {
  const std::scoped_lock lock(mutex_);
  std::vector<int32_t> found(static_cast<size_t>(landmarks) * static_cast<size_t>(count));
  backend_.call(backend_.table().peaks, surface_, count, radius, found.data());
  std::vector<std::vector<int32_t>> result(landmarks);
  for (size_t i = 0; i < found.size(); ++i) {
    if (found[i] < -1 || found[i] >= vertices_)
      throw BackendFailure({0, "the device returned invalid results"});
    if (found[i] >= 0) result[i / static_cast<size_t>(count)].push_back(found[i]);
  }
  return result;
}

RowMatrixf DeviceSurface::isoline_votes(std::span<const int32_t> samples, const RowMatrixf& radii, double mu,
                                        const Edges& edges, float neighbourhood) const {
  const std::scoped_lock lock(mutex_);
  const RowMatrixf weights = (-static_cast<float>(mu) * radii.array().square()).exp();
  std::vector<int32_t> start(static_cast<size_t>(vertices_) + 1),
      neighbour(static_cast<size_t>(edges.size()));
  for (Eigen::Index i = 0; i < edges.size(); ++i) ++start[static_cast<size_t>(edges.data()[i]) + 1];
  for (size_t v = 1; v < start.size(); ++v) start[v] += start[v - 1];
  std::vector<int32_t> next(start.begin(), start.end() - 1);
  for (Eigen::Index e = 0; e < edges.rows(); ++e)
    for (int side = 0; side < 2; ++side) neighbour[next[edges(e, side)]++] = edges(e, 1 - side);
  ComputeIsolines data{};
  data.samples = static_cast<int32_t>(samples.size()), data.columns = static_cast<int32_t>(radii.cols());
  data.vertex = samples.data(), data.radius = radii.data(), data.weight = weights.data();
  data.neighbour_start = start.data(), data.neighbour = neighbour.data();
  data.neighbourhood = neighbourhood;
  RowMatrixf result(vertices_, radii.cols());
  backend_.call(backend_.table().isoline_votes, surface_, &data, result.data());
  require_numbers(result.data(), result.size());
  return result;
}

FunctionalMap DeviceSurface::zoom_out(const SpectralSamples& from, const SpectralTargets& to,
                                      PlacesBetween initial, const MapParams& params) const {
  const std::scoped_lock lock(mutex_);
  constexpr int32_t tile = 4;  // of the CPU's kernels: rows are in groups of four
  const auto points = static_cast<int32_t>(from.Phi.rows());
  const auto most = static_cast<int32_t>(
      std::min({Eigen::Index{params.last}, from.Phi.cols(), to.Phi.cols()}) / tile * tile);
  const RowMatrixf place = from.Phi.leftCols(most);
  const RowMatrixf weighted = from.weight.asDiagonal() * place;
  const Eigen::LLT<Eigen::MatrixXf> gram(place.transpose() * weighted);
  const Eigen::MatrixXf whitening = gram.matrixL().solve(Eigen::MatrixXf::Identity(most, most));
  FunctionalMap map{Eigen::MatrixXf(most, most), std::vector<int32_t>(points), std::move(initial)};
  ComputeMap data{};
  data.eigenfunctions = to.Phi.data(), data.eigenpairs = static_cast<int32_t>(to.Phi.cols());
  data.points = points, data.most = most;
  data.place = place.data(), data.weighted = weighted.data(), data.whitening = whitening.data();
  data.spread = to.spread.data(), data.spread_count = static_cast<int32_t>(to.spread.size());
  data.first = params.first, data.step = params.step;
  data.exact_from = params.exact_from < points ? params.exact_from / tile * tile : points;
  std::vector<double> error(2 * static_cast<size_t>(points));
  backend_.call(backend_.table().zoom_out, surface_, &data, map.places.vertex.data(),
                map.places.weight.data(), map.C.data(), error.data());
  require_numbers(map.C.data(), map.C.size()), require_numbers(error.data(), 2 * int64_t{points});
  require_numbers(map.places.weight.data(), static_cast<int64_t>(map.places.weight.size()));
  for (const int32_t vertex : map.places.vertex)
    if (vertex < 0 || vertex >= vertices_) throw BackendFailure({0, "the device returned invalid results"});
  for (size_t p = 0; p < map.image.size(); ++p) map.image[p] = map.places.vertex[p * PlacesBetween::vertices];
  double away = 0, size = 0;
  for (size_t p = 0; p < map.image.size(); ++p)
    away += from.weight[p] * error[2 * p], size += from.weight[p] * error[2 * p + 1];
  map.residual = static_cast<float>(std::sqrt(away / size));
  return map;
}

std::vector<ComputeStage> DeviceSurface::stages() const {
  const std::scoped_lock lock(mutex_);
  std::vector<ComputeStage> stages(64);
  stages.resize(static_cast<size_t>(backend_.table().stages(surface_, stages.data(), 64)));
  return stages;
}

DeviceDistance::DeviceDistance(std::shared_ptr<const PreparedMesh> mesh, const Operators& operators,
                               bool keep_negative_heat, const Backend& backend)
    : Distance(mesh->surface),
      mesh_(std::move(mesh)),
      operators_(operators),
      keep_negative_heat_(keep_negative_heat) {
  const HeatTime time = heat_time(mesh_->surface, operators_);
  distance_bound_ = time.distance_bound, warning_ = time.warning();
  surface_ = std::make_shared<DeviceSurface>(backend, mesh_->surface.positions, operators_, time.t,
                                             keep_negative_heat);
}

void DeviceDistance::solve_block(std::span<const Source> sources, float* out,
                                 const Execution& execution) const {
  if (surface_->is_open()) {
    Source padded[lanes];  // unused lanes repeat the last
    for (size_t j = 0; j < lanes; ++j) padded[j] = sources[std::min(j, sources.size() - 1)];
    return surface_->distances(padded, out);
  }
  const auto& on_cpu = on_cpu_.get([&] {
    return std::make_unique<const HeatMethod>(mesh_->surface, operators_, execution, keep_negative_heat_);
  });
  on_cpu->solve_block(sources, out, execution);
}

}  // namespace focal
