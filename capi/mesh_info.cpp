// What reading and preparing a mesh found, did and left out.
#include "arguments.h"
#include "boundary.h"
#include "objects.h"
#include "structs.h"

using namespace focal;

FOCAL_STRUCT(focal_mesh_info, 72);
static_assert(sizeof(focal_mesh_info) == 152 && offsetof(focal_mesh_info, repair_seconds) == 64 &&
              offsetof(focal_mesh_info, is_oriented) == 128 && offsetof(focal_mesh_info, is_wrapped) == 132);

FOCAL_STRUCT(focal_mesh_part, sizeof(focal_mesh_part));
static_assert(sizeof(focal_mesh_part) == 40 && offsetof(focal_mesh_part, first_vertex) == 8);

FOCAL_STRUCT(focal_left_out, sizeof(focal_left_out));
static_assert(sizeof(void*) != 8 || (sizeof(focal_left_out) == 32 && offsetof(focal_left_out, name) == 8));
static_assert(FOCAL_SCENERY_SHEET == static_cast<int>(SceneryKind::sheet) &&
              FOCAL_SCENERY_ENCLOSURE == static_cast<int>(SceneryKind::enclosure) &&
              FOCAL_SCENERY_APART == static_cast<int>(SceneryKind::apart));

namespace {

focal_mesh_info info_of(const MeshObject& object) {
  const PreparedMesh& mesh = *object.mesh;
  const auto count = [](int64_t value) { return static_cast<uint64_t>(value); };
  focal_mesh_info info{};
  info.warning_count = static_cast<uint32_t>(object.warnings.size());
  info.vertex_count = count(mesh.source.vertex_count());
  info.triangle_count = count(mesh.source.triangle_count());
  info.surface_vertex_count = count(mesh.surface.vertex_count());
  info.surface_triangle_count = count(mesh.surface.triangle_count());
  info.mean_edge_length = object.mean_edge_length;
  info.surface_area = object.surface_area;
  info.load_seconds = object.load_seconds;
  info.repair_seconds = object.repair_seconds;
  info.invalid_triangles = count(mesh.invalid_triangles);
  info.degenerate_triangles = count(degenerate_triangles(mesh));
  info.flipped_triangles = count(flipped_triangles(mesh));
  info.nonmanifold_edges = count(mesh.topology->nonmanifold_edges);
  info.nonmanifold_vertices = count(mesh.topology->nonmanifold_vertices);
  info.boundary_loops = count(mesh.topology->boundary_loops);
  info.component_count = count(mesh.components);
  info.is_oriented = mesh.is_oriented;
  info.is_wrapped = mesh.is_wrapped;
  info.left_out_triangles = count(mesh.scenery_triangles);
  info.left_out_count = static_cast<uint32_t>(object.left_out.size());
  return info;
}

}  // namespace

focal_status focal_mesh_get_info(const focal_mesh* mesh, focal_mesh_info* out_info) {
  return guarded([&] {
    const auto object = resolve<MeshObject>(mesh);
    write_result(out_info, info_of(*object));
  });
}

uint32_t focal_mesh_part_count(const focal_mesh* mesh) {
  return guarded_value<uint32_t>([&] { return resolve<MeshObject>(mesh)->parts.size(); });
}

focal_status focal_mesh_get_part(const focal_mesh* mesh, uint32_t index, focal_mesh_part* out_part) {
  return guarded([&] {
    const auto object = resolve<MeshObject>(mesh);
    check_index(index, object->parts.size(), "the mesh", "parts");
    const MeshPart& from = object->parts[index];
    focal_mesh_part to{};
    to.first_vertex = from.first_vertex, to.vertex_count = from.vertex_count;
    to.first_triangle = from.first_triangle, to.triangle_count = from.triangle_count;
    write_result(out_part, to);
  });
}

focal_status focal_mesh_get_left_out(const focal_mesh* mesh, uint32_t index, focal_left_out* out_left_out) {
  return guarded([&] {
    const auto object = resolve<MeshObject>(mesh);
    check_index(index, object->left_out.size(), "the mesh", "parts that are left out");
    const LeftOut& from = object->left_out[index];
    focal_left_out to{};
    to.reason = from.reason;
    to.name = from.name.c_str();
    to.triangle_count = static_cast<uint64_t>(from.triangle_count);
    to.is_whole_node = from.is_whole_node;
    write_result(out_left_out, to);
  });
}

const char* focal_mesh_warning(const focal_mesh* mesh, uint32_t index) {
  return guarded_value<const char*>(
      [&] { return text_at(resolve<MeshObject>(mesh)->warnings, index, "the mesh", "warnings"); });
}
