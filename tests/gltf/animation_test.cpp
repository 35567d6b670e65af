// Animations are sampled as the standard says, and those put into a file are read back the same.
#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "base/atomic_file.h"
#include "base/error.h"
#include "evaluation_data.h"
#include "gltf/document.h"
#include "gltf/gltf_builder.h"
#include "gltf/one_call.h"

using namespace focal;
using namespace focal_test;

namespace {

// A joint that turns by a right angle about z within two seconds, below a parent one metre up.
GltfBuilder turning(const std::string& interpolation, std::vector<float> times = {0, 2}) {
  GltfBuilder file = tetrahedron();
  const int parent = file.add_node({{"name", "up"}, {"translation", {0, 1, 0}}});
  const int joint = file.add_node({{"name", "arm"}}, parent);
  file.root["skins"] = json::array({{{"joints", {parent, joint}}}});
  file.root["nodes"][0]["skin"] = 0;
  const int input = file.add_accessor(times, "SCALAR");
  const float half = std::numbers::sqrt2_v<float> / 2;
  const int output = file.add_accessor(std::vector<float>{0, 0, 0, 1, 0, 0, half, half}, "SCALAR");
  file.root["accessors"][static_cast<size_t>(output)]["type"] = "VEC4";
  file.root["accessors"][static_cast<size_t>(output)]["count"] = 2;
  const int move = file.add_accessor(std::vector<float>{0, 0, 0, 4, 0, 0}, "VEC3");
  const int more = file.add_accessor(std::vector<float>{0, 1}, "SCALAR");
  file.root["animations"] =
      json::array({{{"name", "wave"},
                    {"samplers",
                     {{{"input", input}, {"output", output}, {"interpolation", interpolation}},
                      {{"input", more}, {"output", move}}}},
                    {"channels",
                     {{{"sampler", 0}, {"target", {{"node", joint}, {"path", "rotation"}}}},
                      {{"sampler", 1}, {"target", {{"node", joint}, {"path", "translation"}}}}}}}});
  return file;
}

double angle_of(const Matrix4& m) { return std::atan2(m(1, 0), m(0, 0)); }

}  // namespace

TEST_CASE("keys are kept as they are; between them linear or a step, after the last its value") {
  const auto linear = read_gltf_animations(turning("LINEAR").glb());
  REQUIRE(linear.clips.size() == 1);
  CHECK(linear.clips[0].name == "wave");
  REQUIRE(linear.clips[0].channels.size() == 2);
  CHECK(linear.clips[0].channels[0].keys.times == std::vector<double>{0, 2});
  CHECK(linear.clips[0].channels[1].keys.times == std::vector<double>{0, 1});
  const auto arm_at = [](const GltfAnimations& from, double time) {
    return world_transforms(from.tree, &from.clips[0], time)[2];
  };
  CHECK(angle_of(arm_at(linear, 1)) == doctest::Approx(std::numbers::pi / 4).epsilon(1e-5));
  CHECK(angle_of(arm_at(linear, 0.5)) == doctest::Approx(std::numbers::pi / 8).epsilon(1e-5));
  CHECK((arm_at(linear, 1).topRightCorner<3, 1>() - Vector3(4, 1, 0)).norm() < 1e-6);
  CHECK((arm_at(linear, 9).topRightCorner<3, 1>() - Vector3(4, 1, 0)).norm() < 1e-6);
  CHECK((world_transforms(linear.tree)[1].topRightCorner<3, 1>() - Vector3(0, 1, 0)).norm() < 1e-6);
  const auto step = read_gltf_animations(turning("STEP").glb());
  CHECK(step.clips[0].channels[0].keys.interpolation == Interpolation::step);
  CHECK(angle_of(arm_at(step, 1.99)) == doctest::Approx(0));
  CHECK(angle_of(arm_at(step, 2)) == doctest::Approx(std::numbers::pi / 2).epsilon(1e-5));
  CHECK(read_gltf_animations(tetrahedron().glb()).clips.empty());
}

