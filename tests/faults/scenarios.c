/* The calls that make things, and the list of all scenarios. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fixture.h"
#include "scenario_steps.h"

focal_train_params tiny_training(focal_preset preset);

static focal_status add_model(uint64_t* digest, focal_model* model) {
  focal_blob* blob = NULL;
  const focal_status status = focal_model_save_memory(model, &blob);
  if (status == FOCAL_OK)
    *digest = digest_bytes(*digest, focal_blob_data(blob), (size_t)focal_blob_size(blob));
  focal_blob_destroy(blob);
  focal_model_destroy(model);
  return status;
}

static focal_status add_landmarks(uint64_t* digest, focal_detection* detection) {
  for (uint32_t i = 0; i < focal_detection_landmark_count(detection); ++i) {
    focal_landmark landmark;
    TRY(focal_landmark_init(&landmark, sizeof landmark));
    TRY(focal_detection_get_landmark(detection, i, &landmark));
    *digest = digest_bytes(*digest, &landmark.status, sizeof landmark.status);
    *digest = digest_bytes(*digest, &landmark.confidence, sizeof landmark.confidence);
    *digest = digest_bytes(*digest, &landmark.point, sizeof landmark.point);
    *digest = digest_bytes(*digest, landmark.position, sizeof landmark.position);
  }
  return FOCAL_OK;
}

static focal_status take_detection(uint64_t* digest, focal_detection* detection) {
  const focal_status status = add_landmarks(digest, detection);
  focal_detection_destroy(detection);
  return status;
}

static void add_mesh(uint64_t* digest, focal_mesh* mesh) {
  focal_mesh_info info;
  focal_mesh_info_init(&info, sizeof info);
  focal_mesh_get_info(mesh, &info);
  *digest = digest_bytes(*digest, focal_mesh_positions(mesh), (size_t)info.vertex_count * 12);
  *digest = digest_bytes(*digest, focal_mesh_triangles(mesh), (size_t)info.triangle_count * 12);
  *digest = digest_bytes(*digest, &info.surface_area, sizeof info.surface_area);
  focal_mesh_destroy(mesh);
}

static focal_status run_context(const fixture* f, uint64_t* digest) {
  focal_context* context = NULL;
  focal_task* task = NULL;
  focal_context_params params;
  (void)f;
  TRY(focal_context_params_init(&params, sizeof params));
  params.backend = FOCAL_BACKEND_CPU; /* focal's own memory fails here, not that of a driver */
  TRY(focal_context_create(&params, &context));
  const char* reason = focal_context_backend_reason(context);
  *digest = digest_bytes(*digest, reason, strlen(reason));
  focal_context_destroy(context);
  TRY(focal_task_create(&task));
  return focal_task_destroy(task);
}

static focal_status run_mesh_create(const fixture* f, uint64_t* digest) {
  focal_mesh* mesh = NULL;
  const focal_mesh_desc desc = shape_desc(&f->body);
  TRY(focal_mesh_create(f->context, &desc, NULL, &mesh));
  add_mesh(digest, mesh);
  return FOCAL_OK;
}

static focal_status run_gltf(const fixture* f, uint64_t* digest) {
  focal_mesh* mesh = NULL;
  TRY(focal_mesh_load_gltf_memory(f->context, f->glb, f->glb_size, NULL, &mesh));
  add_mesh(digest, mesh);
  return FOCAL_OK;
}

static focal_status run_gltf_pose(const fixture* f, uint64_t* digest) {
  focal_mesh* mesh = NULL;
  focal_mesh_params params;
  TRY(focal_mesh_params_init(&params, sizeof params));
  params.pose_animation = "wave", params.pose_time = 0.5;
  TRY(focal_mesh_load_gltf_memory(f->context, f->rigged_glb, f->rigged_size, &params, &mesh));
  add_mesh(digest, mesh);
  return FOCAL_OK;
}

