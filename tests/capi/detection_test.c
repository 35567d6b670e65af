/* What comes out of a detection: maps to another mesh, parts, vote maps of a proxy, files of either kind; and misuse. */
#include <stdlib.h>

#include "check.h"
#include "shapes.h"

enum { RINGS = 10, VERTICES = 2 * RINGS * RINGS + 2, TRIANGLES = 2 * VERTICES - 4 };

static focal_context* context;

static focal_detection* detect(const focal_model* model, const focal_mesh* mesh) {
  focal_detection* detection = NULL;
  CHECK_OK(focal_model_detect(model, mesh, NULL, NULL, &detection));
  return detection;
}

static void check_correspondence(const focal_detection* from, const focal_detection* to) {
  focal_correspondence* map = NULL;
  static focal_surface_point points[VERTICES];
  static float values[VERTICES], carried[VERTICES];
  CHECK_OK(focal_correspondence_create(from, to, NULL, &map));
  CHECK_OK(focal_correspondence_points(map, VERTICES, points));
  for (int v = 0; v < VERTICES; ++v) CHECK(points[v].triangle < TRIANGLES);
  for (int v = 0; v < VERTICES; ++v) values[v] = 0.5f;
  CHECK_OK(focal_correspondence_carry(map, VERTICES, values, VERTICES, carried));
  for (int v = 0; v < VERTICES; ++v)
    CHECK(carried[v] > 0.4999f && carried[v] < 0.5001f); /* weights sum to 1 */
  CHECK_REFUSED(focal_correspondence_points(map, VERTICES - 1, points), FOCAL_ERROR_INVALID_ARGUMENT,
                "vertex_count is");
  CHECK_REFUSED(focal_correspondence_carry(map, VERTICES + 1, values, VERTICES, carried),
                FOCAL_ERROR_INVALID_ARGUMENT, "target_vertex_count is");
  CHECK_REFUSED(focal_correspondence_carry(map, VERTICES, values, VERTICES - 1, carried),
                FOCAL_ERROR_INVALID_ARGUMENT, "vertex_count is");
  CHECK_REFUSED(focal_correspondence_points(map, VERTICES, NULL), FOCAL_ERROR_INVALID_ARGUMENT,
                "out_points is NULL");
  CHECK_OK(focal_correspondence_destroy(map));
}

/* Many at once are the same as one after the other; all of them or none. */
static void check_many(const focal_model* model, const focal_mesh* mesh) {
  const focal_mesh* meshes[5] = {mesh, mesh, mesh, mesh, mesh};
  focal_detection *many[5] = {NULL}, *one = NULL;
  static float votes[VERTICES], expected[VERTICES];
  focal_detect_params params;
  focal_surface_point fixed[3] = {{0, {1, 0, 0}}, {0, {1, 0, 0}}, {0, {1, 0, 0}}};
  focal_task* task = NULL;
  CHECK_OK(focal_model_detect(model, mesh, NULL, NULL, &one));
  CHECK_OK(focal_detection_votes(one, 1, VERTICES, expected));
  CHECK_OK(focal_task_create(&task));
  CHECK_OK(focal_model_detect_many(model, meshes, 5, NULL, task, many));
  CHECK(focal_task_progress(task) == 1);
  for (int i = 0; i < 5; ++i) {
    CHECK_OK(focal_detection_votes(many[i], 1, VERTICES, votes));
    CHECK(memcmp(votes, expected, sizeof votes) == 0);
    CHECK_OK(focal_detection_destroy(many[i]));
    many[i] = NULL;
  }
  CHECK_OK(focal_model_detect_many(model, meshes, 0, NULL, NULL, many));
  CHECK_OK(focal_task_cancel(task));
  CHECK_REFUSED(focal_model_detect_many(model, meshes, 5, NULL, task, many), FOCAL_ERROR_CANCELLED, "");
  meshes[3] = NULL;
  CHECK_REFUSED(focal_model_detect_many(model, meshes, 5, NULL, NULL, many), FOCAL_ERROR_INVALID_HANDLE, "");
  CHECK_OK(focal_detect_params_init(&params, sizeof params));
  params.fixed_points = fixed, params.fixed_point_count = 3;
  CHECK_REFUSED(focal_model_detect_many(model, meshes, 3, &params, NULL, many), FOCAL_ERROR_INVALID_ARGUMENT,
                "belong to one mesh");
  CHECK_REFUSED(focal_model_detect_many(model, NULL, 3, NULL, NULL, many), FOCAL_ERROR_INVALID_ARGUMENT,
                "meshes is NULL");
  CHECK(!many[0] && !many[4]);
  focal_detection_destroy(one);
  focal_task_destroy(task);
}

