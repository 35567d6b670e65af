// Animations are sampled as the standard says, and those put into a file are read back the same.
#include "gltf/animation.h"

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "base/atomic_file.h"
#include "base/error.h"
#include "evaluation_data.h"
#include "gltf/gltf_builder.h"
#include "gltf/writer.h"

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

TEST_CASE("keys of all channels, between them linear or a step, after the last its value") {
  const auto linear = read_gltf_animations(turning("LINEAR").glb());
  REQUIRE(linear.size() == 1);
  CHECK(linear[0].name == "wave");
  CHECK(linear[0].times == std::vector<double>{0, 1, 2});
  const auto& arm = linear[0].joints.at("arm");
  CHECK(angle_of(arm[1]) == doctest::Approx(std::numbers::pi / 4).epsilon(1e-5));
  CHECK((arm[1].topRightCorner<3, 1>() - Vector3(4, 1, 0)).norm() < 1e-6);
  CHECK((arm[2].topRightCorner<3, 1>() - Vector3(4, 1, 0)).norm() < 1e-6);
  CHECK((linear[0].joints.at("up")[2].topRightCorner<3, 1>() - Vector3(0, 1, 0)).norm() < 1e-6);
  const auto step = read_gltf_animations(turning("STEP").glb());
  CHECK(angle_of(step[0].joints.at("arm")[1]) == doctest::Approx(0));
  CHECK(read_gltf_animations(tetrahedron().glb()).empty());
  CHECK(read_gltf_animations(turning("LINEAR").glb(), {}, {}, 2)[0].times.size() == 2);
}

TEST_CASE("keys that do not fit are refused") {
  CHECK_THROWS_AS(read_gltf_animations(turning("LINEAR", {0, 0}).glb()), Error);
  CHECK_THROWS_AS(read_gltf_animations(turning("LINEAR", {0}).glb()), Error);
  CHECK_THROWS_AS(read_gltf_animations(turning("LINEAR").glb(), {.decoded_bytes = 1024}), Error);
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
    REQUIRE(animations.size() == 1);
    CHECK(animations[0].times == std::vector<double>{0, 2});  // the turn's alone
  }
  GltfBuilder file = turning("LINEAR");
  file.root["animations"][0]["channels"][1]["target"]["path"] = "scale";
  const auto scaled = read_gltf_animations(file.glb());
  CHECK(scaled[0].times == std::vector<double>{0, 1, 2});
  CHECK(scaled[0].joints.at("arm")[1].topLeftCorner<3, 3>().col(0).norm() == doctest::Approx(4));
}

TEST_CASE("cubic keys follow their tangents") {
  GltfBuilder file = turning("LINEAR");
  // Hermite: from 0 to 4 within 2 s, leaving with 1 a second and arriving with 3 a second.
  const int keys =
      file.add_accessor(std::vector<float>{9, 0, 0, 0, 0, 0, 1, 0, 0, 3, 0, 0, 4, 0, 0, 9, 0, 0}, "VEC3");
  const int times = file.add_accessor(std::vector<float>{0, 2}, "SCALAR");
  file.root["animations"][0]["samplers"][1] = {
      {"input", times}, {"output", keys}, {"interpolation", "CUBICSPLINE"}};
  const int moments =
      file.add_accessor(std::vector<float>{0, 1}, "SCALAR");  // of the turn: asks for the place at 1 s
  file.root["animations"][0]["samplers"][0]["input"] = moments;
  const auto animation = read_gltf_animations(file.glb()).at(0);
  CHECK(animation.times == std::vector<double>{0, 1, 2});
  CHECK(animation.joints.at("arm")[1](0, 3) == doctest::Approx(0.5 * 4 + 2 * (1 - 3) / 8.0));
}

TEST_CASE("animations take no more memory than is allowed, exactly") {
  const auto bytes = turning("LINEAR").glb();  // 3 times, 2 joints and what they share
  const int64_t needed = 3 * (2 + 1) * static_cast<int64_t>(sizeof(Matrix4));
  CHECK(read_gltf_animations(bytes, {.decoded_bytes = needed}).size() == 1);
  CHECK_THROWS_AS(read_gltf_animations(bytes, {.decoded_bytes = needed - 1}), Error);
}

TEST_CASE("what is no animation is refused or passed over") {
  const auto read = [](const char* place, const json& value) {
    GltfBuilder file = turning("LINEAR");
    file.root[json::json_pointer(place)] = value;
    return read_gltf_animations(file.glb());
  };
  CHECK(read("/animations", "none").empty());
  CHECK(read("/animations/0/channels", json::array()).empty());
  CHECK(read("/animations/0/channels/0/target/node", 0).size() ==
        1);  // of the mesh's node; the other moves a joint
  CHECK(read("/animations/0/name", 3).at(0).name == "animation");
  CHECK(read("/nodes/1/name", 3).at(0).joints.size() == 1);
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
  JointAnimation wave{"wave", {0, 0.5}, {{}, {}}};
  wave.joints[1].rotation = {Eigen::Quaterniond::Identity(),
                             Eigen::Quaterniond(Eigen::AngleAxisd(1.0, Vector3::UnitZ()))};
  wave.joints[0].translation = {Vector3::Zero(), Vector3(0, 0, 3)};
  const auto written = add_skin(source, read_gltf_memory(source).primitives, {&rig, {}, {}, {wave}});
  const auto read = read_gltf_animations(written);
  REQUIRE(read.size() == 1);
  CHECK(read[0].times == wave.times);
  CHECK(angle_of(read[0].joints.at("arm")[1]) == doctest::Approx(1.0).epsilon(1e-5));
  CHECK((read[0].joints.at("arm")[1].topRightCorner<3, 1>() - Vector3(1, 0, 3)).norm() < 1e-5);
}

TEST_CASE("animations of real characters are read, every joint at every time") {
  const auto folder = evaluation_set("rigs");
  if (!folder) return;
  for (const char* name : {"fox.glb", "cesium_man.glb", "kaykit_knight.glb"}) {
    const auto animations = read_gltf_animations(read_file(*folder / name), {}, {}, 20);
    CHECK_FALSE(animations.empty());
    for (const auto& animation : animations)
      for (const auto& [joint, track] : animation.joints) {
        CHECK(track.size() == animation.times.size());
        for (const Matrix4& m : track) CHECK(m.allFinite());
      }
  }
}
