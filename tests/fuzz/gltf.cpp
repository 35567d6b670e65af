// Any bytes as a glTF file: they are refused with a status and a hint, or read; what is read can be written again, with landmarks
// and with a skin, and read once more.
#include <algorithm>
#include <cstdio>
#include <string>

#include "base/error.h"
#include "fuzz.h"
#include "gltf/animation.h"
#include "gltf/reader.h"
#include "gltf/skin.h"
#include "gltf/writer.h"

using namespace focal;

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

// What focal wrote is a file that focal reads; further instances of a mesh may have become meshes. Limits may stop it.
void check_written(const fuzz::Bytes& written, const GltfMesh& before) {
  try {
    const GltfMesh again = read_gltf_memory(written, {.limits = small});
    fuzz::insist(again.mesh.triangle_count() >= before.mesh.triangle_count(), "no triangle is lost");
  } catch (const Error& error) {
    // A further instance that was left out, and so never looked at, has a mesh of its own now: it may be a bad one.
    const bool unseen = error.status() == Status::invalid_mesh &&
                        std::any_of(before.warnings.begin(), before.warnings.end(), [](const auto& warning) {
                          return warning.find("further instances") != std::string::npos;
                        });
    if (error.status() != Status::unsupported && !unseen) std::fprintf(stderr, "%s\n", error.what());
    fuzz::insist(error.status() == Status::unsupported || unseen, "a written file is read again");
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
      if (const auto rig = read_gltf_rig(file, read.primitives, small))
        for (const auto& influences : rig->influences)
          for (const auto& influence : influences)
            fuzz::insist(influence.joint >= 0 && influence.joint < static_cast<int32_t>(rig->joints.size()),
                         "joints exist");
    });
    guarded([&] {
      for (const auto& animation : read_gltf_animations(file, small))
        for (const auto& [name, matrices] : animation.joints)
          fuzz::insist(matrices.size() == animation.times.size(), "one matrix a time");
    });
  });
  return 0;
}
