/* One small model through its whole life: train, save, load, damage, detect, write. */
#include <math.h>
#include <stdlib.h>

#include "check.h"
#include "shapes.h"

enum { RINGS = 14, SHAPES = 4 };

static focal_context* context;

static focal_model* train(void) {
  focal_train_params params;
  focal_model* model = NULL;
  focal_training_set* set = shape_training_set(context, RINGS, SHAPES);
  CHECK_OK(focal_train_params_init(&params, sizeof params));
  params.eigenpair_count = 60;
  params.tree_count = 8;
  params.seed = 7;
  CHECK_OK(focal_model_train(set, &params, NULL, &model));
  focal_training_set_destroy(set);
  return model;
}

static void check_info(const focal_model* model) {
  focal_model_info info;
  focal_train_params params;
  CHECK_OK(focal_model_info_init(&info, sizeof info));
  CHECK_OK(focal_model_get_info(model, &info));
  CHECK(info.landmark_count == SHAPE_MARKS && info.shape_count == SHAPES &&
        info.preset == FOCAL_PRESET_DEFAULT);
  CHECK(info.mean_vertex_count == 2 * RINGS * RINGS + 2);
  CHECK(info.sample_count > 0 && info.tree_node_count > 0 && info.file_bytes > 100);
  CHECK_OK(focal_train_params_init(&params, sizeof params));
  CHECK_OK(focal_model_get_train_params(model, &params));
  CHECK(params.eigenpair_count == 60 && params.tree_count == 8 && params.seed == 7);
  CHECK(strcmp(focal_model_landmark_name(model, 1), "hand.L") == 0);
  CHECK(focal_model_landmark_name(model, SHAPE_MARKS) == NULL);
  CHECK(strstr(focal_last_error(), "the model has 3 landmarks, there is no number 3"));
}

static void check_files(const focal_model* model) {
  focal_model* loaded = NULL;
  focal_blob *blob = NULL, *again = NULL;
  CHECK_OK(focal_model_save_memory(model, &blob));
  const size_t size = (size_t)focal_blob_size(blob);
  unsigned char* bytes = malloc(size);
  memcpy(bytes, focal_blob_data(blob), size);
  CHECK_OK(focal_model_load_memory(context, bytes, size, &loaded));
  CHECK_OK(focal_model_save_memory(loaded, &again));
  CHECK(focal_blob_size(again) == size && memcmp(focal_blob_data(again), bytes, size) == 0);
  focal_model_destroy(loaded), loaded = NULL;
  CHECK_OK(focal_model_save(model, "model_test.focal"));
  CHECK_OK(focal_model_load(context, "model_test.focal", &loaded));
  check_info(loaded);
  focal_model_destroy(loaded), loaded = NULL;

  CHECK_REFUSED(focal_model_load_memory(context, bytes, size / 2, &loaded), FOCAL_ERROR_INVALID_FILE, "");
  CHECK_REFUSED(focal_model_load_memory(context, "nothing like a model", 20, &loaded),
                FOCAL_ERROR_INVALID_FILE, "");
  bytes[size / 2] ^= 1;
  CHECK_REFUSED(focal_model_load_memory(context, bytes, size, &loaded), FOCAL_ERROR_INVALID_FILE, "");
  bytes[size / 2] ^= 1;
  bytes[12] = 77; /* the major version: magic, byte order, then it */
  CHECK_REFUSED(focal_model_load_memory(context, bytes, size, &loaded), FOCAL_ERROR_UNSUPPORTED_VERSION,
                "77");
  CHECK_REFUSED(focal_model_load(context, "no_such.focal", &loaded), FOCAL_ERROR_FILE_NOT_FOUND,
                "no_such.focal");
  CHECK_REFUSED(focal_model_save(model, "no/such/folder/x.focal"), FOCAL_ERROR_FILE_NOT_FOUND,
                "no/such/folder");
  CHECK_REFUSED(focal_model_save(model, NULL), FOCAL_ERROR_INVALID_ARGUMENT, "path is NULL");
  CHECK(loaded == NULL);
  free(bytes);
  focal_blob_destroy(blob);
  focal_blob_destroy(again);
}

