// What leaves a mesh as a file.
#include "arguments.h"
#include "base/atomic_file.h"
#include "base/error.h"
#include "boundary.h"
#include "gltf/writer.h"
#include "mesh.h"

using namespace focal;

focal_status focal_mesh_write_wrap_gltf(const focal_mesh* mesh, const char* path) {
  return guarded([&] {
    const auto object = resolve<MeshObject>(mesh);
    const auto file = path_of(path);
    if (file.extension() == ".gltf")
      throw Error(Status::invalid_argument, "the wrap is written as .glb, the path ends in .gltf",
                  "choose a path that ends in .glb");
    const PreparedMesh& prepared = *object->mesh;
    TriangleMesh shell = wrapped(prepared).source;
    shell.positions *= prepared.scale;
    shell.positions.rowwise() += prepared.centre.transpose();
    write_file_atomically(file, write_glb(shell, {}, "wrap"));
  });
}