TEST_CASE("keys that do not fit are refused") {
  CHECK_THROWS_AS(read_gltf_animations(turning("LINEAR", {0, 0}).glb()), Error);
  CHECK_THROWS_AS(read_gltf_animations(turning("LINEAR", {0}).glb()), Error);
  CHECK_THROWS_AS(read_gltf_animations(turning("LINEAR").glb(), {.decoded_bytes = 100}), Error);
  GltfBuilder file = turning("LINEAR");
  file.root["animations"][0]["samplers"][0]["output"] = 99;
  CHECK_THROWS_AS(read_gltf_animations(file.glb()), Error);
  file = turning("LINEAR");
  file.root["animations"][0]["channels"][0]["target"]["node"] = 99;
  CHECK_THROWS_AS(read_gltf_animations(file.glb()), Error);
  file = turning("LINEAR");
  file.root["animations"][0]["channels"][0]["sampler"] = -1;
  CHECK_THROWS_AS(read_gltf_animations(file.glb()), Error);
}

TEST_CASE("channels that move something else than a place are passed over") {
  const auto with_target = [](const json& target) {
    GltfBuilder file = turning("LINEAR");
    file.root["animations"][0]["channels"][1]["target"] = target;
    return read_gltf_animations(file.glb());
  };
  for (const json& target :
       {json{{"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", {}}}}}, json{{"node", 2}},
        json{{"node", 2}, {"path", 3}}, json{{"node", 2}, {"path", "weights"}}}) {
    CAPTURE(target.dump());
    const auto animations = with_target(target);
    REQUIRE(animations.clips.size() == 1);
    CHECK(animations.clips[0].channels.size() == 1);  // the turn alone
    REQUIRE(animations.warnings.size() == 1);         // and the other is named
    CHECK(animations.warnings[0].find("'wave'") != std::string::npos);
  }
  GltfBuilder file = turning("LINEAR");
  file.root["animations"][0]["channels"][1]["target"]["path"] = "scale";
  const auto scaled = read_gltf_animations(file.glb());
  CHECK(scaled.warnings.empty());
  const auto arm = world_transforms(scaled.tree, &scaled.clips[0], 1)[2];
  CHECK(arm.topLeftCorner<3, 3>().col(0).norm() == doctest::Approx(4));
}

TEST_CASE("cubic keys follow their tangents") {
  GltfBuilder file = turning("LINEAR");
  // Hermite: from 0 to 4 within 2 s, leaving with 1 a second and arriving with 3 a second.
  const int keys =
      file.add_accessor(std::vector<float>{9, 0, 0, 0, 0, 0, 1, 0, 0, 3, 0, 0, 4, 0, 0, 9, 0, 0}, "VEC3");
  const int times = file.add_accessor(std::vector<float>{0, 2}, "SCALAR");
  file.root["animations"][0]["samplers"][1] = {
      {"input", times}, {"output", keys}, {"interpolation", "CUBICSPLINE"}};
  const auto read = read_gltf_animations(file.glb());
  const Keys& cubic = read.clips.at(0).channels.at(1).keys;
  CHECK(cubic.times == std::vector<double>{0, 2});
  CHECK(cubic.values.rows() == 6);
  CHECK(cubic.at(1)(0) == doctest::Approx(0.5 * 4 + 2 * (1 - 3) / 8.0));
  CHECK(world_transforms(read.tree, &read.clips[0], 1)[2](0, 3) == doctest::Approx(cubic.at(1)(0)));
}

TEST_CASE("animations take no more memory than is allowed, exactly") {
  const auto bytes = turning("LINEAR").glb();  // 2 times, 2 x 4 numbers; 2 times, 2 x 3 numbers
  const int64_t needed = (2 + 8 + 2 + 6) * static_cast<int64_t>(sizeof(double));
  CHECK(read_gltf_animations(bytes, {.decoded_bytes = needed}).clips.size() == 1);
  CHECK_THROWS_AS(read_gltf_animations(bytes, {.decoded_bytes = needed - 1}), Error);
}