/* The limbs of a shape between the training shapes are found, close to where they are. */
static void check_landmarks(const focal_detection* detection, const shape* body) {
  focal_landmark landmark;
  CHECK(focal_detection_landmark_count(detection) == SHAPE_MARKS);
  CHECK_OK(focal_landmark_init(&landmark, sizeof landmark));
  for (uint32_t i = 0; i < SHAPE_MARKS; ++i) {
    CHECK_OK(focal_detection_get_landmark(detection, i, &landmark));
    CHECK(landmark.struct_size == sizeof landmark && strcmp(landmark.name, shape_mark_names[i]) == 0);
    CHECK(landmark.confidence >= 0 && landmark.confidence <= 1 && landmark.expected_error >= 0);
    CHECK(landmark.point.triangle < body->index_count / 3 && landmark.vertex < body->vertex_count);
    const float* marked = body->positions + 3 * body->marks[i];
    float squared = 0;
    for (int k = 0; k < 3; ++k)
      squared += (landmark.position[k] - marked[k]) * (landmark.position[k] - marked[k]);
    CHECK(squared < 0.5f * 0.5f);
  }
  CHECK_REFUSED(focal_detection_get_landmark(detection, SHAPE_MARKS, &landmark), FOCAL_ERROR_INVALID_ARGUMENT,
                "the detection has 3 landmarks, there is no number 3");
  landmark.struct_size = 8;
  CHECK_REFUSED(focal_detection_get_landmark(detection, 0, &landmark), FOCAL_ERROR_INVALID_ARGUMENT,
                "struct_size is 8");
}

static void check_votes(const focal_detection* detection, const shape* body) {
  float* votes = malloc(body->vertex_count * sizeof *votes);
  float largest = 0;
  CHECK_OK(focal_detection_votes(detection, 0, body->vertex_count, votes));
  for (uint64_t v = 0; v < body->vertex_count; ++v) largest = votes[v] > largest ? votes[v] : largest;
  CHECK(largest == 1);
  CHECK_REFUSED(focal_detection_votes(detection, 0, 5, votes), FOCAL_ERROR_INVALID_ARGUMENT,
                "vertex_count is 5");
  CHECK_REFUSED(focal_detection_votes(detection, 9, body->vertex_count, votes), FOCAL_ERROR_INVALID_ARGUMENT,
                "no number 9");
  free(votes);
}

/* Distances start at the landmark and grow past the straight way; the region is what lies within the radius. */
static void check_regions(const focal_detection* detection, const shape* body) {
  focal_mesh* mesh = shape_mesh(context, RINGS, 0.07f);
  focal_landmark landmark;
  focal_mesh_info info;
  float* distances = malloc(body->vertex_count * sizeof *distances);
  float* region = malloc(body->vertex_count * sizeof *region);
  CHECK_OK(focal_landmark_init(&landmark, sizeof landmark));
  CHECK_OK(focal_detection_get_landmark(detection, 1, &landmark));
  CHECK_OK(focal_mesh_info_init(&info, sizeof info));
  CHECK_OK(focal_mesh_get_info(mesh, &info));
  const double radius = 0.3 * sqrt(info.surface_area), edge = info.mean_edge_length;
  CHECK_OK(focal_detection_distances(detection, 1, body->vertex_count, distances));
  CHECK_OK(focal_detection_region(detection, 1, 0.3, body->vertex_count, region));
  CHECK(distances[landmark.vertex] < edge);
  int inside = 0, outside = 0;
  for (uint64_t v = 0; v < body->vertex_count; ++v) {
    double squared = 0;
    for (int k = 0; k < 3; ++k)
      squared += pow(landmark.position[k] - body->positions[3 * v + (uint64_t)k], 2);
    CHECK(distances[v] > 0.9 * sqrt(squared) - edge && distances[v] < 20 * edge * RINGS);
    CHECK(region[v] >= 0 && region[v] <= 1);
    const int is_inside = distances[v]<radius - edge, is_outside = distances[v]> radius + edge;
    CHECK(!is_inside || region[v] == 1);
    CHECK(!is_outside || region[v] == 0);
    inside += is_inside, outside += is_outside;
  }
  CHECK(inside > 5 && outside > 5);
  CHECK_REFUSED(focal_detection_distances(detection, 0, 5, distances), FOCAL_ERROR_INVALID_ARGUMENT,
                "vertex_count is 5");
  CHECK_REFUSED(focal_detection_distances(detection, 9, body->vertex_count, distances),
                FOCAL_ERROR_INVALID_ARGUMENT, "no number 9");
  CHECK_REFUSED(focal_detection_region(detection, 0, -1, body->vertex_count, region),
                FOCAL_ERROR_INVALID_ARGUMENT, "radius is -1");
  CHECK_REFUSED(focal_detection_region(detection, 0, (double)NAN, body->vertex_count, region),
                FOCAL_ERROR_INVALID_ARGUMENT, "radius");
  CHECK_REFUSED(focal_detection_region(detection, 0, 1, body->vertex_count, NULL),
                FOCAL_ERROR_INVALID_ARGUMENT, "out_membership");
  free(distances), free(region);
  focal_mesh_destroy(mesh);
}