static void check_parts(const focal_detection* detection) {
  static int32_t labels[TRIANGLES];
  focal_mesh* mesh = NULL;
  focal_mesh_info info;
  for (focal_segmentation method = FOCAL_SEGMENTATION_AUTO; method <= FOCAL_SEGMENTATION_K_MEANS; ++method) {
    if (method == FOCAL_SEGMENTATION_SKELETON) continue;
    int seen = 0;
    CHECK_OK(focal_detection_segment(detection, method, NULL, TRIANGLES, labels));
    for (int t = 0; t < TRIANGLES; ++t) seen |= labels[t] >= 0 && labels[t] < 3 ? 1 << labels[t] : 8;
    CHECK((seen & 7) == 7); /* each landmark has a part */
  }
  CHECK_REFUSED(focal_detection_segment(detection, 99, NULL, TRIANGLES, labels), FOCAL_ERROR_INVALID_ARGUMENT,
                "method is 99");
  CHECK_REFUSED(focal_detection_segment(detection, FOCAL_SEGMENTATION_AUTO, NULL, TRIANGLES - 1, labels),
                FOCAL_ERROR_INVALID_ARGUMENT, "triangle_count is");
  CHECK_REFUSED(focal_detection_segment(detection, FOCAL_SEGMENTATION_SKELETON, NULL, TRIANGLES, labels),
                FOCAL_ERROR_INVALID_ARGUMENT, "");
  CHECK_REFUSED(focal_detection_write_segments_gltf(detection, FOCAL_SEGMENTATION_AUTO, "parts.gltf"),
                FOCAL_ERROR_INVALID_ARGUMENT, "written as .glb");
  CHECK_OK(
      focal_detection_write_segments_gltf(detection, FOCAL_SEGMENTATION_AUTO, "detection_test_parts.glb"));
  CHECK_OK(focal_mesh_load_gltf(context, "detection_test_parts.glb", NULL, &mesh));
  CHECK_OK(focal_mesh_info_init(&info, sizeof info));
  CHECK_OK(focal_mesh_get_info(mesh, &info));
  CHECK(info.vertex_count == 3 * TRIANGLES &&
        info.surface_vertex_count == VERTICES); /* corners of their own */
  focal_mesh_destroy(mesh);
  remove("detection_test_parts.glb");
}

/* The model looks at 150 vertices, the mesh has more: maps are carried over, and each still has its peak of 1. */
static void check_votes(const focal_detection* detection) {
  static float votes[VERTICES];
  for (uint32_t l = 0; l < SHAPE_MARKS; ++l) {
    float largest = 0;
    CHECK_OK(focal_detection_votes(detection, l, VERTICES, votes));
    for (int v = 0; v < VERTICES; ++v) {
      CHECK(votes[v] >= 0 && votes[v] <= 1);
      if (votes[v] > largest) largest = votes[v];
    }
    CHECK(largest == 1);
  }
}

/* Distances begin at the landmark, be it on the first triangle; a vertex that no triangle uses has no votes. */
static void check_first_triangle(const focal_model* model) {
  shape body = shape_create(RINGS, 0.04f);
  float* more = malloc((VERTICES + 1) * 3 * sizeof *more);
  static float values[VERTICES + 1];
  memcpy(more, body.positions, VERTICES * 3 * sizeof *more);
  for (int i = 0; i < 3; ++i) more[3 * VERTICES + i] = 9;
  focal_mesh_desc desc = shape_desc(&body);
  desc.positions = more, desc.vertex_count = VERTICES + 1;
  focal_mesh* mesh = NULL;
  CHECK_OK(focal_mesh_create(context, &desc, NULL, &mesh));
  focal_surface_point fixed[SHAPE_MARKS] = {
      {0, {1, 0, 0}}, {FOCAL_NO_TRIANGLE, {0, 0, 0}}, {FOCAL_NO_TRIANGLE, {0, 0, 0}}};
  focal_detect_params params;
  focal_detection* detection = NULL;
  focal_landmark landmark;
  CHECK_OK(focal_detect_params_init(&params, sizeof params));
  params.fixed_points = fixed, params.fixed_point_count = SHAPE_MARKS;
  CHECK_OK(focal_model_detect(model, mesh, &params, NULL, &detection));
  CHECK_OK(focal_landmark_init(&landmark, sizeof landmark));
  CHECK_OK(focal_detection_get_landmark(detection, 0, &landmark));
  CHECK(landmark.point.triangle == 0 && landmark.vertex == body.indices[0]);
  CHECK_OK(focal_detection_distances(detection, 0, VERTICES + 1, values));
  CHECK(values[body.indices[0]] < 0.1f && values[body.marks[2]] > 0.5f);
  CHECK_OK(focal_detection_votes(detection, 1, VERTICES + 1, values));
  CHECK(values[VERTICES] == 0);
  focal_detection_destroy(detection);
  focal_mesh_destroy(mesh);
  free(more);
  shape_destroy(&body);
}

