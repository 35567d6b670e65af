// Every bound that a model file is checked against, exactly: the last value that is allowed is taken, the next one is refused by the
// check that is meant to.
#include <doctest/doctest.h>

#include <functional>
#include <limits>

#include "base/error.h"
#include "base/signed_archive.h"
#include "model/model_file.h"
#include "model/small_model.h"

using namespace focal;
using focal_test::patched, focal_test::small_model, focal_test::small_model_of_exemplars;

namespace {

std::string error_of(std::span<const std::byte> file) {
  try {
    parse_model(file);
    return "";
  } catch (const Error& error) {
    CHECK(error.status() == Status::invalid_file);
    return error.what();
  }
}
std::string error_of(const LandmarkModel& model) { return error_of(serialise(model)); }

void check_error(const std::string& error, const std::string& part) {
  CAPTURE(error);
  CHECK(error.find(part) != std::string::npos);
}

// A number of the model: those within its bounds are not what is refused, those outside are, as `what`.
void check_bounds(const std::string& what, const LandmarkModel& model,
                  const std::function<void(LandmarkModel&, double)>& set, const std::vector<double>& within,
                  const std::vector<double>& outside) {
  CAPTURE(what);
  const auto error_with = [&](double value) {
    LandmarkModel changed = model;
    set(changed, value);
    return error_of(changed);
  };
  for (const double value : within) {
    CAPTURE(value);
    CHECK(error_with(value).find(what) == std::string::npos);
  }
  for (const double value : outside) {
    CAPTURE(value);
    check_error(error_with(value), what);
  }
}

// Two joints, and how they move the points of the first shape.
LandmarkModel rigged_model() {
  LandmarkModel model = small_model(Preset::default_preset);
  model.skeleton = {{"root", -1}, {"arm", 0}};
  Exemplar& shape = model.exemplars[0];
  shape.positions = MatrixX3::Constant(shape.distances.rows(), 3, 0.5);
  shape.rig.emplace();
  shape.rig->bind = {Matrix4(2 * Matrix4::Identity()), std::nullopt};
  (*shape.rig->bind[0])(3, 3) = 1;
  shape.rig->tip = {{1, 2, 3}, {-1, 0, 0.25}};
  for (Eigen::Index p = 0; p < shape.distances.rows(); ++p)
    shape.rig->influences.push_back({{{1, 0.75F}, {0, 0.25F}}});
  return model;
}

void resize(Exemplar& shape, Eigen::Index points, Eigen::Index eigenfunctions) {
  const Eigen::Index landmarks = shape.distances.cols();
  shape.samples.Phi = RowMatrixf::Constant(points + landmarks, eigenfunctions, shape.step);
  shape.samples.weight = Eigen::VectorXf::Constant(points + landmarks, 0.1F);
  shape.distances = TargetMatrix::Constant(points, landmarks, 7);
}

}  // namespace

TEST_CASE("each number of a model's parameters has its bounds") {
  const LandmarkModel model = small_model(Preset::default_preset);
  const auto param = [&](const char* what, auto TrainParams::*member, std::vector<double> within,
                         std::vector<double> outside) {
    check_bounds(
        std::string("INFO: ") + what, model,
        [member](LandmarkModel& m, double value) {
          m.params.*member = static_cast<std::remove_reference_t<decltype(m.params.*member)>>(value);
        },
        within, outside);
  };
  param("preset", &TrainParams::preset, {0, 1}, {-1, 2});
  param("eigenpair count", &TrainParams::eigenpair_count, {1}, {0});
  param("tree count", &TrainParams::tree_count, {1}, {0});
  param("smallest leaf", &TrainParams::min_leaf_samples, {1}, {0});
  param("components a split", &TrainParams::components_per_split, {1}, {0});
  param("sampling rate", &TrainParams::sampling_rate, {0, 1}, {-0.5, 1.5});
  param("samples a shape", &TrainParams::max_samples_per_shape, {1}, {0});
  param("proxy vertices", &TrainParams::proxy_vertices, {0}, {-1});
  const auto number = [&](const char* what, int32_t LandmarkModel::*member) {
    check_bounds(what, model,
                 [member](LandmarkModel& m, double value) { m.*member = static_cast<int32_t>(value); }, {1},
                 {0});
  };
  number("INFO: shape count", &LandmarkModel::shape_count);
  number("INFO: mean vertex count", &LandmarkModel::mean_vertex_count);
  check_bounds("INFO: landmark count", model,
               [](LandmarkModel& m, double count) {
                 m.landmark_names.clear();
                 for (int i = 0; i < count; ++i) m.landmark_names.push_back(std::to_string(i));
               },
               {1, 4096}, {0, 4097});
}

