/* The same over and over, by many contexts, then with the library itself loaded and unloaded: memory, open files and
 * threads must not grow.
 * usage: cycles LIBRARY CONTEXTS LOADS; LIBRARY: the path of libfocal.so */
#define _GNU_SOURCE
#include <dirent.h>
#include <dlfcn.h>
#include <focal/focal.h>
#include <malloc.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "shapes.h"

typedef struct usage {
  long live_bytes, resident_kb, files, threads, mappings;
} usage;

static long entries(const char* folder) {
  DIR* const all = opendir(folder);
  long count = 0;
  while (all && readdir(all)) ++count;
  closedir(all);
  return count;
}

static usage measure(void) {
  usage now = {(long)mallinfo2().uordblks, 0, entries("/proc/self/fd"), entries("/proc/self/task"), 0};
  char line[512];
  FILE* file = fopen("/proc/self/statm", "r");
  if (file && fscanf(file, "%*s %ld", &now.resident_kb) == 1) now.resident_kb *= sysconf(_SC_PAGESIZE) / 1024;
  if (file) fclose(file);
  file = fopen("/proc/self/maps", "r");
  while (file && fgets(line, sizeof line, file)) ++now.mappings;
  if (file) fclose(file);
  return now;
}

/* Reached by name, as this program is not linked to the library. */
typedef struct functions {
  focal_status (*context_create)(const focal_context_params*, focal_context**);
  focal_status (*context_destroy)(focal_context*);
  focal_status (*mesh_create)(const focal_context*, const focal_mesh_desc*, const focal_mesh_params*,
                              focal_mesh**);
  focal_status (*mesh_destroy)(focal_mesh*);
  focal_status (*set_create)(const focal_context*, const char* const*, uint64_t, focal_training_set**);
  focal_status (*set_destroy)(focal_training_set*);
  focal_status (*set_add)(focal_training_set*, const focal_mesh*, const uint32_t*, uint64_t);
  focal_status (*train_params_init)(focal_train_params*, size_t);
  focal_status (*train)(const focal_training_set*, const focal_train_params*, focal_task*, focal_model**);
  focal_status (*model_destroy)(focal_model*);
  focal_status (*detect)(const focal_model*, const focal_mesh*, const focal_detect_params*, focal_task*,
                         focal_detection**);
  focal_status (*detection_destroy)(focal_detection*);
  const char* (*last_error)(void);
} functions;

static functions find_all(void* library) {
  functions f;
  *(void**)&f.context_create = dlsym(library, "focal_context_create");
  *(void**)&f.context_destroy = dlsym(library, "focal_context_destroy");
  *(void**)&f.mesh_create = dlsym(library, "focal_mesh_create");
  *(void**)&f.mesh_destroy = dlsym(library, "focal_mesh_destroy");
  *(void**)&f.set_create = dlsym(library, "focal_training_set_create");
  *(void**)&f.set_destroy = dlsym(library, "focal_training_set_destroy");
  *(void**)&f.set_add = dlsym(library, "focal_training_set_add_vertices");
  *(void**)&f.train_params_init = dlsym(library, "focal_train_params_init");
  *(void**)&f.train = dlsym(library, "focal_model_train");
  *(void**)&f.model_destroy = dlsym(library, "focal_model_destroy");
  *(void**)&f.detect = dlsym(library, "focal_model_detect");
  *(void**)&f.detection_destroy = dlsym(library, "focal_detection_destroy");
  *(void**)&f.last_error = dlsym(library, "focal_last_error");
  return f;
}

static shape body;

static void need(int good, const functions* f) {
  if (good) return;
  fprintf(stderr, "failed: %s\n", f->last_error());
  exit(2);
}

