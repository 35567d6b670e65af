/* Descriptors and distances by number, in training and to look at; planes and regressed distances; misuse. */
#include <math.h>
#include <stdlib.h>

#include "check.h"
#include "shapes.h"

enum { RINGS = 12, SHAPES = 4 };

static focal_context* context;

static focal_status try_train(focal_preset preset, int32_t descriptor, int32_t distance, focal_model** out) {
  focal_train_params params;
  focal_training_set* set = shape_training_set(context, RINGS, SHAPES);
  CHECK_OK(focal_train_params_init(&params, sizeof params));
  CHECK_OK(focal_train_params_set_preset(&params, preset));
  params.tree_count = 4;
  params.eigenpair_count = 60;
  params.learn_confidence = 0;
  params.descriptor = descriptor;
  params.distance = distance;
  focal_status status = focal_model_train(set, &params, NULL, out);
  focal_training_set_destroy(set);
  return status;
}

/* Mean error of the landmarks in mean edges. */
static double error_of(const focal_model* model, const shape* truth, const focal_mesh* mesh) {
  focal_detection* detection = NULL;
  focal_mesh_info info;
  double sum = 0;
  CHECK_OK(focal_mesh_info_init(&info, sizeof info));
  CHECK_OK(focal_mesh_get_info(mesh, &info));
  CHECK_OK(focal_model_detect(model, mesh, NULL, NULL, &detection));
  for (uint32_t i = 0; i < SHAPE_MARKS; ++i) {
    focal_landmark found;
    const float* mark = truth->positions + 3 * truth->marks[i];
    CHECK_OK(focal_landmark_init(&found, sizeof found));
    CHECK_OK(focal_detection_get_landmark(detection, i, &found));
    double d = 0;
    for (int k = 0; k < 3; ++k) d += (found.position[k] - mark[k]) * (found.position[k] - mark[k]);
    sum += sqrt(d) / info.mean_edge_length / SHAPE_MARKS;
  }
  focal_detection_destroy(detection);
  return sum;
}

/* Every choice trains, is kept in the model's file and detects; the ends of three unlike limbs are easy. */
static void check_choices(focal_mesh* mesh, const shape* truth) {
  for (int32_t i = 0; i < 9; ++i) {
    if (i == 5) continue; /* si-hks and heat once more */
    const int32_t descriptor = i < 5 ? i : 0, distance = i < 5 ? 0 : i - 5;
    for (focal_preset preset = FOCAL_PRESET_DEFAULT; preset <= FOCAL_PRESET_PAPER; ++preset) {
      focal_model *model = NULL, *loaded = NULL;
      focal_train_params kept;
      if (preset == FOCAL_PRESET_DEFAULT && distance >= FOCAL_DISTANCE_BIHARMONIC) {
        CHECK_REFUSED(try_train(preset, descriptor, distance, &model), FOCAL_ERROR_UNSUPPORTED,
                      "is not geodesic");
        continue;
      }
      CHECK_OK(try_train(preset, descriptor, distance, &model));
      CHECK_OK(focal_model_save(model, "measures_test.focal"));
      CHECK_OK(focal_model_load(context, "measures_test.focal", &loaded));
      CHECK_OK(focal_train_params_init(&kept, sizeof kept));
      CHECK_OK(focal_model_get_train_params(loaded, &kept));
      CHECK(kept.descriptor == descriptor && kept.distance == distance);
      const double error = error_of(loaded, truth, mesh);
      printf("preset %d, %s, %s: %.2f edges\n", preset, focal_descriptor_name(descriptor),
             focal_distance_name(distance), error);
      CHECK(error < (distance >= FOCAL_DISTANCE_BIHARMONIC ? 10 : 6)); /* of about 40 from end to end */
      focal_model_destroy(model);
      focal_model_destroy(loaded);
    }
  }
  focal_model* model = NULL;
  CHECK_REFUSED(try_train(FOCAL_PRESET_PAPER, 99, 0, &model), FOCAL_ERROR_INVALID_ARGUMENT,
                "descriptor is 99");
  CHECK_REFUSED(try_train(FOCAL_PRESET_PAPER, 0, -1, &model), FOCAL_ERROR_INVALID_ARGUMENT, "distance is -1");
}

static void check_lists(void) {
  CHECK(focal_descriptor_count() >= 5 && focal_distance_count() >= 4);
  CHECK(strcmp(focal_descriptor_name(FOCAL_DESCRIPTOR_WKS), "wks") == 0);
  CHECK(strcmp(focal_distance_name(FOCAL_DISTANCE_EXACT), "exact") == 0);
  CHECK(focal_descriptor_dimension(FOCAL_DESCRIPTOR_SI_HKS) == 96);
  CHECK(focal_descriptor_name(-1) == NULL && focal_distance_name(1000) == NULL);
  CHECK(focal_descriptor_dimension(1000) == 0);
}

