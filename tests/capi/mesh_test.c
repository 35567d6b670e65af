/* Meshes from arrays, memory and files, and every way they can be wrong. */
#include <math.h>
#include <stdlib.h>

#include "check.h"
#include "shapes.h"

static focal_context* context;

static focal_status create(const focal_mesh_desc* desc) {
  focal_mesh* mesh = NULL;
  const focal_status status = focal_mesh_create(context, desc, NULL, &mesh);
  CHECK((status == FOCAL_OK) == (mesh != NULL));
  focal_mesh_destroy(mesh);
  return status;
}

static void check_good(const shape* body) {
  focal_mesh_desc desc = shape_desc(body);
  focal_mesh* mesh = NULL;
  focal_mesh_info info;
  CHECK_OK(focal_mesh_create(context, &desc, NULL, &mesh));
  CHECK_OK(focal_mesh_info_init(&info, sizeof info));
  CHECK_OK(focal_mesh_get_info(mesh, &info));
  CHECK(info.vertex_count == body->vertex_count && info.triangle_count * 3 == body->index_count);
  CHECK(info.surface_vertex_count == body->vertex_count);
  CHECK(info.surface_area > 12.6 && info.surface_area < 50); /* a unit ball with limbs */
  CHECK(info.mean_edge_length > 0.1 && info.mean_edge_length < 1);
  CHECK(memcmp(focal_mesh_positions(mesh), body->positions, body->vertex_count * 12) == 0);
  CHECK(memcmp(focal_mesh_triangles(mesh), body->indices, body->index_count * 4) == 0);
  CHECK(focal_mesh_warning(mesh, info.warning_count) == NULL);
  focal_surface_point point;
  float position[3];
  CHECK_OK(focal_mesh_point_at_vertex(mesh, body->marks[1], &point));
  CHECK_OK(focal_mesh_position_of(mesh, &point, position));
  CHECK(memcmp(position, body->positions + 3 * body->marks[1], sizeof position) == 0);
  CHECK_REFUSED(focal_mesh_point_at_vertex(mesh, FOCAL_NO_VERTEX, &point), FOCAL_ERROR_INVALID_LANDMARK,
                "no vertex 4294967295");
  point.triangle = 1u << 30;
  CHECK_REFUSED(focal_mesh_position_of(mesh, &point, position), FOCAL_ERROR_INVALID_LANDMARK, "no triangle");
  point.triangle = 0, point.barycentric[0] = NAN;
  CHECK_REFUSED(focal_mesh_position_of(mesh, &point, position), FOCAL_ERROR_INVALID_LANDMARK, "barycentric");
  focal_mesh_destroy(mesh);
}

static void check_bad_arrays(shape* body) {
  focal_mesh_desc desc = shape_desc(body);
  CHECK_REFUSED(create(NULL), FOCAL_ERROR_INVALID_ARGUMENT, "focal_mesh_desc is NULL");
  desc.positions = NULL;
  CHECK_REFUSED(create(&desc), FOCAL_ERROR_INVALID_ARGUMENT, "positions is NULL");
  desc = shape_desc(body);
  desc.index_count -= 1;
  CHECK_REFUSED(create(&desc), FOCAL_ERROR_INVALID_ARGUMENT, "multiple of 3");
  desc = shape_desc(body);
  desc.position_stride = 10;
  CHECK_REFUSED(create(&desc), FOCAL_ERROR_INVALID_ARGUMENT, "position_stride is 10");
  desc = shape_desc(body);
  desc.vertex_count = UINT64_MAX;
  CHECK_REFUSED(create(&desc), FOCAL_ERROR_UNSUPPORTED, "more vertices or triangles than allowed");
  desc = shape_desc(body);
  desc.index_count = 0;
  CHECK_REFUSED(create(&desc), FOCAL_ERROR_INVALID_MESH, "no triangles");
  desc = shape_desc(body);
  desc.vertex_count -= 1; /* the last vertex is used */
  CHECK_REFUSED(create(&desc), FOCAL_ERROR_INVALID_MESH, "names vertex");
  const uint32_t one_triangle[] = {0, 2, 3};
  desc = shape_desc(body);
  desc.indices = one_triangle, desc.index_count = 3, desc.vertex_count = 4;
  CHECK_REFUSED(create(&desc), FOCAL_ERROR_MESH_TOO_SMALL, "3 different vertices");
  const float kept = body->positions[4];
  body->positions[4] = NAN;
  desc = shape_desc(body);
  CHECK_REFUSED(create(&desc), FOCAL_ERROR_INVALID_MESH, "NaN or infinite");
  body->positions[4] = kept;
}

