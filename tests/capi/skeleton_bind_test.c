/* Weights for a skeleton that is there, and joints that are pinned, through the C ABI; each way to misuse them. */
#include <math.h>
#include <stdlib.h>

#include "check.h"
#include "rigged_shape.h"
#include "shapes.h"

enum { RINGS = 10 };

static focal_context* context;

static focal_mesh* rigged_mesh(void) {
  size_t size = 0;
  focal_mesh* mesh = NULL;
  unsigned char* glb = rigged_glb(RINGS, 0, &size);
  CHECK_OK(focal_mesh_load_gltf_memory(context, glb, size, NULL, &mesh));
  free(glb);
  return mesh;
}

static focal_bind_params bind_params(void) {
  focal_bind_params params;
  CHECK_OK(focal_bind_params_init(&params, sizeof params));
  return params;
}

static void check_sums(const focal_skeleton* skeleton, uint32_t joints) {
  focal_skeleton_info info;
  CHECK_OK(focal_skeleton_info_init(&info, sizeof info));
  CHECK_OK(focal_skeleton_get_info(skeleton, &info));
  CHECK(info.joint_count == joints && info.verdict == FOCAL_VERDICT_GOOD && info.quality == 1 &&
        info.unweighted_vertices == 0);
  uint32_t* numbers = malloc(4 * info.vertex_count * sizeof *numbers);
  float* weights = malloc(4 * info.vertex_count * sizeof *weights);
  CHECK_OK(focal_skeleton_weights(skeleton, info.vertex_count, numbers, weights));
  for (uint64_t v = 0; v < info.vertex_count; ++v) {
    const float* w = weights + 4 * v;
    CHECK(fabsf(w[0] + w[1] + w[2] + w[3] - 1) < 1e-4f && numbers[4 * v] < joints);
  }
  free(numbers), free(weights);
}

/* The joints of the mesh's own file. */
static void check_own(void) {
  focal_mesh *mesh = rigged_mesh(), *arrays = shape_mesh(context, RINGS, 0), *again = NULL;
  focal_skeleton *skeleton = NULL, *second = NULL;
  focal_joint before, after;
  CHECK_OK(focal_skeleton_bind(context, mesh, NULL, NULL, &skeleton));
  check_sums(skeleton, 4);
  CHECK_OK(focal_skeleton_write_gltf(skeleton, "bind_test.glb"));
  CHECK_OK(focal_mesh_load_gltf(context, "bind_test.glb", NULL, &again));
  CHECK_OK(focal_skeleton_bind(context, again, NULL, NULL, &second));
  CHECK_OK(focal_joint_init(&before, sizeof before));
  CHECK_OK(focal_joint_init(&after, sizeof after));
  for (uint32_t j = 0; j < 4; ++j) {
    CHECK_OK(focal_skeleton_get_joint(skeleton, j, &before));
    CHECK_OK(focal_skeleton_get_joint(second, j, &after));
    CHECK(strcmp(before.name, after.name) == 0 && before.parent == after.parent && before.confidence == 1);
    CHECK(memcmp(before.position, after.position, sizeof before.position) == 0);
  }
  CHECK_REFUSED(focal_skeleton_bind(context, arrays, NULL, NULL, &skeleton), FOCAL_ERROR_INVALID_ARGUMENT,
                "no glTF file");
  CHECK_REFUSED(focal_skeleton_bind(context, mesh, NULL, NULL, NULL), FOCAL_ERROR_INVALID_ARGUMENT,
                "out_skeleton");
  CHECK_REFUSED(focal_skeleton_bind(NULL, mesh, NULL, NULL, &skeleton), FOCAL_ERROR_INVALID_HANDLE,
                "is NULL");
  CHECK_REFUSED(focal_skeleton_bind(context, NULL, NULL, NULL, &skeleton), FOCAL_ERROR_INVALID_HANDLE,
                "is NULL");
  remove("bind_test.glb");
  /* The skeleton keeps what it needs. */
  CHECK_OK(focal_mesh_destroy(mesh));
  check_sums(skeleton, 4);
  focal_skeleton_destroy(skeleton), focal_skeleton_destroy(second);
  focal_mesh_destroy(arrays), focal_mesh_destroy(again);
}

static const char* const names[] = {"root", "left", "right"};
static const int32_t parents[] = {-1, 0, 0};
static const float places[] = {0, 0, 0, 0.3f, 0, 0, -0.3f, 0, 0};

static focal_bind_params three_joints(void) {
  focal_bind_params params = bind_params();
  params.joint_names = names, params.joint_count = 3, params.joint_parents = parents;
  params.joint_positions = places;
  return params;
}