TEST_CASE("names are text in UTF-8 of 1 to 4096 bytes") {
  const auto is_read = [](const std::string& name) {
    LandmarkModel model = small_model(Preset::default_preset);
    model.landmark_names[1] = name;
    const std::string error = error_of(model);
    if (!error.empty()) check_error(error, "a landmark name is not proper text");
    return error.empty();
  };
  CHECK(is_read(std::string(4096, 'x')));
  CHECK_FALSE(is_read(std::string(4097, 'x')));
  CHECK_FALSE(is_read(""));
  CHECK_FALSE(is_read(std::string("a\0b", 3)));
  // The first and last of each length, and on both sides of the surrogates (Unicode 15, table 3-7).
  for (const char* name : {"\x01", "\x7F", "\xC2\x80", "\xDF\xBF", "\xE0\xA0\x80", "\xED\x9F\xBF",
                           "\xEE\x80\x80", "\xEF\xBF\xBF", "\xF0\x90\x80\x80", "\xF4\x8F\xBF\xBF"}) {
    CAPTURE(std::string(name));
    CHECK(is_read(name));
  }
  for (const char* name :
       {"\x80", "\xBF", "\xC1\xBF", "\xC3", "\xC3(", "\xC3\xC3", "\xE0\x9F\xBF", "\xE2\x82", "\xED\xA0\x80",
        "\xED\xBF\xBF", "\xF0\x8F\xBF\xBF", "\xF0\x90\x80", "\xF4\x90\x80\x80", "\xF5\x80\x80\x80", "\xFF"}) {
    CAPTURE(std::string(name));
    CHECK_FALSE(is_read(name));
  }
}

TEST_CASE("constellation and calibration keep to their ranges and to the model's landmarks") {
  const LandmarkModel model = small_model(Preset::default_preset);
  check_bounds(
      "CNST: mean chirality", model,
      [](LandmarkModel& m, double value) { m.constellation.chirality_mean[4] = static_cast<float>(value); },
      {-2, 2}, {-2.5, 2.5});
  check_bounds(
      "CALB: typical vote", model,
      [](LandmarkModel& m, double value) { m.calibration.typical_vote[1] = static_cast<float>(value); }, {0},
      {-0.5});
  const auto number = [&](const char* what, float Calibration::*member) {
    check_bounds(
        what, model,
        [member](LandmarkModel& m, double value) { m.calibration.*member = static_cast<float>(value); }, {0},
        {-0.5});
  };
  number("CALB: typical residual", &Calibration::typical_residual);
  number("CALB: near error", &Calibration::near_error);
  number("CALB: far error", &Calibration::far_error);
  LandmarkModel paper = small_model(Preset::paper);  // of three landmarks, with none here or with all
  paper.calibration.typical_vote = {0.5F};
  check_error(error_of(paper), "CALB: the landmark count is not the model's");
  paper = small_model(Preset::paper);
  paper.constellation.landmarks = 1;
  paper.constellation.distance_mean = paper.constellation.distance_sd = RowMatrixf::Constant(1, 1, 1);
  paper.constellation.chirality_mean = paper.constellation.chirality_sd = {1};
  check_error(error_of(paper), "CNST: the landmark count is not the model's");
}

