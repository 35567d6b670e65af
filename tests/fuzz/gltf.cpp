// Any bytes as a glTF file: they are refused with a status and a hint, or read; what is read can be written again, with landmarks
// and with a skin, and read once more.
#include <cstdio>
#include <string>

#include "base/error.h"
#include "fuzz.h"
#include "gltf/document.h"
#include "gltf/one_call.h"

using namespace focal;
using namespace focal_test;

namespace {

constexpr GltfLimits small{.file_bytes = 1 << 16,
                           .json_bytes = 1 << 16,
                           .json_depth = 64,
                           .json_values = 20'000,
                           .nodes = 1000,
                           .vertices = 5000,
                           .triangles = 10'000,
                           .decoded_bytes = 1 << 20};

template <class Call>
void guarded(Call&& call) {
  try {
    call();
  } catch (const Error& error) {
    fuzz::insist(error.status() != Status::internal, "a file is never our own mistake");
    fuzz::insist(!error.hint().empty(), "an error has a hint");
  }
}

// What focal wrote is a file that focal reads. Limits may stop it.
void check_written(const fuzz::Bytes& written, const GltfMesh& before) {
  try {
    const GltfMesh again = read_gltf_memory(written, {.limits = small});
    fuzz::insist(again.mesh.triangle_count() >= before.mesh.triangle_count(), "no triangle is lost");
  } catch (const Error& error) {
    if (error.status() != Status::unsupported) std::fprintf(stderr, "%s\n", error.what());
    fuzz::insist(error.status() == Status::unsupported, "a written file is read again");
  }
}

void write_and_read(std::span<const std::byte> file, const GltfMesh& read) {
  const auto vertices = static_cast<size_t>(read.mesh.vertex_count());
  const GltfLandmark mark{.name = "mark", .point = {0, Vector3(0.5, 0.25, 0.25)}};
  check_written(add_landmarks(file, read.primitives, std::span(&mark, 1), small), read);
  Rig rig;
  rig.joints = {{"root", -1, Matrix4::Identity()}, {"tip", 0, Matrix4::Identity()}};
  rig.influences.assign(vertices, {Influence{1, 0.75F}, Influence{0, 0.25F}});
  check_written(add_skin(file, read.primitives, {.rig = &rig, .tips = {}, .mesh = &read.mesh}, small), read);
}

}  // namespace

int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const auto file = std::as_bytes(std::span(data, size));
  guarded([&] {
    const GltfMesh read = read_gltf_memory(file, {.limits = small});
    const auto& mesh = read.mesh;
    fuzz::insist(mesh.positions.allFinite(), "positions are finite");
    fuzz::insist(mesh.triangles.minCoeff() >= 0 && mesh.triangles.maxCoeff() < mesh.vertex_count(),
                 "corners exist");
    guarded([&] { write_and_read(file, read); });
    guarded([&] {
      if (const auto rig = read_gltf_rig(file, read.primitives, nullptr, small))
        for (const auto& influences : rig->influences)
          for (const auto& influence : influences)
            fuzz::insist(influence.joint >= 0 && influence.joint < static_cast<int32_t>(rig->joints.size()),
                         "joints exist");
    });
    guarded([&] {
      const GltfAnimations animations = read_gltf_animations(file, small);
      for (const Clip& clip : animations.clips)
        fuzz::insist(world_transforms(animations.tree, &clip, 0.5).size() == animations.tree.parent.size(),
                     "one matrix a node");
    });
  });
  return 0;
}
