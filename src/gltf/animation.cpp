#include "gltf/animation.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "base/error.h"
#include "gltf/accessor.h"
#include "gltf/fields.h"
#include "gltf/json.h"
#include "gltf/preflight.h"
#include "gltf/scene.h"

namespace focal {
namespace {

using nlohmann::json;

enum class Interpolation { linear, step, cubic };

// One animated property of one node.
struct Channel {
  int32_t node = 0;
  std::string path;  // translation, rotation, scale
  Interpolation interpolation = Interpolation::linear;
  std::vector<double> times;
  RowMatrix values;  // a row a key; cubic: in-tangent, value, out-tangent

  Eigen::VectorXd at(double time) const;
};

// glTF 2.0, Appendix C.
Eigen::VectorXd Channel::at(double time) const {
  const auto row = [&](size_t key, int part) -> Eigen::VectorXd {
    const bool cubic = interpolation == Interpolation::cubic;
    return values.row(static_cast<Eigen::Index>(cubic ? 3 * key + static_cast<size_t>(part) : key))
        .transpose();
  };
  const auto next = static_cast<size_t>(std::upper_bound(times.begin(), times.end(), time) - times.begin());
  if (next == 0) return row(0, 1);
  if (next == times.size() || interpolation == Interpolation::step) return row(next - 1, 1);
  const double span = times[next] - times[next - 1], t = (time - times[next - 1]) / span;
  const Eigen::VectorXd a = row(next - 1, 1), b = row(next, 1);
  if (interpolation == Interpolation::cubic) {
    const double t2 = t * t, t3 = t2 * t;
    return (2 * t3 - 3 * t2 + 1) * a + span * (t3 - 2 * t2 + t) * row(next - 1, 2) + (3 * t2 - 2 * t3) * b +
           span * (t3 - t2) * row(next, 0);
  }
  if (path != "rotation") return (1 - t) * a + t * b;
  const Eigen::Quaterniond from(a[3], a[0], a[1], a[2]), to(b[3], b[0], b[1], b[2]);
  return from.normalized().slerp(t, to.normalized()).coeffs();
}

[[noreturn]] void broken(const std::string& what) {
  throw Error(Status::invalid_file, "an animation " + what, "export the file again");
}

const json& element(const json& owner, const char* key, const json& list) {
  const json* index = member(owner, key);
  if (!index || !index->is_number_unsigned() || index->get<size_t>() >= list.size())
    broken(std::string("names no proper ") + key);
  return list[index->get<size_t>()];
}

RowMatrix values_of(const json& root, GltfBuffers& buffers, const json& sampler, const char* key) {
  element(sampler, key, list(root, "accessors"));
  return read_accessor(root, buffers, sampler[key].get<int64_t>());
}

std::optional<Channel> read_channel(const json& root, GltfBuffers& buffers, const json& animation,
                                    const json& entry) {
  const json* target = member(entry, "target");
  const json* samplers = member(animation, "samplers");
  if (!target || !target->is_object() || !samplers || !samplers->is_array())
    broken("has a channel without target");
  const json* path = member(*target, "path");
  if (!member(*target, "node") || !path || !path->is_string()) return std::nullopt;  // an extension's
  Channel channel;
  channel.path = path->get<std::string>();
  const size_t width = channel.path == "rotation" ? 4 : 3;
  if (channel.path != "rotation" && channel.path != "translation" && channel.path != "scale")
    return std::nullopt;
  element(*target, "node", list(root, "nodes"));
  channel.node = (*target)["node"].get<int32_t>();
  const json& sampler = element(entry, "sampler", *samplers);
  if (!sampler.is_object()) broken("has a sampler that is no object");
  const json* how = member(sampler, "interpolation");
  if (how && is_text(*how, "STEP")) channel.interpolation = Interpolation::step;
  if (how && is_text(*how, "CUBICSPLINE")) channel.interpolation = Interpolation::cubic;
  const RowMatrix times = values_of(root, buffers, sampler, "input");
  channel.values = values_of(root, buffers, sampler, "output");
  const Eigen::Index rows = times.rows() * (channel.interpolation == Interpolation::cubic ? 3 : 1);
  if (times.rows() == 0 || times.cols() != 1 || channel.values.rows() != rows ||
      channel.values.cols() != static_cast<Eigen::Index>(width) || !times.allFinite() ||
      !channel.values.allFinite())
    broken("has keys that do not fit together");
  channel.times.assign(times.data(), times.data() + times.rows());
  if (std::adjacent_find(channel.times.begin(), channel.times.end(), std::greater_equal<>()) !=
      channel.times.end())
    broken("has times that do not ascend");
  return channel;
}

// At most so many of all the channels' times.
std::vector<double> common_times(const std::vector<Channel>& channels, int32_t most) {
  std::set<double> all;
  for (const Channel& channel : channels) all.insert(channel.times.begin(), channel.times.end());
  std::vector<double> times(all.begin(), all.end());
  if (static_cast<int32_t>(times.size()) <= most) return times;
  std::vector<double> some;
  for (int32_t i = 0; i < most; ++i)
    some.push_back(times[static_cast<size_t>(i) * (times.size() - 1) / static_cast<size_t>(most - 1)]);
  return some;
}

// Of skins that a node wears: a character that was rigged anew keeps its former joints, of the same names.
std::set<int32_t> joints_of(const json& root) {
  std::set<int32_t> joints;
  for (const json& node : list(root, "nodes"))
    if (const json* skin = member(node, "skin"))
      for (const json& joint : list(root, "skins")[skin->get<size_t>()]["joints"])
        joints.insert(joint.get<int32_t>());
  return joints;
}

}  // namespace

std::vector<GltfAnimation> read_gltf_animations(std::span<const std::byte> bytes, const GltfLimits& limits,
                                                std::optional<std::filesystem::path> folder,
                                                int32_t most_keys) {
  const GltfContainer container = open_container(bytes, limits);
  const JsonDocument document = parse_gltf(container, limits);
  const json& root = document.root();
  GltfBuffers buffers(root, container, limits, std::move(folder));
  const json* animations = member(root, "animations");
  std::vector<GltfAnimation> result;
  if (!animations || !animations->is_array()) return result;
  const json& nodes = list(root, "nodes");
  const std::set<int32_t> joints = joints_of(root);
  int64_t matrices = limits.decoded_bytes / static_cast<int64_t>(sizeof(Matrix4));  // what is left of them
  for (const json& animation : *animations) {
    if (!animation.is_object() || !list(animation, "channels").is_array()) broken("is no object");
    std::vector<Channel> channels;
    for (const json& entry : list(animation, "channels"))
      if (auto channel = read_channel(root, buffers, animation, entry))
        channels.push_back(*std::move(channel));
    if (std::none_of(channels.begin(), channels.end(),
                     [&](const Channel& channel) { return joints.contains(channel.node); }))
      continue;
    const json* name = member(animation, "name");
    GltfAnimation one{name && name->is_string() ? name->get<std::string>() : "animation", {}, {}};
    one.times = common_times(channels, most_keys);
    matrices -= static_cast<int64_t>(one.times.size() * (joints.size() + 1));
    if (matrices < 0)
      throw Error(Status::unsupported, "glTF with more keys of animations than memory is allowed for",
                  "export fewer animations, or raise the limit");
    for (const double time : one.times) {
      std::map<int32_t, NodePose> poses;
      for (const Channel& channel : channels) {
        NodePose& pose =
            poses.try_emplace(channel.node, pose_of(nodes[static_cast<size_t>(channel.node)])).first->second;
        const Eigen::VectorXd value = channel.at(time);
        if (channel.path == "translation") pose.translation = value;
        if (channel.path == "scale") pose.scale = value;
        if (channel.path == "rotation")
          pose.rotation = Eigen::Quaterniond(value[3], value[0], value[1], value[2]);
      }
      const std::vector<Matrix4> world = world_transforms(root, poses);
      for (const int32_t joint : joints) {
        const json* joint_name = member(nodes[static_cast<size_t>(joint)], "name");
        if (!joint_name || !joint_name->is_string()) continue;
        auto& track = one.joints[joint_name->get<std::string>()];
        if (track.size() < one.times.size()) track.push_back(world[static_cast<size_t>(joint)]);
      }
    }
    std::erase_if(one.joints, [&](const auto& entry) { return entry.second.size() != one.times.size(); });
    result.push_back(std::move(one));
  }
  return result;
}

Matrix4 at_time(const std::vector<double>& times, const std::vector<Matrix4>& matrices, double time) {
  const auto next = static_cast<size_t>(std::upper_bound(times.begin(), times.end(), time) - times.begin());
  if (next == 0) return matrices.front();
  if (next == times.size()) return matrices.back();
  const double t = (time - times[next - 1]) / (times[next] - times[next - 1]);
  return (1 - t) * matrices[next - 1] + t * matrices[next];
}

}  // namespace focal