TEST_CASE("shapes of the exemplars have as many points and eigenfunctions as maps need") {
  const LandmarkModel model = small_model(Preset::default_preset);
  check_bounds("ATLS: point count", model,
               [](LandmarkModel& m, double n) { resize(m.exemplars[1], static_cast<Eigen::Index>(n), 4); },
               {4, 65536}, {3, 65537});
  check_bounds("ATLS: eigenfunction count", model,
               [](LandmarkModel& m, double n) { resize(m.exemplars[1], 5, static_cast<Eigen::Index>(n)); },
               {4, 2000}, {3, 2001});
  check_bounds("ATLS: weight", model,
               [](LandmarkModel& m, double w) { m.exemplars[1].samples.weight[2] = static_cast<float>(w); },
               {0}, {-0.5});
  check_bounds("ATLS: shape count", model,
               [](LandmarkModel& m, double n) { m.shape_count = static_cast<int32_t>(n); }, {2}, {1});
  check_error(error_of(patched(serialise(model), "ATLS", 0, UINT32_MAX)), "ATLS: shape count");
}

TEST_CASE("a skeleton comes back from its bytes, and keeps to its bounds") {
  const LandmarkModel model = rigged_model();
  const LandmarkModel back = parse_model(serialise(model));
  REQUIRE(back.skeleton.size() == 2);
  CHECK(back.skeleton[1].name == "arm");
  CHECK(back.skeleton[1].parent == 0);
  CHECK_FALSE(back.exemplars[1].rig.has_value());
  const ShapeRig& rig = back.exemplars[0].rig.value();
  CHECK(back.exemplars[0].positions == model.exemplars[0].positions);
  CHECK(rig.bind == model.exemplars[0].rig->bind);
  CHECK(rig.tip == model.exemplars[0].rig->tip);
  CHECK(rig.influences[4][0].joint == 1);
  CHECK(rig.influences[4][1].weight == 0.25F);

  check_bounds("SKEL: parent", model,
               [](LandmarkModel& m, double value) { m.skeleton[0].parent = static_cast<int32_t>(value); },
               {-1}, {-2, 0});
  check_bounds("SKEL: weight", model,
               [](LandmarkModel& m, double value) {
                 m.exemplars[0].rig->influences[0][0].weight = static_cast<float>(value);
               },
               {0, 1}, {-0.5, 1.5});
  check_bounds("SKEL: a joint is not there", model,
               [](LandmarkModel& m, double value) {
                 m.exemplars[0].rig->influences[0][0].joint = static_cast<int32_t>(value);
               },
               {0, 1}, {2});
  LandmarkModel one = small_model(Preset::default_preset);
  one.skeleton = {{"root", -1}};
  CHECK(error_of(one) == "");
  check_error(error_of(patched(serialise(one), "SKEL", 0, 0)), "SKEL: joint count");
}

TEST_CASE(
    "a model of marked shapes keeps its skeleton template, of 1 byte to 1 MiB; one of rigged shapes has "
    "none") {
  LandmarkModel model = small_model(Preset::default_preset);
  for (const size_t size : {size_t{1}, size_t{1} << 20}) {
    model.skeleton_template.assign(size, 'x');
    CHECK(parse_model(serialise(model)).skeleton_template == model.skeleton_template);
  }
  model.skeleton_template += 'x';
  check_error(error_of(model), "TMPL: the skeleton template is empty, too long");
  model.skeleton_template = "x";
  check_error(error_of(patched(serialise(model), "TMPL", 0, 0)), "TMPL");
  LandmarkModel rigged = rigged_model();
  rigged.skeleton_template = "x";
  check_error(error_of(rigged), "TMPL");
}

