/* Meshes from arrays, their parameters, and every way they can be wrong. */
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
  const float outside[3] = {position[0] * 1.001f, position[1] * 1.001f, position[2] * 1.001f};
  const float nowhere[3] = {0, NAN, 0};
  float nearest[3];
  CHECK_OK(focal_mesh_closest_point(mesh, outside, &point));
  CHECK_OK(focal_mesh_position_of(mesh, &point, nearest));
  for (int i = 0; i < 3; ++i) CHECK(fabs(nearest[i] - position[i]) < 0.01);
  CHECK_REFUSED(focal_mesh_closest_point(mesh, nowhere, &point), FOCAL_ERROR_INVALID_ARGUMENT, "not finite");
  CHECK_REFUSED(focal_mesh_closest_point(mesh, NULL, &point), FOCAL_ERROR_INVALID_ARGUMENT, "position");
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

static focal_mesh_info info_of(const focal_mesh* mesh) {
  focal_mesh_info info;
  CHECK_OK(focal_mesh_info_init(&info, sizeof info));
  CHECK_OK(focal_mesh_get_info(mesh, &info));
  return info;
}

static void check_flipped(shape* body) {
  focal_mesh_desc desc = shape_desc(body);
  focal_mesh* mesh = NULL;
  focal_surface_point point = {4, {0.5f, 0.25f, 0.25f}};
  float before[3], after[3];
  CHECK_OK(focal_mesh_create(context, &desc, NULL, &mesh));
  const focal_mesh_info sound = info_of(mesh);
  CHECK(sound.flipped_triangles == 0 && sound.nonmanifold_edges == 0 && sound.nonmanifold_vertices == 0);
  CHECK(sound.boundary_loops == 0 && sound.degenerate_triangles == 0 && sound.invalid_triangles == 0);
  CHECK(sound.component_count == 1 && sound.is_oriented == 1 && sound.is_wrapped == 0);
  focal_mesh_destroy(mesh);
  point.barycentric[1] = 0.4f, point.barycentric[2] = 0.1f;
  for (int i = 0; i < 3; ++i)
    before[i] = 0.5f * body->positions[3 * body->indices[12] + (uint32_t)i] +
                0.1f * body->positions[3 * body->indices[13] + (uint32_t)i] +
                0.4f * body->positions[3 * body->indices[14] + (uint32_t)i];
  const uint32_t swapped = body->indices[13];
  body->indices[13] = body->indices[14], body->indices[14] = swapped;
  CHECK_OK(focal_mesh_create(context, &desc, NULL, &mesh));
  const focal_mesh_info info = info_of(mesh);
  CHECK(info.flipped_triangles == 1 && info.is_oriented == 1 && info.warning_count == 1);
  CHECK(memcmp(focal_mesh_triangles(mesh), body->indices, body->index_count * 4) == 0);
  CHECK_OK(focal_mesh_position_of(mesh, &point, after)); /* in the caller's order of the corners */
  for (int i = 0; i < 3; ++i) CHECK(fabsf(before[i] - after[i]) < 1e-6f);
  focal_mesh_destroy(mesh);
  body->indices[14] = body->indices[13], body->indices[13] = swapped;
}

