// Reads the animations of a file.
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "base/error.h"
#include "gltf/accessor.h"
#include "gltf/opened.h"
#include "gltf/scene.h"
#include "gltf/text.h"

namespace focal {
namespace {

[[noreturn]] void broken(const std::string& what) {
  throw Error(Status::invalid_file, "an animation " + what, "export the file again");
}

std::optional<NodeProperty> property_of(const std::string& path) {
  if (path == "translation") return NodeProperty::translation;
  if (path == "rotation") return NodeProperty::rotation;
  if (path == "scale") return NodeProperty::scale;
  return std::nullopt;
}

void check(const Keys& keys, Eigen::Index width) {
  const auto rows =
      static_cast<Eigen::Index>(keys.times.size()) * (keys.interpolation == Interpolation::cubic ? 3 : 1);
  const auto is_finite = [](double time) { return std::isfinite(time); };
  if (keys.empty() || keys.values.rows() != rows || keys.values.cols() != width || !keys.values.allFinite() ||
      !std::all_of(keys.times.begin(), keys.times.end(), is_finite))
    broken("has keys of inconsistent sizes or values");
  if (std::adjacent_find(keys.times.begin(), keys.times.end(), std::greater_equal<>()) != keys.times.end())
    broken("has key times that are not ascending");
}

// Reads keys within a memory limit: many channels may refer to one large accessor.
class KeyReader {
 public:
  KeyReader(const GltfView& view, GltfBuffers& buffers, int64_t max_bytes)
      : view_(view), buffers_(buffers), left_(max_bytes) {}

  Keys read(const tiny::AnimationSampler& sampler, Eigen::Index width) {
    const tiny::Accessor& input = accessor(sampler.input);
    charge(input);
    charge(accessor(sampler.output));
    Keys keys;
    if (sampler.interpolation == "STEP") keys.interpolation = Interpolation::step;
    if (sampler.interpolation == "CUBICSPLINE") keys.interpolation = Interpolation::cubic;
    const RowMatrix times = read_accessor(view_, buffers_, sampler.input);
    if (times.cols() != 1) broken("has keys of inconsistent sizes or values");
    keys.times.assign(times.data(), times.data() + times.rows());
    keys.values = read_accessor(view_, buffers_, sampler.output);
    check(keys, width);
    return keys;
  }

 private:
  const tiny::Accessor& accessor(int index) const {
    return view_.model.accessors[static_cast<size_t>(index)];
  }
  void charge(const tiny::Accessor& from) {
    left_ -= static_cast<int64_t>(from.count * sizeof(double)) *
             tiny::GetNumComponentsInType(static_cast<uint32_t>(from.type));
    if (left_ < 0)
      throw Error(Status::unsupported, "glTF with more animation keys than the memory limit allows",
                  "export fewer animations, or raise the limit");
  }

  const GltfView& view_;
  GltfBuffers& buffers_;
  int64_t left_;
};

}  // namespace

GltfAnimations GltfDocument::animations() const {
  const GltfView& view = opened_->view;
  GltfBuffers buffers = opened_->buffers();
  KeyReader reader(view, buffers, opened_->params.limits.decoded_bytes);
  GltfAnimations result{node_tree(view.model), {}, {}};
  for (size_t a = 0; a < view.model.animations.size(); ++a) {
    if (!view.broken_animations[a].empty()) broken(view.broken_animations[a]);
    const tiny::Animation& from = view.model.animations[a];
    Clip clip{from.name.empty() ? "animation" : from.name, {}};
    size_t left_out = view.pointer_channels[a];
    for (const tiny::AnimationChannel& channel : from.channels) {
      const auto property = property_of(channel.target_path);
      if (!property) ++left_out;
      if (!property) continue;
      const Eigen::Index width = *property == NodeProperty::rotation ? 4 : 3;
      clip.channels.push_back({channel.target_node, *property,
                               reader.read(from.samplers[static_cast<size_t>(channel.sampler)], width)});
    }
    if (left_out > 0)
      result.warnings.push_back("animation '" + printable(clip.name) + "': " + std::to_string(left_out) +
                                (left_out == 1 ? " channel animates" : " channels animate") +
                                " something other than a joint (morph weights, a material)");
    if (!clip.channels.empty()) result.clips.push_back(std::move(clip));
  }
  return result;
}

void pose(const GltfDocument& document, const std::string& animation, double time, GltfMesh& gltf) {
  const auto rig = document.rig(gltf.primitives);
  const GltfAnimations found = document.animations();
  std::string names;
  for (const Clip& one : found.clips) {
    names += (names.empty() ? "'" : ", '") + one.name + "'";
    if (!rig || one.name != animation) continue;
    const std::vector<Matrix4> world = world_transforms(found.tree, &one, time);
    std::vector<Matrix4> transforms;
    for (const Joint& joint : rig->joints) transforms.push_back(world[joint.node] * joint.bind.inverse());
    gltf.mesh.positions = skinned(gltf.mesh.positions, rig->influences, transforms);
    return;
  }
  std::string hint = "it has no skin that an animation could move";
  if (rig) hint = names.empty() ? "it has no animations" : "it has: " + names;
  throw Error(Status::invalid_argument, "the file has no animation '" + animation + "' of a skinned mesh",
              hint);
}

}  // namespace focal
