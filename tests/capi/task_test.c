/* Progress and cancellation from another thread. */
#define _POSIX_C_SOURCE 200809L
#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <time.h>

#include "check.h"
#include "shapes.h"

typedef struct watcher {
  focal_task* task;
  atomic_int stop;
  int fell, stages;
} watcher;

static void* watch(void* data) {
  watcher* self = data;
  double last = 0;
  const char* stage = "";
  while (!atomic_load(&self->stop)) {
    const double progress = focal_task_progress(self->task);
    const char* now = focal_task_stage(self->task);
    if (progress < last || progress > 1) ++self->fell;
    if (strcmp(stage, now) != 0) ++self->stages, stage = now;
    last = progress;
  }
  return NULL;
}

static void check_progress(const focal_training_set* set) {
  pthread_t thread;
  focal_model* model = NULL;
  watcher self = {NULL, 0, 0, 0};
  CHECK_OK(focal_task_create(&self.task));
  CHECK(focal_task_progress(self.task) == 0 && strcmp(focal_task_stage(self.task), "") == 0);
  pthread_create(&thread, NULL, watch, &self);
  CHECK_OK(focal_model_train(set, NULL, self.task, &model));
  atomic_store(&self.stop, 1);
  pthread_join(thread, NULL);
  CHECK(self.fell == 0 && self.stages >= 2);
  CHECK(focal_task_progress(self.task) > 0.99);
  CHECK(*focal_task_stage(self.task) != '\0' && !focal_task_is_cancelled(self.task));
  focal_task_destroy(self.task);
  focal_model_destroy(model);
}

/* A cancel before the call counts, and stays until the task is reset. */
static void check_early_cancel(const focal_training_set* set) {
  focal_model* model = NULL;
  focal_task* task = NULL;
  CHECK_OK(focal_task_create(&task));
  CHECK_OK(focal_task_cancel(task));
  CHECK(focal_task_is_cancelled(task));
  CHECK_REFUSED(focal_model_train(set, NULL, task, &model), FOCAL_ERROR_CANCELLED, "cancelled");
  CHECK_REFUSED(focal_model_train(set, NULL, task, &model), FOCAL_ERROR_CANCELLED, "cancelled");
  CHECK_OK(focal_task_reset(task));
  CHECK(!focal_task_is_cancelled(task) && focal_task_progress(task) == 0);
  CHECK_OK(focal_model_train(set, NULL, task, &model));
  focal_model_destroy(model);
  focal_task_destroy(task);
}

typedef struct second_call {
  const focal_training_set* set;
  focal_task* task;
  focal_status status;
  char error[256];
} second_call;

static void check_mesh(const focal_context* context) {
  shape body = shape_create(12, 0);
  const focal_mesh_desc desc = shape_desc(&body);
  focal_mesh_params params;
  focal_mesh* mesh = NULL;
  size_t size = 0;
  unsigned char* file = shape_glb(&body, &size);
  CHECK_OK(focal_mesh_params_init(&params, sizeof params));
  CHECK_OK(focal_task_create(&params.task));
  CHECK_OK(focal_mesh_create(context, &desc, &params, &mesh));
  CHECK(focal_task_progress(params.task) == 1 && strcmp(focal_task_stage(params.task), "done") == 0);
  focal_mesh_destroy(mesh);
  CHECK_OK(focal_task_cancel(params.task));
  CHECK_REFUSED(focal_mesh_create(context, &desc, &params, &mesh), FOCAL_ERROR_CANCELLED, "cancelled");
  CHECK_REFUSED(focal_mesh_load_gltf_memory(context, file, size, &params, &mesh), FOCAL_ERROR_CANCELLED,
                "cancelled");
  CHECK_OK(focal_task_destroy(params.task));
  CHECK_REFUSED(focal_mesh_create(context, &desc, &params, &mesh), FOCAL_ERROR_INVALID_HANDLE, "focal_task");
  free(file);
  shape_destroy(&body);
}

static void* train_again(void* data) {
  second_call* self = data;
  focal_model* model = NULL;
  while (*focal_task_stage(self->task) == '\0') continue;
  self->status = focal_model_train(self->set, NULL, self->task, &model);
  snprintf(self->error, sizeof self->error, "%s", focal_last_error());
  CHECK(focal_task_reset(self->task) == FOCAL_ERROR_INVALID_ARGUMENT);
  focal_task_cancel(self->task);
  return NULL;
}

/* One task serves one call at a time; the other thread then cancels the first call. */
static void check_busy(const focal_training_set* set) {
  pthread_t thread;
  focal_model* model = NULL;
  second_call second = {set, NULL, FOCAL_OK, ""};
  CHECK_OK(focal_task_create(&second.task));
  pthread_create(&thread, NULL, train_again, &second);
  CHECK_REFUSED(focal_model_train(set, NULL, second.task, &model), FOCAL_ERROR_CANCELLED, "cancelled");
  pthread_join(thread, NULL);
  CHECK(second.status == FOCAL_ERROR_INVALID_ARGUMENT && strstr(second.error, "in use"));
  CHECK(model == NULL);
  focal_task_destroy(second.task);
}

int main(void) {
  focal_context* context = NULL;
  CHECK_OK(focal_context_create(NULL, &context));
  focal_training_set* set = shape_training_set(context, 16, 3);
  check_progress(set);
  check_early_cancel(set);
  check_busy(set);
  check_mesh(context);
  focal_training_set_destroy(set);
  focal_context_destroy(context);
  FINISH();
}