static focal_status add_to_sets(const fixture* f, focal_training_set* set, focal_training_set* rigs) {
  const uint32_t marks[SHAPE_MARKS] = {0, 5, FOCAL_NO_VERTEX};
  focal_surface_point points[SHAPE_MARKS];
  for (int i = 0; i < SHAPE_MARKS; ++i) points[i] = (focal_surface_point){(uint32_t)i, {0.5f, 0.25f, 0.25f}};
  TRY(focal_training_set_add_vertices(set, f->mesh, marks, SHAPE_MARKS));
  TRY(focal_training_set_add(set, f->other, points, SHAPE_MARKS));
  return focal_training_set_add_rig(rigs, f->rigged);
}

static focal_status run_sets(const fixture* f, uint64_t* digest) {
  focal_training_set *set = NULL, *rigs = NULL;
  focal_status status = focal_training_set_create(f->context, shape_mark_names, SHAPE_MARKS, &set);
  if (status == FOCAL_OK) status = focal_training_set_create(f->context, NULL, 0, &rigs);
  if (status == FOCAL_OK) status = add_to_sets(f, set, rigs);
  if (status == FOCAL_OK) *digest += focal_training_set_mesh_count(set);
  focal_training_set_destroy(set);
  focal_training_set_destroy(rigs);
  return status;
}

static focal_status train(const focal_training_set* set, focal_preset preset, uint64_t* digest) {
  focal_model* model = NULL;
  const focal_train_params params = tiny_training(preset);
  TRY(focal_model_train(set, &params, NULL, &model));
  return add_model(digest, model);
}

static focal_status run_train(const fixture* f, uint64_t* digest) {
  return train(f->set, FOCAL_PRESET_DEFAULT, digest);
}
static focal_status run_train_paper(const fixture* f, uint64_t* digest) {
  return train(f->set, FOCAL_PRESET_PAPER, digest);
}
static focal_status run_train_rig(const fixture* f, uint64_t* digest) {
  return train(f->rigs, FOCAL_PRESET_DEFAULT, digest);
}

/* With what judges the places: cross-fitting on corrupted copies. */
static focal_status run_train_confidence(const fixture* f, uint64_t* digest) {
  focal_model* model = NULL;
  focal_train_params params = tiny_training(FOCAL_PRESET_DEFAULT);
  params.learn_confidence = 1;
  TRY(focal_model_train(f->set, &params, NULL, &model));
  return add_model(digest, model);
}

static focal_status run_model_file(const fixture* f, uint64_t* digest) {
  focal_model* model = NULL;
  TRY(focal_model_save(f->model, fixture_path(f, "out.focal")));
  TRY(focal_model_load(f->context, fixture_path(f, "out.focal"), &model));
  return add_model(digest, model);
}

static focal_status run_model_memory(const fixture* f, uint64_t* digest) {
  focal_model* model = NULL;
  focal_blob* blob = NULL;
  TRY(focal_model_save_memory(f->model, &blob));
  const focal_status status =
      focal_model_load_memory(f->context, focal_blob_data(blob), focal_blob_size(blob), &model);
  focal_blob_destroy(blob);
  TRY(status);
  return add_model(digest, model);
}

static focal_status run_detect(const fixture* f, uint64_t* digest) {
  focal_detection* detection = NULL;
  TRY(focal_model_detect(f->model, f->mesh, NULL, NULL, &detection));
  return take_detection(digest, detection);
}

static focal_status run_detect_many(const fixture* f, uint64_t* digest) {
  const focal_mesh* meshes[2] = {f->mesh, f->mesh};
  focal_detection* detections[2];
  TRY(focal_model_detect_many(f->model, meshes, 2, NULL, NULL, detections));
  const focal_status status = take_detection(digest, detections[0]);
  const focal_status other = take_detection(digest, detections[1]);
  return status == FOCAL_OK ? other : status;
}

static focal_status run_detect_paper(const fixture* f, uint64_t* digest) {
  focal_detection* detection = NULL;
  TRY(focal_model_detect(f->paper, f->mesh, NULL, NULL, &detection));
  return take_detection(digest, detection);
}

static focal_status run_analyse(const fixture* f, uint64_t* digest) {
  focal_analysis* analysis = NULL;
  focal_detection* detection = NULL;
  focal_detect_params params;
  TRY(focal_detect_params_init(&params, sizeof params));
  params.quality = FOCAL_QUALITY_INTERACTIVE;
  TRY(focal_model_analyse(f->model, f->mesh, &params, NULL, &analysis));
  const focal_status status = focal_model_detect_analysis(f->model, analysis, &params, NULL, &detection);
  focal_analysis_destroy(analysis);
  TRY(status);
  return take_detection(digest, detection);
}

