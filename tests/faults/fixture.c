#define _GNU_SOURCE
#include "fixture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "rigged_shape.h"
#include "shapes.h"

enum { MESHES = 2 };

void (*fixture_pause)(void);
void (*fixture_resume)(void);

static void insist(focal_status status, const char* what) {
  if (status == FOCAL_OK) return;
  fprintf(stderr, "%s: %s: %s\n", what, focal_status_name(status), focal_last_error());
  exit(2);
}
#define INSIST(call) insist((call), #call)

uint64_t digest_bytes(uint64_t digest, const void* data, size_t size) {
  const unsigned char* bytes = data;
  for (size_t i = 0; i < size; ++i) digest = (digest ^ bytes[i]) * UINT64_C(0x100000001B3);
  return digest;
}

uint64_t digest_file(uint64_t digest, const char* path) {
  FILE* file = fopen(path, "rb");
  unsigned char buffer[4096];
  if (!file) return 0;
  for (size_t got; (got = fread(buffer, 1, sizeof buffer, file)) > 0;)
    digest = digest_bytes(digest, buffer, got);
  fclose(file);
  return digest;
}

const char* fixture_path(const fixture* f, const char* name) {
  static char path[512];
  snprintf(path, sizeof path, "%s/%s", f->folder, name);
  return path;
}

focal_train_params tiny_training(focal_preset preset) {
  focal_train_params params;
  INSIST(focal_train_params_init(&params, sizeof params));
  INSIST(focal_train_params_set_preset(&params, preset));
  params.eigenpair_count = 12, params.tree_count = 1, params.min_leaf_samples = 20;
  params.max_samples_per_shape = 60, params.rigged_shapes = 2;
  if (preset == FOCAL_PRESET_DEFAULT) params.proxy_vertices = 80; /* of 100: decimated, but little */
  params.learn_confidence = 0;
  return params;
}

static void make_meshes(fixture* f, int rings) {
  f->body = shape_create(rings, 0.05f);
  f->glb = shape_glb(&f->body, &f->glb_size);
  f->rigged_glb = rigged_glb(rings, 0, &f->rigged_size);
  INSIST(focal_mesh_load_gltf_memory(f->context, f->glb, f->glb_size, NULL, &f->mesh));
  INSIST(focal_mesh_load_gltf_memory(f->context, f->rigged_glb, f->rigged_size, NULL, &f->rigged));
  f->other = shape_mesh(f->context, rings, 0.02f);
  f->set = shape_training_set(f->context, rings, MESHES);
  INSIST(focal_training_set_create(f->context, NULL, 0, &f->rigs));
  INSIST(focal_training_set_add_rig(f->rigs, f->rigged));
}

static void make_models(fixture* f) {
  const focal_train_params usual = tiny_training(FOCAL_PRESET_DEFAULT),
                           paper = tiny_training(FOCAL_PRESET_PAPER);
  INSIST(focal_model_train(f->set, &usual, NULL, &f->model));
  INSIST(focal_model_train(f->set, &paper, NULL, &f->paper));
  INSIST(focal_model_train(f->rigs, &usual, NULL, &f->rig_model));
  INSIST(focal_model_analyse(f->model, f->mesh, NULL, NULL, &f->analysis));
  INSIST(focal_model_analyse(f->model, f->other, NULL, NULL, &f->other_analysis));
  INSIST(focal_model_analyse(f->rig_model, f->rigged, NULL, NULL, &f->rig_analysis));
  INSIST(focal_model_detect(f->model, f->mesh, NULL, NULL, &f->detection));
  INSIST(focal_model_detect(f->model, f->other, NULL, NULL, &f->other_detection));
  INSIST(focal_model_detect(f->rig_model, f->rigged, NULL, NULL, &f->rig_detection));
}

void fixture_create(fixture* f, int rings, const focal_context_params* params) {
  *f = (fixture){0};
  /* In memory where there is such a place: a flush to a disk takes longer than most scenarios. */
  const char* const temporary = access("/dev/shm", W_OK) == 0 ? "/dev/shm" : "/tmp";
  snprintf(f->folder, sizeof f->folder, "%s/focal-faults-XXXXXX", temporary);
  if (!mkdtemp(f->folder)) exit(2);
  focal_context_params how;
  focal_context_params_init(&how, sizeof how);
  if (params) how = *params;
  how.backend = FOCAL_BACKEND_CPU; /* a GPU's driver has memory and threads of its own */
  INSIST(focal_context_create(&how, &f->context));
  make_meshes(f, rings);
  make_models(f);
  INSIST(focal_model_save(f->model, fixture_path(f, "model")));
  INSIST(focal_analysis_save(f->analysis, fixture_path(f, "analysis")));
}

void fixture_destroy(fixture* f) {
  focal_detection_destroy(f->detection), focal_detection_destroy(f->other_detection);
  focal_detection_destroy(f->rig_detection);
  focal_analysis_destroy(f->analysis), focal_analysis_destroy(f->other_analysis);
  focal_analysis_destroy(f->rig_analysis);
  focal_model_destroy(f->model), focal_model_destroy(f->paper), focal_model_destroy(f->rig_model);
  focal_training_set_destroy(f->set), focal_training_set_destroy(f->rigs);
  focal_mesh_destroy(f->mesh), focal_mesh_destroy(f->other), focal_mesh_destroy(f->rigged);
  focal_context_destroy(f->context);
  shape_destroy(&f->body);
  free(f->glb), free(f->rigged_glb);
  static const char* const files[] = {"model", "analysis", "out.focal", "out.analysis", "out.glb"};
  for (size_t i = 0; i < sizeof files / sizeof *files; ++i) unlink(fixture_path(f, files[i]));
  if (rmdir(f->folder) != 0) fprintf(stderr, "something is left in %s\n", f->folder);
}
