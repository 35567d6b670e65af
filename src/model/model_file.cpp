// Serialises a model. Every section has a function that writes it and one that reads it.
#include "model/model_file.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/archive.h"
#include "base/error.h"
#include "base/utf8.h"
#include "descriptors/descriptor.h"
#include "model/feature_layout.h"
#include "model/forest_file.h"
#include "model/method_section.h"
#include "model/sections.h"

namespace focal {
namespace {

constexpr ArchiveKind kind{"FOCALMDL", "model", 1, 4};
constexpr int32_t landmark_limit = 4096, name_limit = 4096, joint_limit = 4096;
constexpr int32_t most = std::numeric_limits<int32_t>::max();
constexpr float any_number = 1e9F;  // for learned coefficients: finite, and sums of a few do not overflow
constexpr float longest = 1000;     // distance in units of sqrt(area)
constexpr float min_spread = 1e-6F;

std::string read_name(ByteReader& in, const char* what) {
  std::string name = in.text(what);
  if (name.empty() || name.size() > name_limit || !is_utf8(name) || name.find('\0') != std::string::npos)
    in.fail(std::string("a ") + what + " is not proper text");
  return name;
}

std::span<const float> numbers(const RowMatrixf& matrix) {
  return {matrix.data(), static_cast<size_t>(matrix.size())};
}

// --- INFO: names, parameters, what it was trained on

void write_info(const LandmarkModel& model, ByteWriter& out) {
  const TrainParams& params = model.params;
  out.i32(static_cast<int32_t>(params.preset));
  out.i32(params.eigenpair_count);
  out.i32(params.tree_count);
  out.i32(params.min_leaf_samples);
  out.i32(params.components_per_split);
  out.f64(params.sampling_rate);
  out.i32(params.max_samples_per_shape);
  out.i32(params.proxy_vertices);
  out.u64(params.seed);
  out.i32(model.shape_count);
  out.i32(model.mean_vertex_count);
  out.u32(static_cast<uint32_t>(model.landmark_names.size()));
  for (const std::string& name : model.landmark_names) out.text(name);
}

void read_info(ByteReader in, LandmarkModel& model) {
  TrainParams& params = model.params;
  params.preset = static_cast<Preset>(in.i32("preset", 0, 1));
  params.eigenpair_count = in.i32("eigenpair count", 1, most);
  params.tree_count = in.i32("tree count", 1, most);
  params.min_leaf_samples = in.i32("smallest leaf", 1, most);
  params.components_per_split = in.i32("components a split", 1, most);
  params.sampling_rate = in.f64("sampling rate", 0, 1);
  params.max_samples_per_shape = in.i32("samples a shape", 1, most);
  params.proxy_vertices = in.i32("proxy vertices", 0, most);
  params.seed = in.u64("seed");
  model.shape_count = in.i32("shape count", 1, most);
  model.mean_vertex_count = in.i32("mean vertex count", 1, most);
  const int32_t count = in.i32("landmark count", 1, landmark_limit);
  for (int32_t l = 0; l < count; ++l) {
    const std::string name = read_name(in, "landmark name");
    const auto& names = model.landmark_names;
    if (std::find(names.begin(), names.end(), name) != names.end()) in.fail("a landmark name is there twice");
    model.landmark_names.push_back(name);
  }
  in.expect_end();
}

// --- TRGT: distances from the training samples to the landmarks

void write_targets(const LandmarkModel& model, ByteWriter& out) {
  out.f32(model.reach);
  out.u32(static_cast<uint32_t>(model.targets.rows()));
  for (Eigen::Index i = 0; i < model.targets.size(); ++i) out.u16(model.targets.data()[i]);
}

void read_targets(ByteReader in, LandmarkModel& model) {
  const auto landmarks = static_cast<Eigen::Index>(model.landmark_names.size());
  const bool default_preset = model.params.preset == Preset::default_preset;
  model.reach = in.f32("reach", 1e-6F, longest);
  const int32_t samples = in.count("sample count", uint64_t(landmarks) * 16, default_preset ? 1 : 0);
  model.targets.resize(samples, samples > 0 ? landmarks : 0);
  for (Eigen::Index i = 0; i < model.targets.size(); ++i) model.targets.data()[i] = in.u16("target");
  in.expect_end();
}

// --- FRST

void write_forests(const LandmarkModel& model, ByteWriter& out) {
  out.u32(static_cast<uint32_t>(model.forests.size()));
  for (const RegressionForest& forest : model.forests)
    write_forest(forest, static_cast<int32_t>(model.targets.rows()), out);
}

void read_forests(ByteReader in, LandmarkModel& model) {
  const bool default_preset = model.params.preset == Preset::default_preset;
  const auto wanted = default_preset ? 1 : static_cast<int32_t>(model.landmark_names.size());
  const int32_t count = in.i32("forest count", wanted, wanted);
  const LeafKind leaves = default_preset ? LeafKind::samples : LeafKind::means;
  const auto samples = static_cast<int32_t>(model.targets.rows());
  for (int32_t f = 0; f < count; ++f)
    model.forests.push_back(
        read_forest(in, leaves, model.params.tree_count, samples, feature_count(model.params)));
  in.expect_end();
}

// All landmarks of the model, or none with preset paper.
int32_t read_landmark_count(ByteReader& in, const LandmarkModel& model) {
  const auto all = static_cast<int32_t>(model.landmark_names.size());
  const int32_t none_or_all = model.params.preset == Preset::default_preset ? all : 0;
  const int32_t L = in.i32("landmark count", none_or_all, all);
  if (L != 0 && L != all) in.fail("the landmark count is not the model's");
  return L;
}

// --- CNST: statistics of the landmarks' distances and chirality; empty with preset paper

void write_constellation(const LandmarkModel& model, ByteWriter& out) {
  const ConstellationStatistics& constellation = model.constellation;
  out.u32(static_cast<uint32_t>(constellation.landmarks));
  out.f32s(numbers(constellation.distance_mean));
  out.f32s(numbers(constellation.distance_sd));
  out.f32s(constellation.chirality_mean);
  out.f32s(constellation.chirality_sd);
}

void read_constellation(ByteReader in, LandmarkModel& model) {
  const int32_t L = read_landmark_count(in, model);
  ConstellationStatistics& constellation = model.constellation;
  constellation.landmarks = L;
  const auto matrix = [&](const char* what, float least, float largest) -> RowMatrixf {
    const std::vector<float> values = in.f32s(what, static_cast<size_t>(L) * L, least, largest);
    return Eigen::Map<const RowMatrixf>(values.data(), L, L);
  };
  constellation.distance_mean = matrix("mean distance", 0, longest);
  constellation.distance_sd = matrix("distance deviation", min_spread, any_number);
  const size_t triples = static_cast<size_t>(L) * L * L;
  constellation.chirality_mean = in.f32s("mean chirality", triples, -2, 2);
  constellation.chirality_sd = in.f32s("chirality deviation", triples, min_spread, any_number);
  in.expect_end();
}

// --- ATLS: the training shapes as stored for maps; none with preset paper

constexpr int32_t point_limit = 1 << 16, eigenfunction_limit = 2000;

void write_exemplar_maps(const LandmarkModel& model, ByteWriter& out) {
  out.u32(static_cast<uint32_t>(model.exemplars.size()));
  for (const Exemplar& shape : model.exemplars) {
    const RowMatrixf& Phi = shape.samples.Phi;
    out.u32(static_cast<uint32_t>(shape.distances.rows()));
    out.u32(static_cast<uint32_t>(Phi.cols()));
    for (const char marked : shape.marked) out.u8(static_cast<uint8_t>(marked));
    out.f32(shape.step);
    for (Eigen::Index i = 0; i < Phi.size(); ++i)
      out.u16(static_cast<uint16_t>(std::lround(Phi.data()[i] / shape.step) + eigenfunction_zero));
    out.f32s({shape.samples.weight.data(), static_cast<size_t>(shape.distances.rows())});
    for (Eigen::Index i = 0; i < shape.distances.size(); ++i) out.u16(shape.distances.data()[i]);
  }
}

Exemplar read_exemplar(ByteReader& in, int32_t L) {
  Exemplar shape;
  const int32_t points = in.count("point count", 32 + static_cast<uint64_t>(L) * 16, 4, point_limit);
  const int32_t k =
      in.count("eigenfunction count", static_cast<uint64_t>(points) * 16, 4, eigenfunction_limit);
  for (int32_t l = 0; l < L; ++l) shape.marked.push_back(in.u8("marked") != 0);
  shape.step = in.f32("step", 1e-12F, any_number);
  shape.samples.Phi.resize(points + L, k);
  for (Eigen::Index i = 0; i < shape.samples.Phi.size(); ++i)
    shape.samples.Phi.data()[i] =
        static_cast<float>(in.u16("eigenfunction") - eigenfunction_zero) * shape.step;
  shape.samples.weight = Eigen::VectorXf::Zero(points + L);
  const std::vector<float> weight = in.f32s("weight", static_cast<size_t>(points), 0, longest);
  std::copy(weight.begin(), weight.end(), shape.samples.weight.data());
  shape.distances.resize(points, L);
  for (Eigen::Index i = 0; i < shape.distances.size(); ++i) shape.distances.data()[i] = in.u16("distance");
  return shape;
}

void read_exemplar_maps(ByteReader in, LandmarkModel& model) {
  const auto L = static_cast<int32_t>(model.landmark_names.size());
  const int32_t count = in.i32("shape count", 0, model.shape_count);
  for (int32_t s = 0; s < count; ++s) model.exemplars.push_back(read_exemplar(in, L));
  in.expect_end();
}

// --- CALB: confidence

void write_calibration(const LandmarkModel& model, ByteWriter& out) {
  const Calibration& calibration = model.calibration;
  out.u32(static_cast<uint32_t>(calibration.typical_vote.size()));
  out.f32s(calibration.typical_vote);
  out.u32(Calibration::feature_count);
  out.f32s(calibration.weight);
  out.f32s(calibration.absent_weight);
  out.f32s(calibration.typical_length);
  out.f32(calibration.typical_residual);
  out.f32(calibration.near_error);
  out.f32(calibration.far_error);
  out.f32(calibration.fit_centre);
  out.f32(calibration.fit_scale);
}

void read_calibration(ByteReader in, LandmarkModel& model) {
  const int32_t L = read_landmark_count(in, model);
  Calibration& calibration = model.calibration;
  calibration.typical_vote = in.f32s("typical vote", static_cast<size_t>(L), 0, any_number);
  in.i32("feature count", Calibration::feature_count, Calibration::feature_count);
  for (float& weight : calibration.weight) weight = in.f32("weight", -any_number, any_number);
  for (float& weight : calibration.absent_weight) weight = in.f32("weight", -any_number, any_number);
  for (float& length : calibration.typical_length) length = in.f32("typical length", -any_number, any_number);
  calibration.typical_residual = in.f32("typical residual", 0, any_number);
  calibration.near_error = in.f32("near error", 0, longest);
  calibration.far_error = in.f32("far error", 0, longest);
  calibration.fit_centre = in.f32("fit centre", -any_number, any_number);
  calibration.fit_scale = in.f32("fit scale", -any_number, any_number);
  in.expect_end();
}

// --- SKEL: the skeleton of rigged training shapes, and the positions of points and joints of each exemplar

void write_matrix(const Matrix4& matrix, ByteWriter& out) {
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 4; ++c) out.f32(static_cast<float>(matrix(r, c)));
}

void write_skeleton(const LandmarkModel& model, ByteWriter& out) {
  out.u32(static_cast<uint32_t>(model.skeleton.size()));
  for (const SkeletonJoint& joint : model.skeleton) out.text(joint.name), out.i32(joint.parent);
  for (const Exemplar& shape : model.exemplars) {
    out.u8(shape.rig.has_value());
    if (!shape.rig) continue;
    for (Eigen::Index i = 0; i < shape.positions.size(); ++i)
      out.f32(static_cast<float>(shape.positions.data()[i]));
    for (const auto& influences : shape.rig->influences)
      for (const Influence& one : influences) out.u16(static_cast<uint16_t>(one.joint)), out.f32(one.weight);
    for (size_t j = 0; j < model.skeleton.size(); ++j) {
      out.u8(shape.rig->bind[j].has_value());
      if (shape.rig->bind[j]) write_matrix(*shape.rig->bind[j], out);
      for (const double x : shape.rig->tip[j]) out.f32(static_cast<float>(x));
    }
  }
}

Vector3 read_place(ByteReader& in) {
  const double x = in.f32("place", -longest, longest), y = in.f32("place", -longest, longest);
  return {x, y, in.f32("place", -longest, longest)};
}

Matrix4 read_matrix(ByteReader& in) {
  Matrix4 matrix = Matrix4::Identity();
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 4; ++c) matrix(r, c) = in.f32("bind matrix", -longest, longest);
  return matrix;
}

