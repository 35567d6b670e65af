/* What is asked of detections: files, maps, correspondences, segments and skeletons. */
#include <stdlib.h>

#include "fixture.h"
#include "scenario_steps.h"

void add_file(uint64_t* digest, const fixture* f, const char* name) {
  own_work_begins();
  *digest = digest_file(*digest, fixture_path(f, name));
  own_work_ends();
}

focal_status run_write(const fixture* f, uint64_t* digest) {
  TRY(focal_detection_write_gltf(f->detection, fixture_path(f, "out.glb")));
  add_file(digest, f, "out.glb");
  TRY(focal_detection_write_gltf(f->other_detection, fixture_path(f, "out.glb")));
  add_file(digest, f, "out.glb");
  return FOCAL_OK;
}

/* A detection on which nothing has been asked yet, as it keeps what it computes. */
static focal_detection* fresh(const focal_model* model, const focal_analysis* analysis) {
  focal_detection* detection = NULL;
  own_work_begins();
  if (focal_model_detect_analysis(model, analysis, NULL, NULL, &detection) != FOCAL_OK) exit(2);
  own_work_ends();
  return detection;
}

static focal_status add_maps(const fixture* f, uint64_t* digest, const focal_detection* detection,
                             float* values, uint64_t vertices) {
  TRY(focal_detection_votes(detection, 0, vertices, values));
  *digest = digest_bytes(*digest, values, (size_t)vertices * sizeof *values);
  TRY(focal_detection_distances(detection, 1, vertices, values));
  *digest = digest_bytes(*digest, values, (size_t)vertices * sizeof *values);
  TRY(focal_detection_region(detection, 2, 0.3, vertices, values));
  *digest = digest_bytes(*digest, values, (size_t)vertices * sizeof *values);
  TRY(focal_detection_write_votes_gltf(detection, fixture_path(f, "out.glb")));
  add_file(digest, f, "out.glb");
  return FOCAL_OK;
}

focal_status run_maps(const fixture* f, uint64_t* digest) {
  static float values[8192];
  focal_detection* const detection = fresh(f->model, f->analysis);
  focal_detection_info info;
  focal_detection_info_init(&info, sizeof info);
  focal_detection_get_info(detection, &info);
  const focal_status status = add_maps(f, digest, detection, values, info.vertex_count);
  focal_detection_destroy(detection);
  return status;
}

static focal_status add_points(uint64_t* digest, const focal_correspondence* map, uint64_t vertices) {
  static focal_surface_point points[8192];
  TRY(focal_correspondence_points(map, vertices, points));
  *digest = digest_bytes(*digest, points, (size_t)vertices * sizeof *points);
  static float ones[8192], carried[8192];
  TRY(focal_correspondence_carry(map, vertices, ones, vertices, carried));
  *digest = digest_bytes(*digest, carried, (size_t)vertices * sizeof *carried);
  return FOCAL_OK;
}

focal_status run_correspondence(const fixture* f, uint64_t* digest) {
  focal_correspondence* map = NULL;
  focal_detection_info info;
  TRY(focal_detection_info_init(&info, sizeof info));
  TRY(focal_detection_get_info(f->detection, &info));
  TRY(focal_correspondence_create(f->detection, f->other_detection, NULL, &map));
  const focal_status status = add_points(digest, map, info.vertex_count);
  focal_correspondence_destroy(map);
  return status;
}

focal_status run_segment(const fixture* f, uint64_t* digest) {
  static int32_t labels[16384];
  focal_detection_info info;
  TRY(focal_detection_info_init(&info, sizeof info));
  TRY(focal_detection_get_info(f->rig_detection, &info));
  for (focal_segmentation method = FOCAL_SEGMENTATION_AUTO; method <= FOCAL_SEGMENTATION_SKELETON; ++method) {
    TRY(focal_detection_segment(f->rig_detection, method, NULL, info.triangle_count, labels));
    *digest = digest_bytes(*digest, labels, (size_t)info.triangle_count * sizeof *labels);
  }
  TRY(focal_detection_write_segments_gltf(f->rig_detection, FOCAL_SEGMENTATION_AUTO,
                                          fixture_path(f, "out.glb")));
  add_file(digest, f, "out.glb");
  return FOCAL_OK;
}

static focal_status write_skeleton(const fixture* f, uint64_t* digest, focal_skeleton* skeleton) {
  const focal_status status = focal_skeleton_write_gltf(skeleton, fixture_path(f, "out.glb"));
  if (status == FOCAL_OK) add_file(digest, f, "out.glb");
  focal_skeleton_destroy(skeleton);
  return status;
}

focal_status run_skeleton(const fixture* f, uint64_t* digest) {
  focal_skeleton* skeleton = NULL;
  focal_skeleton_params params;
  TRY(focal_skeleton_params_init(&params, sizeof params));
  params.animations = f->rigged, params.symmetric = 1, params.rest_pose = 1, params.ground_root = 1;
  TRY(focal_skeleton_create(f->rig_detection, &params, NULL, &skeleton));
  return write_skeleton(f, digest, skeleton);
}

focal_status run_template(const fixture* f, uint64_t* digest) {
  focal_skeleton* skeleton = NULL;
  focal_skeleton_params params;
  TRY(focal_skeleton_params_init(&params, sizeof params));
  params.skeleton_template =
      "{\"format\":\"focal-skeleton-template\",\"version\":1,\"joints\":["
      "{\"name\":\"root\",\"centre\":[\"nose\",\"hand.L\",\"tail\"]},"
      "{\"name\":\"arm\",\"parent\":\"root\",\"between\":[\"nose\",\"hand.L\"],\"tip\":\"hand.L\"},"
      "{\"name\":\"tail\",\"parent\":\"root\",\"surface\":[\"tail\"]}]}";
  TRY(focal_skeleton_create(f->detection, &params, NULL, &skeleton));
  return write_skeleton(f, digest, skeleton);
}

/* Weights for the joints of the mesh's own file, and for joints of the caller's. */
focal_status run_bind(const fixture* f, uint64_t* digest) {
  static const char* const names[] = {"root", "left"};
  static const int32_t parents[] = {-1, 0};
  static const float places[] = {0, 0, 0, 0.4f, 0, 0};
  focal_skeleton* skeleton = NULL;
  focal_bind_params params;
  TRY(focal_skeleton_bind(f->context, f->rigged, NULL, NULL, &skeleton));
  TRY(write_skeleton(f, digest, skeleton));
  TRY(focal_bind_params_init(&params, sizeof params));
  params.joint_names = names, params.joint_parents = parents, params.joint_positions = places;
  params.joint_count = 2, params.max_influences = 8;
  TRY(focal_skeleton_bind(f->context, f->mesh, &params, NULL, &skeleton));
  return write_skeleton(f, digest, skeleton);
}
