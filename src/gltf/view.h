// A checked glTF document as tinygltf's typed model: scene, nodes, meshes, skins, animations, accessors,
// buffer views.
//
// tinygltf gets the document that parse_gltf has checked, without buffers, images, materials, extras and
// extensions that are not used here, so that it finds nothing to refuse and does not copy data. Its namespace
// is renamed inside focal, so that a host can use another version of tinygltf.
#pragma once
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#define tinygltf focal_tinygltf
#ifndef TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#define TINYGLTF_NO_FS
#define TINYGLTF_NO_INCLUDE_JSON
#endif
#include <tiny_gltf.h>

namespace focal {

namespace tiny = ::focal_tinygltf;

struct BufferSource {
  std::optional<std::string> uri;  // none: the BIN chunk
  int64_t length = 0;
};

struct GltfView {
  tiny::Model model;
  std::vector<BufferSource> buffers;
  // One per animation of the file: a description if it is malformed, else empty.
  std::vector<std::string> broken_animations;
  // Likewise: channels that an extension moves, which are not in the model.
  std::vector<size_t> pointer_channels;
};

// Moves the buffers' URIs, which may be long, out of the document. Throws invalid_file (what tinygltf
// refuses).
GltfView view_of(nlohmann::json& checked_root);

// Whether an accessor has data; tinygltf requires those of indices to have a view.
bool has_view(const tiny::Model& model, const tiny::Accessor& accessor);

// A member of an extension that the view keeps, or null.
const tiny::Value* extension(const tiny::ExtensionMap& extensions, const char* name);

}  // namespace focal

#undef tinygltf