/* A tetrahedron's worth of JSON is enough: the file is written as the kind it was read as. */
static void check_text_file(const focal_model* model) {
  size_t size = 0;
  shape body = shape_create(RINGS, 0.04f);
  unsigned char* glb = shape_glb(&body, &size);
  uint32_t json_size = 0;
  memcpy(&json_size, glb + 12, 4);
  const unsigned char* bin = glb + 20 + json_size + 8;
  const size_t bin_size = size - (size_t)(bin - glb);
  /* The JSON, with the chunk as a data URI in its buffer. */
  char* text = malloc(size * 2 + 256);
  char* at = text;
  const char* json = (const char*)glb + 20;
  const char* buffer = strstr(json, "\"byteLength\":");
  for (const char* next = buffer; next && next < json + json_size; next = strstr(next + 1, "\"byteLength\":"))
    if (strstr(json, "\"buffers\":") < next && next - strstr(json, "\"buffers\":") < 20) buffer = next;
  memcpy(at, json, (size_t)(buffer - json)), at += buffer - json;
  at += sprintf(at, "\"uri\":\"data:;base64,");
  static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (size_t i = 0; i < bin_size / 3 * 3; i += 3) {
    const uint32_t bits = (uint32_t)bin[i] << 16 | (uint32_t)bin[i + 1] << 8 | bin[i + 2];
    for (int shift = 18; shift >= 0; shift -= 6) *at++ = digits[bits >> shift & 63];
  }
  if (bin_size % 3 == 1) *at++ = digits[bin[bin_size - 1] >> 2], *at++ = digits[(bin[bin_size - 1] & 3) << 4];
  if (bin_size % 3 == 2) {
    const uint32_t bits = (uint32_t)bin[bin_size - 2] << 16 | (uint32_t)bin[bin_size - 1] << 8;
    for (int shift = 18; shift >= 6; shift -= 6) *at++ = digits[bits >> shift & 63];
  }
  at += sprintf(at, "\",");
  memcpy(at, buffer, (size_t)(json + json_size - buffer)), at += json + json_size - buffer;
  focal_mesh *mesh = NULL, *again = NULL;
  CHECK_OK(focal_mesh_load_gltf_memory(context, text, (uint64_t)(at - text), NULL, &mesh));
  focal_detection* detection = detect(model, mesh);
  CHECK_REFUSED(focal_detection_write_gltf(detection, "x.glb"), FOCAL_ERROR_INVALID_ARGUMENT,
                "written as .gltf");
  CHECK_OK(focal_detection_write_gltf(detection, "detection_test.gltf"));
  CHECK_OK(focal_mesh_load_gltf(context, "detection_test.gltf", NULL, &again));
  if (again) CHECK(memcmp(focal_mesh_positions(again), body.positions, VERTICES * 12) == 0);
  remove("detection_test.gltf");
  focal_mesh_destroy(again), focal_mesh_destroy(mesh), focal_detection_destroy(detection);
  free(text), free(glb);
  shape_destroy(&body);
}

int main(void) {
  CHECK_OK(focal_context_create(NULL, &context));
  focal_training_set* set = shape_training_set(context, RINGS, 3);
  focal_model* model = shape_model(set);
  focal_mesh *first = shape_mesh(context, RINGS, 0.02f), *second = shape_mesh(context, RINGS, 0.07f);
  focal_detection *from = detect(model, first), *to = detect(model, second);
  check_correspondence(from, to);
  check_parts(from);
  check_votes(from);
  check_first_triangle(model);
  check_many(model, first);
  check_text_file(model);
  focal_detection_destroy(from), focal_detection_destroy(to);
  focal_mesh_destroy(first), focal_mesh_destroy(second);
  focal_model_destroy(model);
  focal_training_set_destroy(set);
  focal_context_destroy(context);
  FINISH();
}