static void check_stride(const shape* body) {
  focal_mesh_desc desc = shape_desc(body);
  float* wide = malloc(body->vertex_count * 8 * sizeof *wide);
  for (uint64_t v = 0; v < body->vertex_count; ++v)
    for (int i = 0; i < 8; ++i)
      wide[8 * v + (uint64_t)i] = i < 3 ? body->positions[3 * v + (uint64_t)i] : NAN;
  desc.positions = wide, desc.position_stride = 32;
  CHECK_OK(create(&desc));
  free(wide);
}

static focal_status load_memory(const void* data, size_t size) {
  focal_mesh* mesh = NULL;
  const focal_status status = focal_mesh_load_gltf_memory(context, data, size, NULL, &mesh);
  CHECK((status == FOCAL_OK) == (mesh != NULL));
  focal_mesh_destroy(mesh);
  return status;
}

static void check_gltf(shape* body) {
  size_t size = 0;
  unsigned char* glb = shape_glb(body, &size);
  focal_mesh* mesh = NULL;
  CHECK_OK(load_memory(glb, size));
  CHECK_REFUSED(load_memory(glb, size / 2), FOCAL_ERROR_INVALID_FILE, "");
  CHECK_REFUSED(load_memory(glb, 11), FOCAL_ERROR_INVALID_FILE, "");
  CHECK_REFUSED(load_memory("", 0), FOCAL_ERROR_INVALID_FILE, "");
  CHECK_REFUSED(load_memory("not a glTF file at all", 22), FOCAL_ERROR_INVALID_FILE, "");
  CHECK_REFUSED(load_memory(NULL, 10), FOCAL_ERROR_INVALID_ARGUMENT, "data is NULL");
  CHECK_REFUSED(focal_mesh_load_gltf(context, "no/such/file.glb", NULL, &mesh), FOCAL_ERROR_FILE_NOT_FOUND,
                "no/such/file.glb");
  CHECK_REFUSED(focal_mesh_load_gltf(context, "", NULL, &mesh), FOCAL_ERROR_INVALID_ARGUMENT,
                "path is empty");
  CHECK_REFUSED(focal_mesh_load_gltf(context, NULL, NULL, &mesh), FOCAL_ERROR_INVALID_ARGUMENT,
                "path is NULL");
  CHECK_REFUSED(focal_mesh_load_gltf(context, "x.glb", NULL, NULL), FOCAL_ERROR_INVALID_ARGUMENT,
                "out_mesh is NULL");
  FILE* file = fopen("truncated.glb", "wb");
  CHECK(file && fwrite(glb, 1, size - 100, file) == size - 100 && fclose(file) == 0);
  CHECK_REFUSED(focal_mesh_load_gltf(context, "truncated.glb", NULL, &mesh), FOCAL_ERROR_INVALID_FILE,
                "truncated.glb");
  CHECK(mesh == NULL);
  focal_mesh_params params;
  CHECK_OK(focal_mesh_params_init(&params, sizeof params));
  params.max_vertices = 10;
  CHECK_REFUSED(focal_mesh_load_gltf_memory(context, glb, size, &params, &mesh), FOCAL_ERROR_UNSUPPORTED, "");
  params.max_vertices = 0;
  CHECK_REFUSED(focal_mesh_load_gltf_memory(context, glb, size, &params, &mesh), FOCAL_ERROR_INVALID_ARGUMENT,
                "max_vertices is 0");
  free(glb);
  body->positions[7] = NAN;
  glb = shape_glb(body, &size);
  CHECK_REFUSED(load_memory(glb, size), FOCAL_ERROR_INVALID_MESH, "");
  free(glb);
}

int main(void) {
  shape body = shape_create(8, 0);
  CHECK_OK(focal_context_create(NULL, &context));
  check_good(&body);
  check_bad_arrays(&body);
  check_stride(&body);
  check_gltf(&body);
  shape_destroy(&body);
  focal_context_destroy(context);
  FINISH();
}
