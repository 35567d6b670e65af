/* What the library holds, and a budget that it keeps. */
#include <stdlib.h>

#include "check.h"
#include "shapes.h"

enum { RINGS = 16, SMALL = 1 << 20 };

static focal_context* context_with(uint64_t budget, focal_parallel_for_fn loop, void* user_data) {
  focal_context_params params;
  focal_context* context = NULL;
  CHECK_OK(focal_context_params_init(&params, sizeof params));
  params.thread_count = 2, params.memory_budget_bytes = budget;
  params.parallel_for = loop, params.parallel_for_user_data = user_data;
  CHECK_OK(focal_context_create(&params, &context));
  return context;
}

static focal_train_params quick(void) {
  focal_train_params params;
  CHECK_OK(focal_train_params_init(&params, sizeof params));
  params.tree_count = 2, params.eigenpair_count = 20, params.learn_confidence = 0;
  return params;
}

static void check_held(void) {
  focal_context* const context = context_with(0, NULL, NULL);
  const uint64_t before = focal_context_memory_held(context);
  focal_mesh* const mesh = shape_mesh(context, RINGS, 0);
  focal_mesh_info info;
  CHECK_OK(focal_mesh_info_init(&info, sizeof info));
  CHECK_OK(focal_mesh_get_info(mesh, &info));
  CHECK(focal_context_memory_held(context) > before + 12 * (info.vertex_count + info.triangle_count));
  focal_mesh_destroy(mesh);
  CHECK(focal_context_memory_held(context) == before);
  focal_context_destroy(context);
}

/* The model's bytes, in a blob, or NULL and the status. */
static focal_blob* trained(const focal_training_set* set, focal_status* status) {
  const focal_train_params params = quick();
  focal_model* model = NULL;
  focal_blob* blob = NULL;
  *status = focal_model_train(set, &params, NULL, &model);
  if (*status == FOCAL_OK) CHECK_OK(focal_model_save_memory(model, &blob));
  focal_model_destroy(model);
  return blob;
}

static void check_budgets(void) {
  focal_context *free_context = context_with(0, NULL, NULL), *small = context_with(SMALL, NULL, NULL),
                *large = context_with(UINT64_MAX, NULL, NULL);
  focal_training_set *any = shape_training_set(free_context, RINGS, 2),
                     *enough = shape_training_set(large, RINGS, 2),
                     *tight = shape_training_set(small, RINGS, 2);
  focal_status status;
  focal_blob *expected = trained(any, &status), *same;
  CHECK_OK(status);
  same = trained(enough, &status);
  CHECK_OK(status);
  CHECK(same && focal_blob_size(same) == focal_blob_size(expected) &&
        memcmp(focal_blob_data(same), focal_blob_data(expected), (size_t)focal_blob_size(same)) == 0);
  for (int again = 0; again < 2; ++again) { /* no leak, and no lasting harm */
    const uint64_t before = focal_context_memory_held(small);
    CHECK(trained(tight, &status) == NULL);
    CHECK_REFUSED(status, FOCAL_ERROR_OUT_OF_MEMORY, "the memory budget of 1048576 bytes is too small");
    CHECK(focal_context_memory_held(small) == before);
  }
  CHECK(focal_training_set_mesh_count(tight) == 2);
  focal_blob_destroy(expected), focal_blob_destroy(same);
  focal_training_set_destroy(any), focal_training_set_destroy(enough), focal_training_set_destroy(tight);
  focal_context_destroy(free_context), focal_context_destroy(small), focal_context_destroy(large);
}

typedef struct guest {
  focal_context* context;
  int made, refused;
} guest;

/* A host's loop that itself calls the library, on a context of its own. */
static void loop_with_guest(void* user_data, int64_t count, focal_parallel_body_fn body, void* body_data) {
  guest* const self = user_data;
  for (int64_t i = 0; i < count; ++i) {
    focal_training_set* set = NULL;
    static char name[2 * SMALL];
    const char* const names[] = {name};
    memset(name, 'x', sizeof name - 1);
    if (focal_training_set_create(self->context, names, 1, &set) == FOCAL_OK)
      ++self->made;
    else
      ++self->refused;
    focal_training_set_destroy(set);
    body(body_data, i);
  }
}

/* Each call has the budget of its own context, also one inside another. */
static void check_nested(void) {
  focal_status status;
  guest self = {context_with(0, NULL, NULL), 0, 0};
  focal_context* const host = context_with(SMALL, loop_with_guest, &self);
  focal_training_set* const set = shape_training_set(host, RINGS, 2);
  CHECK(trained(set, &status) == NULL);
  CHECK_REFUSED(status, FOCAL_ERROR_OUT_OF_MEMORY, "the memory budget of 1048576 bytes is too small");
  CHECK(self.made > 0 && self.refused == 0);
  focal_training_set_destroy(set);
  focal_context_destroy(host), focal_context_destroy(self.context);
}

int main(void) {
  check_held();
  check_budgets();
  check_nested();
  FINISH();
}