static void check_measures(focal_mesh* mesh, const shape* truth) {
  float values[2 * 96], *near = malloc(truth->vertex_count * sizeof *near),
                        *exact = malloc(truth->vertex_count * sizeof *exact);
  focal_surface_point point, none = {12345678, {1, 0, 0}};
  focal_symmetry_plane plane;
  const uint32_t ends[2] = {truth->marks[0], truth->marks[1]}, far = 99999999;
  CHECK_OK(focal_mesh_describe(context, mesh, FOCAL_DESCRIPTOR_HKS, ends, 2, NULL, values));
  CHECK(values[0] > 0 && values[96] > 0 && values[0] != values[96]);
  CHECK_REFUSED(focal_mesh_describe(context, mesh, 77, ends, 2, NULL, values), FOCAL_ERROR_INVALID_ARGUMENT,
                "descriptors");
  CHECK_REFUSED(focal_mesh_describe(context, mesh, 0, &far, 1, NULL, values), FOCAL_ERROR_INVALID_LANDMARK,
                "99999999");
  CHECK_OK(focal_mesh_point_at_vertex(mesh, ends[0], &point));
  CHECK_OK(focal_mesh_distances(context, mesh, FOCAL_DISTANCE_HEAT, &point, NULL, truth->vertex_count, near));
  CHECK_OK(
      focal_mesh_distances(context, mesh, FOCAL_DISTANCE_EXACT, &point, NULL, truth->vertex_count, exact));
  double off = 0, largest = 0;
  for (uint64_t v = 0; v < truth->vertex_count; ++v) {
    off += fabs(near[v] - exact[v]) / (double)truth->vertex_count;
    if (exact[v] > largest) largest = exact[v];
  }
  CHECK(exact[ends[0]] == 0 && largest > 0 && off < 0.05 * largest);
  CHECK_REFUSED(focal_mesh_distances(context, mesh, 0, &none, NULL, truth->vertex_count, near),
                FOCAL_ERROR_INVALID_LANDMARK, "source");
  CHECK_REFUSED(focal_mesh_distances(context, mesh, 0, &point, NULL, 3, near), FOCAL_ERROR_INVALID_ARGUMENT,
                "vertex_count is 3");
  CHECK_OK(focal_symmetry_plane_init(&plane, sizeof plane));
  focal_task* task = NULL;
  CHECK_OK(focal_task_create(&task));
  CHECK_OK(focal_mesh_symmetry_plane(context, mesh, 1, task, &plane));
  CHECK(focal_task_progress(task) == 1 && strcmp(focal_task_stage(task), "done") == 0);
  CHECK_OK(focal_task_cancel(task));
  CHECK_REFUSED(focal_mesh_symmetry_plane(context, mesh, 1, task, &plane), FOCAL_ERROR_CANCELLED,
                "cancelled");
  CHECK(focal_task_progress(task) < 1 || strcmp(focal_task_stage(task), "done") != 0);
  CHECK_OK(focal_task_destroy(task));
  double length = 0;
  for (int k = 0; k < 3; ++k) length += plane.normal[k] * plane.normal[k];
  CHECK(fabs(length - 1) < 1e-5 && plane.support > 0.3 && plane.support <= 1);
  free(near);
  free(exact);
}

static void check_regression(focal_mesh* mesh, const shape* truth) {
  for (focal_preset preset = FOCAL_PRESET_DEFAULT; preset <= FOCAL_PRESET_PAPER; ++preset) {
    focal_model* model = NULL;
    focal_analysis* analysis = NULL;
    focal_surface_point place;
    CHECK_OK(try_train(preset, 0, 0, &model));
    CHECK_OK(focal_model_analyse(model, mesh, NULL, NULL, &analysis));
    const uint64_t count = focal_analysis_sample_count(analysis);
    CHECK(count >= 100);
    float *regressed = malloc(count * sizeof *regressed), *real = malloc(count * sizeof *real);
    CHECK_OK(focal_mesh_point_at_vertex(mesh, truth->marks[1], &place));
    CHECK_OK(focal_model_regress(model, analysis, 1, &place, NULL, count, regressed, real));
    double off = 0, mean = 0, spread = 0;
    for (uint64_t s = 0; s < count; ++s) mean += real[s] / (double)count;
    for (uint64_t s = 0; s < count; ++s)
      off += pow(regressed[s] - real[s], 2), spread += pow(real[s] - mean, 2);
    printf("preset %d: regression leaves %.3f of the variance\n", preset, off / spread);
    CHECK(off < 0.9 * spread);
    CHECK_REFUSED(focal_model_regress(model, analysis, 9, &place, NULL, count, regressed, real),
                  FOCAL_ERROR_INVALID_ARGUMENT, "landmarks");
    CHECK_REFUSED(focal_model_regress(model, analysis, 1, &place, NULL, count + 1, regressed, real),
                  FOCAL_ERROR_INVALID_ARGUMENT, "sample_count");
    free(regressed);
    free(real);
    focal_analysis_destroy(analysis);
    focal_model_destroy(model);
  }
}

int main(void) {
  CHECK_OK(focal_context_create(NULL, &context));
  shape truth = shape_create(RINGS, 0.25f);
  focal_mesh* mesh = shape_mesh(context, RINGS, 0.25f);
  check_lists();
  check_choices(mesh, &truth);
  check_measures(mesh, &truth);
  check_regression(mesh, &truth);
  shape_destroy(&truth);
  focal_mesh_destroy(mesh);
  focal_context_destroy(context);
  FINISH();
}
