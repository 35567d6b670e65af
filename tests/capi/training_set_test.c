/* The training set as a builder, and training sets that nothing can be learned from. */
#include "check.h"
#include "shapes.h"

static focal_context* context;

static void check_names(void) {
  focal_training_set* set = NULL;
  const char* const twice[] = {"nose", "nose"};
  const char* const empty[] = {"nose", ""};
  CHECK_REFUSED(focal_training_set_create(context, twice, 2, &set), FOCAL_ERROR_INVALID_ARGUMENT,
                "two landmarks are named \"nose\"");
  CHECK_REFUSED(focal_training_set_create(context, empty, 2, &set), FOCAL_ERROR_INVALID_ARGUMENT,
                "landmark name 1 is empty");
  CHECK_REFUSED(focal_training_set_create(context, NULL, 2, &set), FOCAL_ERROR_INVALID_ARGUMENT, "is NULL");
  CHECK_REFUSED(focal_training_set_create(context, twice, 0, &set), FOCAL_ERROR_INVALID_ARGUMENT,
                "landmark_count is 0");
  CHECK_REFUSED(focal_training_set_create(NULL, twice, 1, &set), FOCAL_ERROR_INVALID_HANDLE,
                "focal_context is NULL");
  CHECK(set == NULL);
}

static void check_marks(void) {
  shape body = shape_create(8, 0);
  focal_mesh* mesh = shape_mesh(context, 8, 0);
  focal_training_set* set = shape_training_set(context, 8, 1);
  uint32_t vertices[SHAPE_MARKS] = {body.marks[0], FOCAL_NO_VERTEX, 1u << 20};
  focal_surface_point points[SHAPE_MARKS] = {
      {5, {1, 1, 2}}, {FOCAL_NO_TRIANGLE, {0, 0, 0}}, {7, {0.5f, 0.5f, -0.1f}}};
  CHECK_REFUSED(focal_training_set_add_vertices(set, mesh, vertices, SHAPE_MARKS),
                FOCAL_ERROR_INVALID_LANDMARK,
                "landmark \"tail\" of training mesh 1: the mesh has no vertex 1048576");
  CHECK_REFUSED(focal_training_set_add(set, mesh, points, SHAPE_MARKS), FOCAL_ERROR_INVALID_LANDMARK,
                "landmark \"tail\" of training mesh 1: its barycentric weights");
  points[2].triangle = 1u << 20;
  CHECK_REFUSED(focal_training_set_add(set, mesh, points, SHAPE_MARKS), FOCAL_ERROR_INVALID_LANDMARK,
                "no triangle 1048576");
  CHECK_REFUSED(focal_training_set_add(set, mesh, points, 2), FOCAL_ERROR_INVALID_ARGUMENT,
                "2 landmarks given");
  CHECK_REFUSED(focal_training_set_add(set, mesh, NULL, SHAPE_MARKS), FOCAL_ERROR_INVALID_ARGUMENT,
                "is NULL");
  CHECK(focal_training_set_mesh_count(set) == 1); /* as it was */
  points[2].triangle = FOCAL_NO_TRIANGLE;
  CHECK_OK(focal_training_set_add(set, mesh, points, SHAPE_MARKS));
  CHECK(focal_training_set_mesh_count(set) == 2 && focal_training_set_landmark_count(set) == SHAPE_MARKS);
  /* "hand.L" and "tail" are marked on one mesh only. */
  focal_model* model = NULL;
  CHECK_REFUSED(focal_model_train(set, NULL, NULL, &model), FOCAL_ERROR_TOO_FEW_SHAPES, "hand.L");
  focal_training_set_destroy(set);
  focal_mesh_destroy(mesh);
  shape_destroy(&body);
}

static void check_one_mesh(void) {
  focal_model* model = NULL;
  focal_training_set* set = shape_training_set(context, 8, 1);
  CHECK_REFUSED(focal_model_train(set, NULL, NULL, &model), FOCAL_ERROR_TOO_FEW_SHAPES, "");
  CHECK_REFUSED(focal_model_train(set, NULL, NULL, NULL), FOCAL_ERROR_INVALID_ARGUMENT, "out_model is NULL");
  CHECK(model == NULL);
  focal_training_set_destroy(set);
}

int main(void) {
  CHECK_OK(focal_context_create(NULL, &context));
  check_names();
  check_marks();
  check_one_mesh();
  focal_context_destroy(context);
  FINISH();
}