/* A model and a detection, in a context of two threads; a failing call besides. */
static void work(const functions* f) {
  static const char* const names[] = {"a", "b", "c"};
  focal_context_params params = {
      .struct_size = sizeof params, .backend = FOCAL_BACKEND_CPU, .thread_count = 2};
  focal_train_params training;
  const focal_mesh_desc desc = {.struct_size = sizeof desc,
                                .positions = body.positions,
                                .vertex_count = body.vertex_count,
                                .indices = body.indices,
                                .index_count = body.index_count};
  focal_context* context = NULL;
  focal_mesh* mesh = NULL;
  focal_training_set* set = NULL;
  focal_model* model = NULL;
  focal_detection* detection = NULL;
  need(f->context_create(&params, &context) == FOCAL_OK, f);
  need(f->mesh_create(context, &desc, NULL, &mesh) == FOCAL_OK, f);
  need(f->set_create(context, names, SHAPE_MARKS, &set) == FOCAL_OK, f);
  for (int i = 0; i < 2; ++i) need(f->set_add(set, mesh, body.marks, SHAPE_MARKS) == FOCAL_OK, f);
  need(f->train_params_init(&training, sizeof training) == FOCAL_OK, f);
  training.eigenpair_count = 12, training.tree_count = 1, training.learn_confidence = 0;
  need(f->train(set, &training, NULL, &model) == FOCAL_OK, f);
  need(f->detect(model, mesh, NULL, NULL, &detection) == FOCAL_OK, f);
  need(f->detect(model, NULL, NULL, NULL, NULL) != FOCAL_OK, f);
  f->detection_destroy(detection), f->model_destroy(model), f->set_destroy(set), f->mesh_destroy(mesh);
  f->context_destroy(context);
}

static void* work_in_thread(void* f) {
  work(f);
  return NULL;
}

static void load_and_work(const char* path) {
  pthread_t thread;
  void* const library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
  if (!library) fprintf(stderr, "%s\n", dlerror()), exit(2);
  functions f = find_all(library);
  work(&f);
  if (pthread_create(&thread, NULL, work_in_thread, &f) != 0) exit(2);
  pthread_join(thread, NULL);
  dlclose(library);
}

static int is_mapped(const char* path) {
  void* const again = dlopen(path, RTLD_NOW | RTLD_NOLOAD);
  if (again) dlclose(again);
  return again != NULL;
}

/* A few runs warm up what is kept for good. Memory may differ by what the allocator holds back for threads that come and go: up to
 * some 20 KB whatever the count, so a leak shows by its count. */
static int report(const char* what, long count, usage before, usage after) {
  const long bytes = after.live_bytes - before.live_bytes, kb = after.resident_kb - before.resident_kb;
  printf("%ld %s: %+ld bytes allocated, %+ld KiB resident, %+ld open files, %+ld threads, %+ld mappings\n",
         count, what, bytes, kb, after.files - before.files, after.threads - before.threads,
         after.mappings - before.mappings);
  return bytes > 24 * 1024 + 16 * count || kb > 4096 || after.files != before.files ||
         after.threads != before.threads || after.mappings > before.mappings + 8;
}

int main(int argc, char** argv) {
  enum { WARM_UP = 10 };
  if (argc != 4) return 2;
  const char* const path = argv[1];
  const long contexts = atol(argv[2]), loads = atol(argv[3]);
  body = shape_create(7, 0);
  for (int i = 0; i < WARM_UP; ++i) load_and_work(path);
  usage before = measure();
  for (long i = 0; i < loads; ++i) load_and_work(path);
  int bad = report("loads of the library", loads, before, measure());
  printf("after the last the library is %s\n", is_mapped(path) ? "still mapped" : "gone from memory");
  bad |= is_mapped(path);
  void* const library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
  functions f = find_all(library);
  for (int i = 0; i < WARM_UP; ++i) work(&f);
  before = measure();
  for (long i = 0; i < contexts; ++i) work(&f);
  bad |= report("contexts", contexts, before, measure());
  dlclose(library);
  shape_destroy(&body);
  return bad;
}