static focal_status run_analysis_file(const fixture* f, uint64_t* digest) {
  focal_analysis* analysis = NULL;
  focal_detection* detection = NULL;
  TRY(focal_analysis_save(f->analysis, fixture_path(f, "out.analysis")));
  TRY(focal_analysis_load(f->context, f->mesh, fixture_path(f, "out.analysis"), &analysis));
  own_work_begins();
  if (focal_model_detect_analysis(f->model, analysis, NULL, NULL, &detection) == FOCAL_OK)
    take_detection(digest, detection);
  own_work_ends();
  focal_analysis_destroy(analysis);
  return FOCAL_OK;
}

static focal_status run_stock(const fixture* f, uint64_t* digest) {
  focal_context* context = NULL;
  focal_context_params params;
  focal_model* model = NULL;
  TRY(focal_model_save(f->model, fixture_path(f, "stock.focal")));
  TRY(focal_context_params_init(&params, sizeof params));
  params.backend = FOCAL_BACKEND_CPU; /* focal's own memory fails here, not that of a driver */
  params.models_folder = f->folder;
  TRY(focal_context_create(&params, &context));
  const focal_status status = focal_model_load_stock(context, "stock", &model);
  if (status == FOCAL_OK) {
    const uint32_t known = focal_model_joint_count(model);
    *digest = digest_bytes(*digest, &known, sizeof known);
  }
  focal_model_destroy(model);
  focal_context_destroy(context);
  remove(fixture_path(f, "stock.focal"));
  return status;
}

static focal_status run_parts(const fixture* f, uint64_t* digest) {
  focal_mesh* mesh = NULL;
  focal_mesh_part part;
  const focal_mesh_desc desc = shape_desc(&f->body);
  const focal_mesh_desc* const parts[] = {&desc, &desc};
  TRY(focal_mesh_create_parts(f->context, parts, 2, NULL, &mesh));
  focal_status status = focal_mesh_part_init(&part, sizeof part);
  if (status == FOCAL_OK) status = focal_mesh_get_part(mesh, 1, &part);
  if (status == FOCAL_OK) *digest = digest_bytes(*digest, &part, sizeof part);
  focal_mesh_destroy(mesh);
  return status;
}

const scenario scenarios[] = {
    {"context and task", run_context},
    {"mesh from arrays", run_mesh_create},
    {"glTF", run_gltf},
    {"glTF with a skin, posed", run_gltf_pose},
    {"training sets", run_sets},
    {"train", run_train},
    {"train with confidence", run_train_confidence},
    {"train paper", run_train_paper},
    {"train on a rig", run_train_rig},
    {"model file", run_model_file},
    {"model in memory", run_model_memory},
    {"detect", run_detect},
    {"detect many", run_detect_many},
    {"detect paper", run_detect_paper},
    {"analyse, then detect", run_analyse},
    {"analysis file", run_analysis_file},
    {"write glTF", run_write},
    {"votes, distances, region", run_maps},
    {"correspondence", run_correspondence},
    {"segments", run_segment},
    {"skeleton", run_skeleton},
    {"skeleton by a template", run_template},
    {"weights for a skeleton that is there", run_bind},
    {"stock models", run_stock},
    {"mesh of parts", run_parts},
};
const size_t scenario_count = sizeof scenarios / sizeof *scenarios;

const scenario* scenario_named(const char* name) {
  for (size_t i = 0; i < scenario_count; ++i)
    if (strcmp(scenarios[i].name, name) == 0) return &scenarios[i];
  return NULL;
}

int scenario_chosen(const scenario* what, int count, char** names) {
  for (int i = 0; i < count; ++i)
    if (strcmp(names[i], what->name) == 0) return 1;
  return count == 0;
}

uint64_t scenario_run_well(const scenario* what, const fixture* f) {
  uint64_t digest = 1;
  const focal_status status = what->run(f, &digest);
  if (status == FOCAL_OK) return digest;
  fprintf(stderr, "%s: %s: %s\n", what->name, focal_status_name(status), focal_last_error());
  exit(2);
}
