#include "gltf/output_file.h"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <string_view>

#include "base/atomic_file.h"
#include "base/error.h"

namespace focal {
namespace {

namespace fs = std::filesystem;

std::string suffix_of(const fs::path& path) {
  std::string suffix = text_of(path.extension());
  std::transform(suffix.begin(), suffix.end(), suffix.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return suffix;
}

bool is_same_folder(const fs::path& a, const fs::path& b) {
  std::error_code error;
  return fs::equivalent(a.empty() ? "." : a, b.empty() ? "." : b, error);
}

// What is there already with the same content stays.
void copy_beside(const fs::path& from, const fs::path& name, const fs::path& to) {
  const auto bytes = read_file_inside(from, name);
  const fs::path target = to / name;
  std::error_code error;
  if (fs::exists(target, error)) {
    if (read_file(target) == bytes) return;
    throw Error(Status::invalid_argument,
                "another '" + text_of(name) + "' is there already, where the file beside the mesh has to go",
                "write into another folder");
  }
  fs::create_directories(target.parent_path(), error);
  write_file_atomically(target, bytes);
}

}  // namespace

void check_suffix(const fs::path& path, bool is_binary) {
  const std::string suffix = suffix_of(path);
  const char* wanted = is_binary ? ".glb" : ".gltf";
  // Of formats that are not written at all: a glTF file under such a name would open nowhere.
  constexpr std::string_view foreign[] = {".fbx", ".obj",   ".usd", ".usda", ".usdc", ".usdz",
                                          ".dae", ".blend", ".ply", ".stl",  ".3ds",  ".x3d"};
  const bool is_wrong = (is_binary ? suffix == ".gltf" : suffix == ".glb" || suffix == ".vrm") ||
                        std::find(std::begin(foreign), std::end(foreign), suffix) != std::end(foreign);
  if (is_wrong)
    throw Error(Status::invalid_argument,
                "the mesh is written as " + std::string(wanted) + ", the path ends in " + suffix,
                std::string("choose a path that ends in ") + wanted);
}

SourceFile source_file(const SourceFile* file, const TriangleMesh& mesh, const fs::path& path) {
  const auto plain = [&] {
    GltfDocument document(write_glb(mesh));
    auto primitives = document.mesh().primitives;
    return SourceFile{std::move(document), std::move(primitives)};
  };
  SourceFile source = file ? *file : plain();
  check_suffix(path, source.document.is_binary());
  return source;
}

std::vector<std::string> write_document(const GltfDocument& document, const fs::path& path) {
  std::vector<std::string> warnings;
  const fs::path to = path.parent_path();
  const auto& from = document.folder();
  std::vector<fs::path> names = document.files_beside();
  if (from && is_same_folder(*from, to)) names.clear();
  for (const fs::path& name : names) {
    const std::string why = "'" + text_of(name) + "', which the file refers to, was not copied: ";
    if (!from || !document.reads_files_beside()) {
      warnings.push_back(why + "files beside it may not be read (allow_external_files)");
      continue;
    }
    try {
      copy_beside(*from, name, to);
    } catch (const Error& error) {
      if (error.status() != Status::file_not_found && error.status() != Status::invalid_file) throw;
      warnings.push_back(why + error.what());
    }
  }
  write_file_atomically(path, document.bytes());
  return warnings;
}

TriangleMesh in_source_coordinates(TriangleMesh part, const PreparedMesh& mesh) {
  part.positions = (mesh.scale * part.positions).rowwise() + mesh.centre.transpose();
  return part;
}

}  // namespace focal
