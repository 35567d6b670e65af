// What leaves a mesh as a file.
#include "arguments.h"
#include "base/atomic_file.h"
#include "boundary.h"
#include "mesh.h"
#include "output_file.h"

using namespace focal;

focal_status focal_mesh_write_wrap_gltf(const focal_mesh* mesh, const char* path) {
  return guarded([&] {
    const auto object = resolve<MeshObject>(mesh);
    const auto file = path_of(path);
    check_suffix(file, true);
    const PreparedMesh& prepared = *object->mesh;
    TriangleMesh shell = wrapped(prepared).source;
    shell.positions *= prepared.scale;
    shell.positions.rowwise() += prepared.centre.transpose();
    write_file_atomically(file, write_glb(shell, {}, "wrap"));
  });
}