static void check_summary(const focal_detection* detection, const shape* body) {
  focal_detection_info info;
  focal_stage_seconds seconds;
  CHECK_OK(focal_detection_info_init(&info, sizeof info));
  CHECK_OK(focal_detection_get_info(detection, &info));
  CHECK(info.vertex_count == body->vertex_count && info.triangle_count * 3 == body->index_count);
  CHECK(info.category_fit >= 0 && info.category_fit <= 1 && info.has_votes == 1);
  CHECK(info.backend == FOCAL_BACKEND_CPU || info.backend == FOCAL_BACKEND_CUDA);
  CHECK(focal_detection_warning(detection, info.warning_count) == NULL);
  CHECK_OK(focal_stage_seconds_init(&seconds, sizeof seconds));
  CHECK_OK(focal_detection_get_seconds(detection, &seconds));
  CHECK(seconds.spectrum > 0 && seconds.total >= seconds.spectrum + seconds.load + seconds.repair);
}

/* What is written can be read again and has the same triangles; vertices may not move. */
static void check_written(const char* path, const shape* body) {
  focal_mesh* mesh = NULL;
  CHECK_OK(focal_mesh_load_gltf(context, path, NULL, &mesh));
  if (mesh) CHECK(memcmp(focal_mesh_positions(mesh), body->positions, body->vertex_count * 12) == 0);
  focal_mesh_destroy(mesh);
}

static void check_detection(const focal_model* model) {
  shape body = shape_create(RINGS, 0.07f);
  size_t size = 0;
  unsigned char* glb = shape_glb(&body, &size);
  focal_mesh *mesh = shape_mesh(context, RINGS, 0.07f), *from_file = NULL;
  focal_detection *detection = NULL, *of_file = NULL;
  CHECK_OK(focal_mesh_load_gltf_memory(context, glb, size, NULL, &from_file));
  CHECK_OK(focal_model_detect(model, mesh, NULL, NULL, &detection));
  CHECK_OK(focal_model_detect(model, from_file, NULL, NULL, &of_file));
  focal_mesh_destroy(mesh), focal_mesh_destroy(from_file); /* the detections keep what they need */
  check_landmarks(detection, &body);
  check_votes(detection, &body);
  check_regions(detection, &body);
  check_summary(detection, &body);
  CHECK_OK(focal_detection_write_gltf(detection, "model_test_arrays.glb"));
  check_written("model_test_arrays.glb", &body);
  CHECK_OK(focal_detection_write_gltf(of_file, "model_test_file.glb"));
  check_written("model_test_file.glb", &body);
  CHECK_OK(focal_detection_write_votes_gltf(detection, "model_test_votes.glb"));
  CHECK_REFUSED(focal_detection_write_gltf(of_file, "x.gltf"), FOCAL_ERROR_INVALID_ARGUMENT,
                "written as .glb");
  CHECK_REFUSED(focal_detection_write_gltf(of_file, "no/such/x.glb"), FOCAL_ERROR_FILE_NOT_FOUND, "no/such");
  focal_detection_destroy(detection);
  focal_detection_destroy(of_file);
  free(glb);
  shape_destroy(&body);
}

static void check_detect_params(const focal_model* model) {
  focal_mesh* mesh = shape_mesh(context, RINGS, 0.07f);
  focal_detection* detection = NULL;
  focal_detect_params params;
  float votes[1];
  CHECK_OK(focal_detect_params_init(&params, sizeof params));
  CHECK(params.quality == FOCAL_QUALITY_BEST && params.keep_votes == 1);
  params.absent_confidence = 0.9;
  CHECK_REFUSED(focal_model_detect(model, mesh, &params, NULL, &detection), FOCAL_ERROR_INVALID_ARGUMENT,
                "absent_confidence is 0.9");
  CHECK_REFUSED(focal_model_detect(NULL, mesh, NULL, NULL, &detection), FOCAL_ERROR_INVALID_HANDLE,
                "focal_model is NULL");
  CHECK_REFUSED(focal_model_detect(model, NULL, NULL, NULL, &detection), FOCAL_ERROR_INVALID_HANDLE,
                "focal_mesh is NULL");
  params.absent_confidence = 0.05, params.keep_votes = 0;
  CHECK_OK(focal_model_detect(model, mesh, &params, NULL, &detection));
  CHECK_REFUSED(focal_detection_votes(detection, 0, 2 * RINGS * RINGS + 2, votes), FOCAL_ERROR_UNSUPPORTED,
                "no vote maps");
  CHECK_REFUSED(focal_detection_write_votes_gltf(detection, "x.glb"), FOCAL_ERROR_UNSUPPORTED,
                "no vote maps");
  focal_detection_destroy(detection);
  focal_mesh_destroy(mesh);
}

/* No mesh is given: an error about the mesh shows that the parameters were accepted. */
static focal_status detect_nothing(const focal_model* model, const focal_detect_params* params) {
  focal_detection* detection = NULL;
  return focal_model_detect(model, NULL, params, NULL, &detection);
}

