// glTF files that leave: of the kind that their path promises, with the files that lie beside them.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "gltf/document.h"
#include "mesh/prepare.h"

namespace focal {

// The content keeps the kind it came as, so a path that promises the other kind would mislead. Suffixes in any case; a .vrm is a .glb.
// Throws invalid_argument.
void check_suffix(const std::filesystem::path& path, bool is_binary);

// A glTF file to be added to, and where its primitives are in the mesh.
struct SourceFile {
  GltfDocument document;
  std::vector<GltfPrimitive> primitives;
};
// A copy of the file, or a plain .glb of the mesh if it is null. Throws invalid_argument when the path promises the other
// kind of file.
SourceFile source_file(const SourceFile* file, const TriangleMesh& mesh, const std::filesystem::path& path);

// Writes it, after the files beside the source (buffers, images) have been copied beside it where it goes to another folder. Returns
// warnings: what could not be copied. Throws invalid_argument (another file of the same name is there), io, file_not_found.
std::vector<std::string> write_document(const GltfDocument& document, const std::filesystem::path& path);

// A mesh in the coordinates of mesh.surface, moved to those of mesh.source.
TriangleMesh in_source_coordinates(TriangleMesh part, const PreparedMesh& mesh);

}  // namespace focal