/* One bad vertex and two bad triangles, from arrays and from a file. */
static void check_lenient(shape* body) {
  focal_mesh_params params;
  focal_mesh* mesh = NULL;
  focal_surface_point point;
  uint64_t with_vertex = 2; /* the triangles to be left out */
  for (uint64_t i = 6; i < body->index_count; ++i) with_vertex += body->indices[i] == 40;
  const float kept = body->positions[121];
  const uint32_t first = body->indices[0], second = body->indices[5];
  body->positions[121] = INFINITY, body->indices[0] = UINT32_MAX,
  body->indices[5] = (uint32_t)body->vertex_count;
  CHECK_OK(focal_mesh_params_init(&params, sizeof params));
  CHECK(params.lenient == 0);
  size_t size = 0;
  unsigned char* glb = shape_glb(body, &size);
  const focal_mesh_desc desc = shape_desc(body);
  CHECK_REFUSED(create(&desc), FOCAL_ERROR_INVALID_MESH, "names vertex");
  CHECK_REFUSED(focal_mesh_load_gltf_memory(context, glb, size, NULL, &mesh), FOCAL_ERROR_INVALID_MESH, "");
  params.lenient = 2;
  CHECK_REFUSED(focal_mesh_create(context, &desc, &params, &mesh), FOCAL_ERROR_INVALID_ARGUMENT, "lenient");
  params.lenient = 1;
  for (int from_file = 0; from_file < 2; ++from_file) {
    CHECK_OK(from_file ? focal_mesh_load_gltf_memory(context, glb, size, &params, &mesh)
                       : focal_mesh_create(context, &desc, &params, &mesh));
    const focal_mesh_info info = info_of(mesh);
    CHECK(info.invalid_triangles == with_vertex && info.degenerate_triangles == 0);
    CHECK(info.vertex_count == body->vertex_count && info.triangle_count * 3 == body->index_count);
    CHECK(info.surface_triangle_count == info.triangle_count - with_vertex && info.boundary_loops == 2);
    CHECK(strstr(focal_mesh_warning(mesh, 0), "left out") != NULL);
    const uint32_t* triangles = focal_mesh_triangles(mesh);
    CHECK(triangles[0] == 0 && triangles[1] == 0 && triangles[2] == 0);
    CHECK(memcmp(triangles + 6, body->indices + 6, 4 * sizeof *triangles) == 0);
    CHECK(focal_mesh_positions(mesh)[121] == 0);
    CHECK_REFUSED(focal_mesh_point_at_vertex(mesh, 40, &point), FOCAL_ERROR_INVALID_LANDMARK,
                  "no triangle uses");
    CHECK_OK(focal_mesh_point_at_vertex(mesh, body->marks[1], &point));
    focal_mesh_destroy(mesh);
  }
  free(glb);
  body->positions[121] = kept, body->indices[0] = first, body->indices[5] = second;
}

static focal_status load_nothing(const focal_mesh_params* params) {
  focal_mesh* mesh = NULL;
  return focal_mesh_load_gltf_memory(context, "", 0, params, &mesh);
}