ShapeRig read_shape_rig(ByteReader& in, size_t points, int32_t joints) {
  ShapeRig rig;
  for (size_t p = 0; p < points; ++p) {
    VertexInfluences influences;
    for (Influence& one : influences) {
      one.joint = in.u16("joint");
      if (one.joint >= joints) in.fail("a joint is not there");
      one.weight = in.f32("weight", 0, 1);
    }
    rig.influences.push_back(influences);
  }
  for (int32_t j = 0; j < joints; ++j) {
    rig.bind.emplace_back();
    if (in.u8("has joint")) rig.bind.back() = read_matrix(in);
    rig.tip.push_back(read_place(in));
  }
  return rig;
}

void read_skeleton(ByteReader in, LandmarkModel& model) {
  const int32_t joints = in.i32("joint count", 1, joint_limit);
  for (int32_t j = 0; j < joints; ++j) {
    std::string name = read_name(in, "joint name");
    model.skeleton.push_back({std::move(name), in.i32("parent", -1, j - 1)});
  }
  for (Exemplar& shape : model.exemplars) {
    if (!in.u8("has rig")) continue;
    shape.positions.resize(shape.distances.rows(), 3);
    for (Eigen::Index i = 0; i < shape.positions.rows(); ++i)
      shape.positions.row(i) = read_place(in).transpose();
    shape.rig = read_shape_rig(in, static_cast<size_t>(shape.distances.rows()), joints);
  }
  in.expect_end();
}

