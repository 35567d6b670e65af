/* Handles that are NULL, stale, foreign, of another type or destroyed twice; from many threads too. */
#include <pthread.h>

#include "check.h"
#include "shapes.h"

/* Before any handle was made, and the very first one. */
static void check_first(void) {
  focal_task* task = NULL;
  int here = 0;
  CHECK(focal_task_destroy((focal_task*)(void*)&here) == FOCAL_ERROR_INVALID_HANDLE);
  CHECK_REFUSED(focal_task_cancel((focal_task*)(void*)&here), FOCAL_ERROR_INVALID_HANDLE,
                "not made by this library");
  CHECK_OK(focal_task_create(&task));
  CHECK_REFUSED(focal_task_cancel((focal_task*)((char*)task + 1)), FOCAL_ERROR_INVALID_HANDLE,
                "not made by this library");
  CHECK_OK(focal_task_destroy(task));
  CHECK_REFUSED(focal_task_cancel(task), FOCAL_ERROR_INVALID_HANDLE, "has been destroyed");
}

static void check_wrong_handles(void) {
  focal_context* context = NULL;
  focal_task* task = NULL;
  focal_mesh* mesh = NULL;
  focal_mesh_info info;
  int here = 0;
  CHECK_OK(focal_mesh_info_init(&info, sizeof info));
  CHECK_OK(focal_context_create(NULL, &context));
  mesh = shape_mesh(context, 6, 0);
  CHECK_REFUSED(focal_mesh_get_info(NULL, &info), FOCAL_ERROR_INVALID_HANDLE, "focal_mesh is NULL");
  CHECK_REFUSED(focal_mesh_get_info((const focal_mesh*)(const void*)context, &info),
                FOCAL_ERROR_INVALID_HANDLE, "a focal_mesh is needed, this is a focal_context");
  CHECK_REFUSED(focal_mesh_get_info((const focal_mesh*)(const void*)&here, &info), FOCAL_ERROR_INVALID_HANDLE,
                "not made by this library");
  CHECK(focal_mesh_destroy((focal_mesh*)(void*)context) == FOCAL_ERROR_INVALID_HANDLE);
  CHECK_OK(focal_mesh_destroy(mesh));
  CHECK_REFUSED(focal_mesh_get_info(mesh, &info), FOCAL_ERROR_INVALID_HANDLE, "has been destroyed");
  CHECK(focal_mesh_positions(mesh) == NULL);
  CHECK(focal_mesh_warning(mesh, 0) == NULL);
  CHECK_OK(focal_context_destroy(context));
  CHECK(focal_context_backend(context) == 0 && focal_context_backend_reason(context) == NULL);
  CHECK_REFUSED(focal_task_create(NULL), FOCAL_ERROR_INVALID_ARGUMENT, "out_task is NULL");
  CHECK_OK(focal_task_create(&task));
  CHECK_OK(focal_task_destroy(task));
  CHECK_REFUSED(focal_task_cancel(task), FOCAL_ERROR_INVALID_HANDLE, "focal_task has been destroyed");
  CHECK(focal_task_progress(task) == 0 && focal_task_stage(task) == NULL);
}

static void check_destroy(void) {
  focal_task* task = NULL;
  char before[256];
  CHECK_OK(focal_task_create(&task));
  snprintf(before, sizeof before, "%s", focal_last_error());
  CHECK_OK(focal_task_destroy(task));
  CHECK(focal_task_destroy(task) == FOCAL_ERROR_INVALID_HANDLE);
  CHECK(strcmp(before, focal_last_error()) == 0); /* no destroy touches it */
  CHECK_OK(focal_context_destroy(NULL));
  CHECK_OK(focal_mesh_destroy(NULL));
  CHECK_OK(focal_training_set_destroy(NULL));
  CHECK_OK(focal_model_destroy(NULL));
  CHECK_OK(focal_detection_destroy(NULL));
  CHECK_OK(focal_task_destroy(NULL));
  CHECK_OK(focal_blob_destroy(NULL));
}