/* A skeleton of the caller's, on a mesh that has none. */
static void check_given(void) {
  focal_mesh* mesh = shape_mesh(context, RINGS, 0);
  focal_skeleton* skeleton = NULL;
  focal_bind_params params = three_joints();
  focal_joint joint;
  CHECK_OK(focal_skeleton_bind(context, mesh, &params, NULL, &skeleton));
  check_sums(skeleton, 3);
  CHECK_OK(focal_joint_init(&joint, sizeof joint));
  CHECK_OK(focal_skeleton_get_joint(skeleton, 1, &joint));
  CHECK(strcmp(joint.name, "left") == 0 && joint.parent == 0 &&
        memcmp(joint.position, places + 3, sizeof joint.position) == 0);
  CHECK_OK(focal_skeleton_write_gltf(skeleton, "bind_test.glb"));
  remove("bind_test.glb");
  focal_skeleton_destroy(skeleton), skeleton = NULL;

  const int32_t moves[] = {0, 1, 1}, none[] = {0, 0, 0}, later[] = {1, -1, 0}, itself[] = {-1, 1, 0};
  const float tips[] = {NAN, 0, 0, 0.5f, 0, 0, -0.5f, 0, 0}, away[] = {0, 0, 0, INFINITY, 0, 0, 0, 0, 0},
              turns[] = {0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 1};
  const char* const nameless[] = {"root", "", "right"};
  params.joint_moves = moves, params.joint_tips = tips, params.max_influences = 8;
  CHECK_OK(focal_skeleton_bind(context, mesh, &params, NULL, &skeleton));
  CHECK_OK(focal_skeleton_get_joint(skeleton, 1, &joint));
  CHECK(fabsf(joint.tip[0] - 0.5f) < 1e-5f);
  focal_skeleton_destroy(skeleton), skeleton = NULL;
#define REFUSED(change, fragment)                                               \
  do {                                                                          \
    params = three_joints();                                                    \
    change;                                                                     \
    CHECK_REFUSED(focal_skeleton_bind(context, mesh, &params, NULL, &skeleton), \
                  FOCAL_ERROR_INVALID_ARGUMENT, fragment);                      \
  } while (0)
  REFUSED(params.joint_moves = none, "moves anything");
  REFUSED(params.joint_parents = later, "joint 0 hangs on joint 1");
  REFUSED(params.joint_parents = itself, "joint 1 hangs on joint 1");
  REFUSED(params.joint_positions = away, "joint 1 lies at no place");
  REFUSED(params.joint_rotations = turns, "joint 1 is turned by no rotation");
  REFUSED(params.joint_names = nameless, "joint 1 has no name");
  REFUSED(params.joint_names = NULL, "joint_names is NULL, other fields are not");
  REFUSED(params.joint_parents = NULL, "joint_parents");
  REFUSED(params.joint_positions = NULL, "joint_positions");
  REFUSED(params.joint_count = 0, "joint_count is 0");
  REFUSED(params.joint_count = 70000, "joint_count is 70000");
  REFUSED(params.max_influences = 9, "max_influences is 9");
  CHECK(skeleton == NULL);

  focal_task* task = NULL;
  params = three_joints();
  CHECK_OK(focal_task_create(&task));
  CHECK_OK(focal_task_cancel(task));
  CHECK(focal_skeleton_bind(context, mesh, &params, task, &skeleton) == FOCAL_ERROR_CANCELLED);
  focal_task_destroy(task);
  focal_mesh_destroy(mesh);
}

/* The joint above the pinned one goes along, and not as far. */
static void check_followers(const focal_skeleton* before, const focal_skeleton* after) {
  focal_joint from, to;
  CHECK_OK(focal_joint_init(&from, sizeof from));
  CHECK_OK(focal_joint_init(&to, sizeof to));
  CHECK_OK(focal_skeleton_get_joint(before, 0, &from));
  CHECK_OK(focal_skeleton_get_joint(after, 0, &to));
  const float moved = to.position[1] - from.position[1];
  CHECK(moved > 0 && moved < 0.0371f);
}

/* A pinned joint lies where it must, to the bit; the others follow. */
static void check_pins(void) {
  focal_training_set* set = NULL;
  focal_mesh* first = rigged_mesh();
  focal_detection* detection = NULL;
  focal_skeleton *free_one = NULL, *pinned = NULL;
  focal_skeleton_params params;
  focal_joint joint, before;
  CHECK_OK(focal_training_set_create(context, NULL, 0, &set));
  CHECK_OK(focal_training_set_add_rig(set, first));
  focal_model* model = shape_model(set);
  CHECK_OK(focal_model_detect(model, first, NULL, NULL, &detection));
  CHECK_OK(focal_skeleton_create(detection, NULL, NULL, &free_one));
  CHECK_OK(focal_joint_init(&joint, sizeof joint));
  CHECK_OK(focal_joint_init(&before, sizeof before));
  CHECK_OK(focal_skeleton_get_joint(free_one, 1, &before));
  float fixed[12];
  for (int i = 0; i < 12; ++i) fixed[i] = NAN;
  for (int i = 0; i < 3; ++i) fixed[3 + i] = before.position[i] + 0.0371f;
  CHECK_OK(focal_skeleton_params_init(&params, sizeof params));
  params.fixed_joints = fixed, params.fixed_joint_count = 4;
  CHECK_OK(focal_skeleton_create(detection, &params, NULL, &pinned));
  CHECK_OK(focal_skeleton_get_joint(pinned, 1, &joint));
  CHECK(memcmp(joint.position, fixed + 3, sizeof joint.position) == 0 && joint.confidence == 1);
  check_followers(free_one, pinned);
  focal_skeleton_destroy(pinned), pinned = NULL;
  params.fixed_joint_count = 3;
  CHECK_REFUSED(focal_skeleton_create(detection, &params, NULL, &pinned), FOCAL_ERROR_INVALID_ARGUMENT,
                "fixed_joint_count is 3, the skeleton has 4 joints");
  params.fixed_joints = NULL;
  CHECK_REFUSED(focal_skeleton_create(detection, &params, NULL, &pinned), FOCAL_ERROR_INVALID_ARGUMENT,
                "fixed_joints");
  CHECK(pinned == NULL);
  focal_skeleton_destroy(free_one), focal_detection_destroy(detection);
  focal_model_destroy(model), focal_training_set_destroy(set), focal_mesh_destroy(first);
}

int main(void) {
  CHECK_OK(focal_context_create(NULL, &context));
  check_own();
  check_given();
  check_pins();
  CHECK_OK(focal_context_destroy(context));
  FINISH();
}