// --- TMPL: the skeleton template over marked landmarks, as JSON; parsed when a skeleton is created

void write_template(const LandmarkModel& model, ByteWriter& out) { out.text(model.skeleton_template); }

void read_template(ByteReader in, LandmarkModel& model) {
  model.skeleton_template = in.text("skeleton template");
  if (model.skeleton_template.empty() || model.skeleton_template.size() > longest_template ||
      !model.skeleton.empty())
    in.fail("the skeleton template is empty, too long, or one too many");
  in.expect_end();
}

// Order of reading: a section comes after the sections that it is checked against.
struct Section {
  const char* name;
  void (*write)(const LandmarkModel&, ByteWriter&);
  void (*read)(ByteReader, LandmarkModel&);
};
constexpr Section sections[] = {
    {"INFO", write_info, read_info},
    {"FEAT", write_features, read_features},
    {"TRGT", write_targets, read_targets},
    {"FRST", write_forests, read_forests},
    {"CNST", write_constellation, read_constellation},
    {"ATLS", write_exemplar_maps, read_exemplar_maps},
    {"CALB", write_calibration, read_calibration},
    {"SKEL", write_skeleton, read_skeleton},
    {"EXMP", write_exemplars, read_exemplars},
    {"DETL", write_details, read_details},
    {"TMPL", write_template, read_template},
};