/* Whatever a later object reuses, an old handle never names it. */
static void check_never_reused(void) {
  focal_task* first = NULL;
  CHECK_OK(focal_task_create(&first));
  focal_task_destroy(first);
  for (int i = 0; i < 1000; ++i) {
    focal_task* task = NULL;
    focal_context* context = NULL;
    CHECK_OK(focal_task_create(&task));
    CHECK_OK(focal_context_create(NULL, &context));
    CHECK(task != first);
    CHECK(focal_task_cancel(first) == FOCAL_ERROR_INVALID_HANDLE);
    CHECK_OK(focal_task_destroy(task));
    CHECK_OK(focal_context_destroy(context));
  }
}

static focal_mesh* shared_mesh;
static focal_task* shared_task;

/* Reads one mesh while the main thread destroys it: a good answer or INVALID_HANDLE, never anything else. */
static void* read_until_destroyed(void* failures) {
  focal_mesh_info info;
  focal_mesh_info_init(&info, sizeof info);
  for (;;) {
    const focal_status status = focal_mesh_get_info(shared_mesh, &info);
    if (status == FOCAL_ERROR_INVALID_HANDLE) break;
    if (status != FOCAL_OK || info.vertex_count == 0) ++*(int*)failures;
    focal_task_cancel(shared_task);
  }
  /* The error is this thread's own. */
  if (!strstr(focal_last_error(), "focal_mesh has been destroyed")) ++*(int*)failures;
  return NULL;
}

static void check_threads(void) {
  enum { THREADS = 4 };
  pthread_t threads[THREADS];
  int failures[THREADS] = {0};
  focal_context* context = NULL;
  CHECK_OK(focal_context_create(NULL, &context));
  CHECK_OK(focal_task_create(&shared_task));
  shared_mesh = shape_mesh(context, 6, 0);
  for (int i = 0; i < THREADS; ++i) pthread_create(&threads[i], NULL, read_until_destroyed, &failures[i]);
  while (!focal_task_is_cancelled(shared_task)) continue;
  CHECK_OK(focal_mesh_destroy(shared_mesh));
  for (int i = 0; i < THREADS; ++i) pthread_join(threads[i], NULL);
  for (int i = 0; i < THREADS; ++i) CHECK(failures[i] == 0);
  CHECK_OK(focal_task_destroy(shared_task));
  CHECK_OK(focal_context_destroy(context));
}

/* Errors name each kind of handle. */
static void check_names(void) {
  const void* handle = NULL;
  focal_context* context = NULL;
  focal_mesh_info info;
  float x;
  focal_surface_point point;
  CHECK_OK(focal_mesh_info_init(&info, sizeof info));
  CHECK_OK(focal_context_create(NULL, &context));
  focal_training_set* set = shape_training_set(context, 6, 1);
  handle = set;
  CHECK_REFUSED(focal_mesh_get_info(handle, &info), FOCAL_ERROR_INVALID_HANDLE,
                "this is a focal_training_set");
  handle = context;
  CHECK_REFUSED(focal_training_set_add_rig((focal_training_set*)(void*)context, NULL),
                FOCAL_ERROR_INVALID_HANDLE, "a focal_training_set is needed");
  CHECK_REFUSED(focal_model_save(handle, "x"), FOCAL_ERROR_INVALID_HANDLE, "a focal_model is needed");
  CHECK_REFUSED(focal_analysis_save(handle, "x"), FOCAL_ERROR_INVALID_HANDLE, "a focal_analysis is needed");
  CHECK_REFUSED(focal_detection_votes(handle, 0, 1, &x), FOCAL_ERROR_INVALID_HANDLE,
                "a focal_detection is needed");
  CHECK_REFUSED(focal_skeleton_write_gltf(handle, "x"), FOCAL_ERROR_INVALID_HANDLE,
                "a focal_skeleton is needed");
  CHECK_REFUSED(focal_correspondence_points(handle, 1, &point), FOCAL_ERROR_INVALID_HANDLE,
                "a focal_correspondence is needed");
  CHECK_REFUSED(focal_task_cancel((focal_task*)(void*)context), FOCAL_ERROR_INVALID_HANDLE,
                "a focal_task is needed");
  CHECK(focal_blob_size(handle) == 0 && strstr(focal_last_error(), "a focal_blob is needed"));
  focal_training_set_destroy(set);
  focal_context_destroy(context);
}

int main(void) {
  CHECK(strcmp(focal_last_error(), "") == 0);
  check_first();
  check_names();
  check_wrong_handles();
  check_destroy();
  check_never_reused();
  check_threads();
  FINISH();
}
