// Limits for untrusted glTF files.
#pragma once
#include <cstdint>

namespace focal {

struct GltfLimits {
  int64_t file_bytes = int64_t{2} << 30;  // the file, and each buffer beside it
  int64_t json_bytes = 64 << 20;
  int32_t json_depth = 64;
  int64_t json_values = 4'000'000;           // numbers, strings, objects and arrays in total
  int64_t nodes = 1'000'000;                 // also meshes, primitives, accessors, views, skins, joints
  int64_t vertices = 5'000'000;              // over all primitives
  int64_t triangles = 10'000'000;            // over all primitives
  int64_t decoded_bytes = int64_t{1} << 30;  // buffers from data: URIs and compressed views in total
};

}  // namespace focal