/* A field takes the two values in the middle; the ones around them are refused by its name. */
#define DETECT(field, below, least, most, above)                                         \
  do {                                                                                   \
    const double values[] = {below, least, most, above};                                 \
    for (int i = 0; i < 4; ++i) {                                                        \
      focal_detect_params params;                                                        \
      CHECK_OK(focal_detect_params_init(&params, sizeof params));                        \
      params.field = values[i];                                                          \
      const int taken = i == 1 || i == 2;                                                \
      CHECK_REFUSED(detect_nothing(model, &params),                                      \
                    taken ? FOCAL_ERROR_INVALID_HANDLE : FOCAL_ERROR_INVALID_ARGUMENT,   \
                    taken ? "focal_mesh is NULL" : "focal_detect_params." #field " is"); \
    }                                                                                    \
  } while (0)

static void check_detect_ranges(const focal_model* model) {
  DETECT(quality, -1, 0, 1, 2);
  DETECT(sampling_rate, -0.5, 0, 1, 1.5);
  DETECT(max_samples, 0, 1, INT32_MAX, -1);
  DETECT(peaks_per_landmark, 0, 1, 64, 65);
  DETECT(found_confidence, -0.5, 0.5, 1, 1.5);
  DETECT(absent_confidence, -0.5, 0, 0.25, 1);
  DETECT(keep_votes, -1, 0, 1, 2);
  DETECT(orientation, -1, FOCAL_ORIENTATION_UPRIGHT, FOCAL_ORIENTATION_ANY, 2);
  focal_detect_params params;
  focal_detection* detection = NULL;
  CHECK_OK(focal_detect_params_init(&params, sizeof params));
  params.found_confidence = params.absent_confidence = 0;
  CHECK_REFUSED(focal_model_detect(model, NULL, &params, NULL, &detection), FOCAL_ERROR_INVALID_HANDLE,
                "focal_mesh is NULL");
}

static void check_fixed_points(const focal_model* model) {
  shape body = shape_create(RINGS, 0.07f);
  focal_mesh* mesh = shape_mesh(context, RINGS, 0.07f);
  focal_detection* detection = NULL;
  focal_detect_params params;
  focal_landmark landmark;
  focal_surface_point points[SHAPE_MARKS];
  CHECK_OK(focal_detect_params_init(&params, sizeof params));
  CHECK(params.fixed_points == NULL && params.fixed_point_count == 0);
  for (int i = 0; i < SHAPE_MARKS; ++i) points[i].triangle = FOCAL_NO_TRIANGLE;
  CHECK_OK(focal_mesh_point_at_vertex(mesh, body.marks[0] + 1,
                                      &points[0])); /* beside the place that it would find */
  params.fixed_points = points, params.fixed_point_count = SHAPE_MARKS;
  CHECK_OK(focal_model_detect(model, mesh, &params, NULL, &detection));
  CHECK_OK(focal_landmark_init(&landmark, sizeof landmark));
  CHECK_OK(focal_detection_get_landmark(detection, 0, &landmark));
  CHECK(landmark.status == FOCAL_LANDMARK_FOUND && landmark.confidence == 1 && landmark.expected_error == 0);
  CHECK(landmark.vertex == body.marks[0] + 1 && landmark.point.triangle == points[0].triangle);
  focal_detection_destroy(detection), detection = NULL;
  params.fixed_point_count = 2;
  CHECK_REFUSED(focal_model_detect(model, mesh, &params, NULL, &detection), FOCAL_ERROR_INVALID_ARGUMENT,
                "fixed_point_count is 2, the model has 3 landmarks");
  params.fixed_point_count = SHAPE_MARKS, params.fixed_points = NULL;
  CHECK_REFUSED(focal_model_detect(model, mesh, &params, NULL, &detection), FOCAL_ERROR_INVALID_ARGUMENT,
                "fixed_points is NULL");
  params.fixed_points = points, points[1].triangle = 1u << 30;
  CHECK_REFUSED(focal_model_detect(model, mesh, &params, NULL, &detection), FOCAL_ERROR_INVALID_LANDMARK,
                "fixed landmark");
  CHECK(detection == NULL);
  focal_mesh_destroy(mesh);
  shape_destroy(&body);
}

int main(void) {
  CHECK_OK(focal_context_create(NULL, &context));
  focal_model* model = train();
  if (model) {
    focal_context* keep = context; /* a model outlives its context's handle */
    check_info(model);
    check_files(model);
    check_detection(model);
    check_detect_params(model);
    check_detect_ranges(model);
    check_fixed_points(model);
    focal_context_destroy(keep);
    focal_model_info info;
    CHECK_OK(focal_model_info_init(&info, sizeof info));
    CHECK_OK(focal_model_get_info(model, &info));
  }
  focal_model_destroy(model);
  FINISH();
}