TEST_CASE("what is no animation is refused or passed over") {
  const auto read = [](const char* place, const json& value) {
    GltfBuilder file = turning("LINEAR");
    file.root[json::json_pointer(place)] = value;
    return read_gltf_animations(file.glb());
  };
  CHECK(read("/animations", "none").clips.empty());
  CHECK(read("/animations/0/channels", json::array()).clips.empty());
  CHECK(read("/animations/0/channels/0/target/node", 0).clips.size() == 1);  // the mesh's
  CHECK(read("/animations/0/name", 3).clips.at(0).name == "animation");
  CHECK(read("/nodes/1/name", 3).clips.size() == 1);
  for (const auto& change :
       std::vector<std::pair<const char*, json>>{{"/animations/0", 3},
                                                 {"/animations/0/channels", "none"},
                                                 {"/animations/0/channels/0/target", 3},
                                                 {"/animations/0/samplers", 3},
                                                 {"/animations/0/samplers/0", 3},
                                                 {"/animations/0/samplers/1/input", 1.5},
                                                 {"/animations/0/channels/0", json::object()},
                                                 {"/animations/0/samplers/1/input", 0},
                                                 {"/animations/0/samplers/0/interpolation", "CUBICSPLINE"},
                                                 {"/animations/0/channels/0/target/path", "scale"}}) {
    CAPTURE(std::string(change.first));
    CHECK_THROWS_AS(read(change.first, change.second), Error);
  }
}

TEST_CASE("an animation put in with a skin is read back the same") {
  const auto source = tetrahedron().glb();
  Rig rig;
  rig.joints = {{"root", -1, Matrix4::Identity()}, {"arm", 0, Matrix4::Identity()}};
  rig.joints[1].bind(0, 3) = 1;
  for (int v = 0; v < 4; ++v) rig.influences.push_back({{{1, 1}}});
  JointAnimation wave{"wave", std::vector<JointKeys>(2)};
  Keys& turn = wave.joints[1].rotation;
  turn.times = {0, 0.5, 0.75};
  turn.values.setZero(9, 4);
  for (int k = 0; k < 3; ++k)
    turn.values.row(3 * k + 1) =
        Eigen::Quaterniond(Eigen::AngleAxisd(k, Vector3::UnitZ())).coeffs().transpose();
  turn.values.row(2) << 0, 0, 2, 0;
  turn.interpolation = Interpolation::cubic;
  Keys& move = wave.joints[0].translation;
  move.times = {0, 0.5};
  move.values = (RowMatrix(2, 3) << 0, 0, 0, 0, 0, 3).finished();
  move.interpolation = Interpolation::step;
  const auto written = add_skin(source, read_gltf_memory(source).primitives, {&rig, {}, {}, {wave}});
  const auto read = read_gltf_animations(written);
  REQUIRE(read.clips.size() == 1);
  REQUIRE(read.clips[0].channels.size() == 2);
  for (const Channel& channel : read.clips[0].channels) {
    const Keys& given = channel.property == NodeProperty::rotation ? turn : move;
    CHECK(channel.keys.times == given.times);
    CHECK(channel.keys.interpolation == given.interpolation);
    CHECK((channel.keys.values - given.values).norm() < 1e-6);
  }
}

TEST_CASE("animations of real characters are read, every joint at every time") {
  const auto folder = evaluation_set("rigs");
  if (!folder) return;
  for (const char* name : {"fox.glb", "cesium_man.glb", "kaykit_knight.glb"}) {
    const auto animations = read_gltf_animations(read_file(*folder / name));
    CHECK_FALSE(animations.clips.empty());
    for (const Clip& clip : animations.clips)
      for (const double time : {0.0, 0.3, 1.0})
        for (const Matrix4& world : world_transforms(animations.tree, &clip, time)) CHECK(world.allFinite());
  }
}