/* A field takes the two values in the middle; the ones around them are refused by its name. */
#define MESH(field, below, least, most, above)                                                              \
  do {                                                                                                      \
    const double values[] = {below, least, most, above};                                                    \
    for (int i = 0; i < 4; ++i) {                                                                           \
      focal_mesh_params params;                                                                             \
      CHECK_OK(focal_mesh_params_init(&params, sizeof params));                                             \
      params.field = values[i];                                                                             \
      const int taken = i == 1 || i == 2;                                                                   \
      CHECK_REFUSED(load_nothing(&params), taken ? FOCAL_ERROR_INVALID_FILE : FOCAL_ERROR_INVALID_ARGUMENT, \
                    taken ? "empty" : "focal_mesh_params." #field " is");                                   \
    }                                                                                                       \
  } while (0)

static void check_ranges(void) {
  MESH(weld, -1, 0, 1, 2);
  MESH(drop_degenerate, -1, 0, 1, 2);
  MESH(surface, -1, 0, 2, 3);
  MESH(allow_external_files, -1, 0, 1, 2);
  MESH(keep_source_file, -1, 0, 1, 2);
  MESH(lenient, -1, 0, 1, 2);
  MESH(keep_scenery, -1, 0, 1, 2);
  MESH(max_vertices, 0, 1, INT32_MAX, INT32_MAX + 1.0);
  MESH(max_triangles, 0, 1, INT32_MAX, INT32_MAX + 1.0);
  MESH(max_nodes, 0, 1, INT32_MAX, INT32_MAX + 1.0);
  MESH(max_json_bytes, 0, 1, 0x1p40, 0x1p40 + 1);
  MESH(max_file_bytes, 0, 1, 0x1p40, 0x1p40 + 1);
  MESH(pose_time, -0.5, 0, 1e9, 2e9);
  focal_mesh* mesh = NULL;
  CHECK_REFUSED(focal_mesh_load_gltf_memory(context, "x", UINT64_MAX, NULL, &mesh),
                FOCAL_ERROR_INVALID_ARGUMENT, "size is 18446744073709551615");
  CHECK_REFUSED(focal_mesh_load_gltf_memory(context, "x", UINT64_C(1) << 63, NULL, &mesh),
                FOCAL_ERROR_INVALID_ARGUMENT, "size is 9223372036854775808");
}

static void check_limits(const shape* body) {
  focal_mesh_desc desc = shape_desc(body);
  focal_mesh_params params;
  focal_mesh* mesh = NULL;
  const char* beyond = "more vertices or triangles than allowed";
  CHECK_OK(focal_mesh_params_init(&params, sizeof params));
  params.max_vertices = body->vertex_count, params.max_triangles = body->index_count / 3;
  CHECK_OK(focal_mesh_create(context, &desc, &params, &mesh));
  focal_mesh_destroy(mesh);
  --params.max_vertices;
  CHECK_REFUSED(focal_mesh_create(context, &desc, &params, &mesh), FOCAL_ERROR_UNSUPPORTED, beyond);
  ++params.max_vertices, --params.max_triangles;
  CHECK_REFUSED(focal_mesh_create(context, &desc, &params, &mesh), FOCAL_ERROR_UNSUPPORTED, beyond);
  desc.position_stride = 12;
  CHECK_OK(create(&desc));
  for (uint32_t stride = 8; stride <= 15; ++stride) {
    desc.position_stride = stride;
    if (stride != 12) CHECK_REFUSED(create(&desc), FOCAL_ERROR_INVALID_ARGUMENT, "position_stride is");
  }
}

/* One part is analysed as it is, unless asked otherwise; either way the wrap can be looked at. */
static void check_wrap(const shape* body) {
  focal_mesh *as_is = NULL, *wrapped = NULL, *shown = NULL;
  focal_mesh_params params;
  const focal_mesh_desc desc = shape_desc(body);
  CHECK_OK(focal_mesh_params_init(&params, sizeof params));
  CHECK_OK(focal_mesh_create(context, &desc, &params, &as_is));
  params.surface = FOCAL_SURFACE_WRAPPED;
  CHECK_OK(focal_mesh_create(context, &desc, &params, &wrapped));
  focal_mesh_info info;
  CHECK_OK(focal_mesh_info_init(&info, sizeof info));
  CHECK_OK(focal_mesh_get_info(as_is, &info));
  CHECK(info.is_wrapped == 0);
  CHECK_OK(focal_mesh_get_info(wrapped, &info));
  CHECK(info.is_wrapped == 1);
  CHECK_REFUSED(focal_mesh_write_wrap_gltf(as_is, "wrap_test.gltf"), FOCAL_ERROR_INVALID_ARGUMENT,
                "ends in .gltf");
  CHECK_REFUSED(focal_mesh_write_wrap_gltf(as_is, "none/wrap_test.glb"), FOCAL_ERROR_FILE_NOT_FOUND, "none");
  CHECK_REFUSED(focal_mesh_write_wrap_gltf(NULL, "wrap_test.glb"), FOCAL_ERROR_INVALID_HANDLE, "is NULL");
  CHECK_OK(focal_mesh_write_wrap_gltf(wrapped, "wrap_test.glb"));
  CHECK_OK(focal_mesh_load_gltf(context, "wrap_test.glb", NULL, &shown));
  CHECK_OK(focal_mesh_get_info(shown, &info));
  CHECK(info.component_count == 1 && info.boundary_loops == 0);
  float low[2] = {9, 9}, high[2] = {-9, -9}; /* it lies where the mesh lies, about a cell of the grid apart */
  focal_mesh* const both[2] = {wrapped, shown};
  for (int i = 0; i < 2; ++i) {
    CHECK_OK(focal_mesh_get_info(both[i], &info));
    const float* positions = focal_mesh_positions(both[i]);
    for (uint64_t v = 0; v < info.vertex_count; ++v) {
      if (positions[3 * v] < low[i]) low[i] = positions[3 * v];
      if (positions[3 * v] > high[i]) high[i] = positions[3 * v];
    }
  }
  CHECK(fabsf(low[0] - low[1]) < 0.05f && fabsf(high[0] - high[1]) < 0.05f);
  remove("wrap_test.glb");
  focal_mesh_destroy(as_is), focal_mesh_destroy(wrapped), focal_mesh_destroy(shown);
}

/* Two parts as one mesh: numbered through. */
static void check_parts(const shape* body) {
  shape other = shape_create(6, 0);
  for (uint64_t v = 0; v < other.vertex_count; ++v) other.positions[3 * v] += 0.5f;
  focal_mesh_desc first = shape_desc(body), second = shape_desc(&other), bad = second;
  const focal_mesh_desc *const both[] = {&first, &second}, *const wrong[] = {&first, &bad},
                               *const missing[] = {&first, NULL};
  focal_mesh *mesh = NULL, *none = NULL;
  focal_mesh_info info;
  focal_mesh_part part;
  CHECK_OK(focal_mesh_create_parts(context, both, 2, NULL, &mesh));
  CHECK_OK(focal_mesh_info_init(&info, sizeof info));
  CHECK_OK(focal_mesh_get_info(mesh, &info));
  CHECK(info.vertex_count == body->vertex_count + other.vertex_count && info.component_count == 2);
  CHECK(focal_mesh_part_count(mesh) == 2 && focal_mesh_part_count(NULL) == 0);
  CHECK_OK(focal_mesh_part_init(&part, sizeof part));
  CHECK_OK(focal_mesh_get_part(mesh, 1, &part));
  CHECK(part.first_vertex == body->vertex_count && part.vertex_count == other.vertex_count);
  CHECK(part.first_triangle == body->index_count / 3 && part.triangle_count == other.index_count / 3);
  const uint32_t* triangles = focal_mesh_triangles(mesh) + 3 * part.first_triangle;
  CHECK(triangles[4] == other.indices[4] + part.first_vertex);
  CHECK(memcmp(focal_mesh_positions(mesh) + 3 * part.first_vertex, other.positions,
               other.vertex_count * 12) == 0);
  CHECK_REFUSED(focal_mesh_get_part(mesh, 2, &part), FOCAL_ERROR_INVALID_ARGUMENT, "no number 2");
  focal_mesh_destroy(mesh);
  CHECK_REFUSED(focal_mesh_create_parts(context, both, 0, NULL, &none), FOCAL_ERROR_INVALID_ARGUMENT,
                "part_count is 0");
  CHECK_REFUSED(focal_mesh_create_parts(context, NULL, 2, NULL, &none), FOCAL_ERROR_INVALID_ARGUMENT,
                "parts");
  CHECK_REFUSED(focal_mesh_create_parts(context, missing, 2, NULL, &none), FOCAL_ERROR_INVALID_ARGUMENT,
                "focal_mesh_desc is NULL");
  bad.vertex_count = other.vertex_count - 1;
  CHECK_REFUSED(focal_mesh_create_parts(context, wrong, 2, NULL, &none), FOCAL_ERROR_INVALID_MESH,
                "names vertex");
  bad = second, bad.vertex_count = UINT64_MAX - 2;
  CHECK_REFUSED(focal_mesh_create_parts(context, wrong, 2, NULL, &none), FOCAL_ERROR_UNSUPPORTED,
                "more vertices or triangles");
  CHECK(none == NULL);
  shape_destroy(&other);
}

int main(void) {
  shape body = shape_create(8, 0);
  CHECK_OK(focal_context_create(NULL, &context));
  check_good(&body);
  check_bad_arrays(&body);
  check_parts(&body);
  check_stride(&body);
  check_flipped(&body);
  check_lenient(&body);
  check_ranges();
  check_limits(&body);
  check_wrap(&body);
  shape_destroy(&body);
  focal_context_destroy(context);
  FINISH();
}