// Models of marked shapes have no skeleton; those of preset paper and of old versions have no features and
// exemplars. Their files lack these sections.
bool is_written(const Section& section, const LandmarkModel& model) {
  if (section.write == write_skeleton) return !model.skeleton.empty();
  if (section.write == write_features) return model.params.bulge || model.params.oriented;
  if (section.write == write_details) return !model.details.empty();
  if (section.write == write_template) return !model.skeleton_template.empty();
  return section.write != write_exemplars || !model.sample_shape.empty();
}

bool may_lack(const Section& section) {
  return section.read == read_skeleton || section.read == read_features || section.read == read_exemplars ||
         section.read == read_details || section.read == read_template;
}

}  // namespace

std::vector<std::byte> serialise(const LandmarkModel& model) {
  std::vector<ArchiveSection> written;
  for (const Section& section : sections) {
    if (!is_written(section, model)) continue;
    ByteWriter out;
    section.write(model, out);
    written.push_back({section.name, out.take()});
  }
  if (const Method method{model.params.descriptor, model.params.distance}; !method.is_first())
    written.push_back({method_section, write_method(method)});
  return write_archive(kind, written);
}

LandmarkModel parse_model(std::span<const std::byte> file, PartsOfModel parts) {
  const Archive archive(kind, file);
  if (parts == PartsOfModel::refused && archive.has("DETL"))
    throw Error(Status::invalid_file, "a part of the model has parts of its own", "train the model again");
  LandmarkModel model;
  const Method method = read_method(archive);
  model.params.bulge = model.params.oriented = false;  // unless the file has them
  model.params.descriptor = method.descriptor, model.params.distance = method.distance;
  for (const Section& section : sections)
    if (!may_lack(section) || archive.has(section.name)) section.read(archive.section(section.name), model);
  return model;
}

}  // namespace focal
