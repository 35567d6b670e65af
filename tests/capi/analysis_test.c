/* One mesh analysed once: the same landmarks as by detection, through a file too; misuse is refused. */
#include <stdlib.h>

#include "check.h"
#include "shapes.h"

enum { RINGS = 14, SHAPES = 4 };

static focal_context* context;

static focal_model* train(int eigenpairs, uint64_t seed) {
  focal_train_params params;
  focal_model* model = NULL;
  focal_training_set* set = shape_training_set(context, RINGS, SHAPES);
  CHECK_OK(focal_train_params_init(&params, sizeof params));
  params.eigenpair_count = eigenpairs;
  params.tree_count = 8;
  params.proxy_vertices = 250;
  params.seed = seed;
  CHECK_OK(focal_model_train(set, &params, NULL, &model));
  focal_training_set_destroy(set);
  return model;
}

static int same_landmarks(const focal_detection* a, const focal_detection* b) {
  for (uint32_t i = 0; i < SHAPE_MARKS; ++i) {
    focal_landmark x, y;
    CHECK_OK(focal_landmark_init(&x, sizeof x));
    CHECK_OK(focal_landmark_init(&y, sizeof y));
    CHECK_OK(focal_detection_get_landmark(a, i, &x));
    CHECK_OK(focal_detection_get_landmark(b, i, &y));
    if (memcmp(x.position, y.position, sizeof x.position) != 0 || x.confidence != y.confidence) return 0;
  }
  return 1;
}

static void check_detections(const focal_model* model, const focal_mesh* mesh,
                             const focal_analysis* analysis) {
  focal_detection *direct = NULL, *through = NULL;
  CHECK_OK(focal_model_detect(model, mesh, NULL, NULL, &direct));
  CHECK_OK(focal_model_detect_analysis(model, analysis, NULL, NULL, &through));
  CHECK(same_landmarks(direct, through));
  focal_detection_destroy(direct);
  focal_detection_destroy(through);
}

static void check_file(const focal_model* model, const focal_mesh* mesh, const focal_analysis* analysis) {
  focal_analysis* loaded = NULL;
  focal_mesh* other = shape_mesh(context, RINGS, 0.2f);
  CHECK_OK(focal_analysis_save(analysis, "analysis_test.analysis"));
  CHECK_OK(focal_analysis_load(context, mesh, "analysis_test.analysis", &loaded));
  check_detections(model, mesh, loaded);
  CHECK_OK(focal_analysis_destroy(loaded));
  CHECK_REFUSED(focal_analysis_load(context, other, "analysis_test.analysis", &loaded),
                FOCAL_ERROR_INVALID_FILE, "the analysis is of another mesh");
  CHECK_REFUSED(focal_analysis_load(context, mesh, "no such file", &loaded), FOCAL_ERROR_FILE_NOT_FOUND, "");
  FILE* file = fopen("analysis_test.analysis", "r+b");
  fseek(file, 2000, SEEK_SET);
  fputc(0x55, file);
  fclose(file);
  CHECK_REFUSED(focal_analysis_load(context, mesh, "analysis_test.analysis", &loaded),
                FOCAL_ERROR_INVALID_FILE, "");
  remove("analysis_test.analysis");
  focal_mesh_destroy(other);
}

int main(void) {
  CHECK_OK(focal_context_create(NULL, &context));
  focal_mesh* mesh = shape_mesh(context, RINGS, 0.05f);
  focal_model *first = train(40, 1), *second = train(40, 2), *foreign = train(30, 1);
  focal_analysis* analysis = NULL;
  focal_detection* detection = NULL;
  CHECK_OK(focal_model_analyse(first, mesh, NULL, NULL, &analysis));
  check_detections(first, mesh, analysis);
  check_detections(second, mesh, analysis); /* another model, the same parameters */
  CHECK_REFUSED(focal_model_detect_analysis(foreign, analysis, NULL, NULL, &detection),
                FOCAL_ERROR_INVALID_ARGUMENT, "other parameters");
  check_file(first, mesh, analysis);
  CHECK_OK(focal_mesh_destroy(mesh)); /* the analysis keeps it alive */
  CHECK_OK(focal_model_detect_analysis(first, analysis, NULL, NULL, &detection));
  CHECK_OK(focal_detection_destroy(detection));
  CHECK_OK(focal_analysis_destroy(analysis));
  CHECK_REFUSED(focal_model_detect_analysis(first, analysis, NULL, NULL, &detection),
                FOCAL_ERROR_INVALID_HANDLE, "has been destroyed");
  CHECK_REFUSED(focal_model_analyse(first, NULL, NULL, NULL, &analysis), FOCAL_ERROR_INVALID_HANDLE,
                "is NULL");
  focal_model_destroy(first), focal_model_destroy(second), focal_model_destroy(foreign);
  focal_context_destroy(context);
  FINISH();
}
