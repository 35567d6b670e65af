// glTF files that leave: of the kind that their path promises, with the files that lie beside them.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "gltf/document.h"
#include "mesh.h"

namespace focal {

// The content stays of the kind it came as, so a path that promises the other kind would mislead. Suffixes in any case; a .vrm is a .glb.
// Throws invalid_argument.
void check_suffix(const std::filesystem::path& path, bool is_binary);

// The caller's own glTF to be added to, or a plain .glb where there is none.
struct SourceFile {
  GltfDocument document;
  std::vector<GltfPrimitive> primitives;
};
// Throws invalid_argument when the path promises the other kind of file.
SourceFile source_file(const MeshObject& mesh, const std::filesystem::path& path);

// Writes it, after the files beside the source (buffers, images) have been copied beside it where it goes to another folder. Returns
// warnings: what could not be copied. Throws invalid_argument (another file of the same name is there), io, file_not_found.
std::vector<std::string> write_document(const GltfDocument& document, const std::filesystem::path& path);

}  // namespace focal
