/* Cancels a training from another thread, as a host does when its user presses Esc, and measures the answer.
 * Each mesh is marked at one vertex. tests/bench/cancel.cpp measures it for every long call.
 * usage: cancel MESH.glb VERTEX MESH.glb VERTEX [MESH.glb VERTEX]... */
#define _POSIX_C_SOURCE 200809L
#include <focal/focal.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static int failed(void) {
  fprintf(stderr, "%s\n", focal_last_error());
  return 1;
}

static double now(void) {
  struct timespec time;
  clock_gettime(CLOCK_MONOTONIC, &time);
  return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

typedef struct worker {
  const focal_training_set* set;
  focal_task* task;
  focal_status status;
  double returned; /* when, on the clock */
} worker;

static void* train(void* data) {
  worker* self = data;
  focal_model* model = NULL;
  self->status = focal_model_train(self->set, NULL, self->task, &model);
  self->returned = now();
  focal_model_destroy(model);
  return NULL;
}

int main(int argc, char** argv) {
  static const char* const names[] = {"mark"};
  const struct timespec pause = {0, 5000000};
  focal_context* context = NULL;
  focal_training_set* set = NULL;
  worker work = {NULL, NULL, FOCAL_OK, 0};
  pthread_t thread;
  double cancelled;
  int a;
  if (argc < 5 || argc % 2 == 0)
    return fprintf(stderr, "usage: cancel MESH.glb VERTEX MESH.glb VERTEX...\n"), 2;
  if (focal_context_create(NULL, &context)) return failed();
  if (focal_training_set_create(context, names, 1, &set)) return failed();
  for (a = 1; a < argc; a += 2) {
    const uint32_t vertex = (uint32_t)strtoul(argv[a + 1], NULL, 10);
    focal_mesh* mesh = NULL;
    if (focal_mesh_load_gltf(context, argv[a], NULL, &mesh)) return failed();
    if (focal_training_set_add_vertices(set, mesh, &vertex, 1)) return failed();
    focal_mesh_destroy(mesh);
  }

  if (focal_task_create(&work.task)) return failed();
  work.set = set;
  pthread_create(&thread, NULL, train, &work);
  /* Any place in the middle will do. */
  for (a = 0; a < 2000 && focal_task_progress(work.task) < 0.05; ++a) nanosleep(&pause, NULL);
  printf("cancelled in stage \"%s\" at %.0f %%\n", focal_task_stage(work.task),
         100 * focal_task_progress(work.task));
  cancelled = now();
  focal_task_cancel(work.task);
  pthread_join(thread, NULL);
  printf("%s after %.0f ms\n", focal_status_name(work.status), 1000 * (work.returned - cancelled));

  focal_task_destroy(work.task);
  focal_training_set_destroy(set);
  focal_context_destroy(context);
  return work.status == FOCAL_ERROR_CANCELLED ? 0 : 1;
}
