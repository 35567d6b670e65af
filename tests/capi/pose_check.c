/* A rigged character in a pose of its animation, against the file of the same character that was written in this pose.
 * usage: pose_check RIGGED.glb POSED.glb */
#include <math.h>
#include <stdlib.h>

#include "check.h"

static focal_mesh* load(const focal_context* context, const char* path, const char* animation, double time) {
  focal_mesh* mesh = NULL;
  focal_mesh_params params;
  CHECK_OK(focal_mesh_params_init(&params, sizeof params));
  params.pose_animation = animation;
  params.pose_time = time;
  CHECK_OK(focal_mesh_load_gltf(context, path, &params, &mesh));
  return mesh;
}

static double apart(const float* p, uint64_t a, uint64_t b) {
  double sum = 0;
  int i;
  for (i = 0; i < 3; ++i) sum += pow((double)p[3 * a + i] - p[3 * b + i], 2);
  return sqrt(sum);
}

/* The largest difference of distances between pairs of vertices, which no motion of the whole changes. */
static double difference(const focal_mesh* one, const focal_mesh* other) {
  focal_mesh_info info, same;
  const float *p = focal_mesh_positions(one), *q = focal_mesh_positions(other);
  double largest = 0;
  uint64_t i;
  CHECK_OK(focal_mesh_info_init(&info, sizeof info));
  CHECK_OK(focal_mesh_info_init(&same, sizeof same));
  CHECK_OK(focal_mesh_get_info(one, &info));
  CHECK_OK(focal_mesh_get_info(other, &same));
  CHECK(info.vertex_count == same.vertex_count && info.vertex_count > 1000);
  for (i = 0; i < info.vertex_count; ++i) {
    const uint64_t j = (i * 7919 + 13) % info.vertex_count;
    largest = fmax(largest, fabs(apart(p, i, j) - apart(q, i, j)));
  }
  return largest;
}

int main(int argc, char** argv) {
  focal_context* context = NULL;
  focal_mesh *rest, *start, *posed, *past, *truth, *none = NULL;
  focal_mesh_params params;
  if (argc < 3) return fprintf(stderr, "usage: pose_check RIGGED.glb POSED.glb\n"), 2;
  CHECK_OK(focal_context_create(NULL, &context));
  rest = load(context, argv[1], NULL, 0);
  start = load(context, argv[1], "stretch", 0);
  posed = load(context, argv[1], "stretch", 1);
  past = load(context, argv[1], "stretch", 100);
  truth = load(context, argv[2], NULL, 0);
  CHECK(difference(rest, start) < 1e-5);
  CHECK(difference(rest, past) < 1e-5);
  CHECK(difference(rest, truth) > 0.05);
  CHECK(difference(posed, truth) <
        0.02); /* a metre; the sample was bent half by dual quaternions, not linearly alone */

  CHECK_OK(focal_mesh_params_init(&params, sizeof params));
  params.pose_animation = "jump";
  CHECK_REFUSED(focal_mesh_load_gltf(context, argv[1], &params, &none), FOCAL_ERROR_INVALID_ARGUMENT,
                "'jump'");
  CHECK(strstr(focal_last_error(), "'stretch'") != NULL);
  params.pose_animation = "stretch";
  CHECK_REFUSED(focal_mesh_load_gltf(context, argv[2], &params, &none), FOCAL_ERROR_INVALID_ARGUMENT,
                "skinned mesh");
  params.pose_time = -1;
  CHECK_REFUSED(focal_mesh_load_gltf(context, argv[1], &params, &none), FOCAL_ERROR_INVALID_ARGUMENT,
                "pose_time");
  params.pose_time = NAN;
  CHECK_REFUSED(focal_mesh_load_gltf(context, argv[1], &params, &none), FOCAL_ERROR_INVALID_ARGUMENT,
                "pose_time");
  CHECK(none == NULL);

  focal_mesh_destroy(rest), focal_mesh_destroy(start), focal_mesh_destroy(posed), focal_mesh_destroy(past);
  focal_mesh_destroy(truth);
  CHECK_OK(focal_context_destroy(context));
  FINISH();
}