TEST_CASE("features and exemplars keep to their bounds") {
  const LandmarkModel model = small_model_of_exemplars();
  CHECK(error_of(model) == "");
  check_bounds("EXMP: a sample is of no shape", model,
               [](LandmarkModel& m, double shape) { m.sample_shape[3] = static_cast<int32_t>(shape); },
               {0, 1}, {2, 65535});
  check_bounds("EXMP: distance of landmarks", model,
               [](LandmarkModel& m, double distance) {
                 m.exemplars[1].constellation.distance(0, 1) = static_cast<float>(distance);
               },
               {0, 1000}, {-0.5, 1001, std::numeric_limits<double>::quiet_NaN()});
  check_bounds("EXMP: the radii are not those of the method", model,
               [](LandmarkModel& m, double radii) {
                 m.exemplars[0].bulge = RowMatrixf::Zero(5, static_cast<Eigen::Index>(radii));
               },
               {0, 4}, {3, 5});
  // 6 samples, 2 shapes of 1 + 5 x 4 x 2 + 1 + 9 x 6 bytes: one fewer sample leaves bytes over.
  LandmarkModel fewer = model;
  fewer.sample_shape.pop_back();
  CHECK(error_of(fewer).find("EXMP: ") != std::string::npos);
  // Without samples nothing follows: the forests are left over.
  LandmarkModel no_samples = model;
  no_samples.facing_targets = RowMatrixf::Zero(0, 6);
  check_error(error_of(no_samples), "section FEAT: ");
  check_bounds("FEAT: leaf sample", model,
               [](LandmarkModel& m, double sample) {
                 m.rising.trees[0].leaf_samples[0] = static_cast<int32_t>(sample);
               },
               {6}, {7});
  check_bounds("FEAT: tree count", model,
               [](LandmarkModel& m, double trees) {
                 m.facing.trees.resize(static_cast<size_t>(trees)),
                     m.rising.trees.resize(static_cast<size_t>(trees));
               },
               {1}, {0});
  check_bounds(
      "FEAT: feature", model,
      [](LandmarkModel& m, double feature) { m.rising.trees[0].feature[2] = static_cast<int32_t>(feature); },
      {103}, {104});
  check_bounds(
      "FEAT: feature", model,
      [](LandmarkModel& m, double feature) { m.facing.trees[1].feature[2] = static_cast<int32_t>(feature); },
      {115}, {116});
  // The last component that a tree may test is that of the last feature.
  check_bounds("FRST: feature", model,
               [](LandmarkModel& m, double feature) {
                 m.forests[0].trees[1].feature[2] = static_cast<int32_t>(feature);
               },
               {121}, {122, 127});
  LandmarkModel plain = small_model(Preset::default_preset);
  plain.forests[0].trees[1].feature[2] = 96;
  check_error(error_of(plain), "FRST: feature");
  plain.params.bulge = true;
  CHECK(error_of(plain) == "");
}

TEST_CASE("trees are whole, breadth first, and their leaves hold samples") {
  const auto error_with = [](const RegressionTree& tree) {
    LandmarkModel model = small_model(Preset::default_preset);
    model.forests[0].trees[0] = tree;
    return error_of(model);
  };
  const RegressionTree single{{-1}, {0}, {0}, {0, 6}, {0, 1, 2, 3, 4, 5}, {}};
  CHECK(error_with(single) == "");
  RegressionTree tree = focal_test::small_tree(true, 0);
  CHECK(error_with(tree) == "");
  tree.child[2] = 1;
  CHECK_THROWS_WITH_AS(error_with(tree), "a tree is not in breadth-first order", Error);
  tree = focal_test::small_tree(true, 0);
  tree.feature.pop_back(), tree.threshold.pop_back(), tree.child.pop_back();  // an inner node with one child
  check_error(error_with(tree), "the leaves and nodes of a tree do not match");
  check_error(error_with({{-1, 3, -1}, {0, 0, 0}, {0, 1, 1}, {0, 3, 6}, {0, 1, 2, 3, 4, 5}, {}}),
              "a node comes before its parent");
  LandmarkModel paper = small_model(Preset::paper);
  paper.forests[0].trees[1] = {};
  check_error(error_of(paper), "FRST: node count");

  constexpr int32_t most = std::numeric_limits<int32_t>::max();
  const auto with_leaves = [&](std::vector<int32_t> start) {
    RegressionTree changed = focal_test::small_tree(true, 0);
    changed.leaf_start = std::move(start);
    return error_with(changed);
  };
  RegressionTree ones = focal_test::small_tree(true, 0);
  ones.leaf_start = {0, 1, 2, 3}, ones.leaf_samples.resize(3);
  CHECK(error_with(ones) == "");
  check_error(with_leaves({0, 0, 0, 0}), "FRST: largest leaf");
  check_error(with_leaves({0, 0, 3, 6}), "a leaf's size is out of range");
  check_error(with_leaves({0, most - 2, most - 1, most}), "leaf sample runs past the end");
  check_error(with_leaves({-2, most - 2, most - 1, most}), "a leaf's size is out of range");
}
