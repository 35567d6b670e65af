/* Skeletons through the C ABI: learned from characters and by templates; each way to misuse them. (How well they fit is tested by
 * samples/rig.) */
#include <math.h>
#include <stdlib.h>

#include "check.h"
#include "rigged_shape.h"
#include "shapes.h"

enum { RINGS = 10 };

static focal_context* context;

static focal_mesh* load(const unsigned char* glb, size_t size) {
  focal_mesh* mesh = NULL;
  CHECK_OK(focal_mesh_load_gltf_memory(context, glb, size, NULL, &mesh));
  return mesh;
}

static focal_mesh* rigged_mesh(float variation) {
  size_t size = 0;
  unsigned char* glb = rigged_glb(RINGS, variation, &size);
  focal_mesh* mesh = load(glb, size);
  free(glb);
  return mesh;
}

static focal_mesh* bare_mesh(void) {
  size_t size = 0;
  shape body = shape_create(RINGS, 0.03f);
  unsigned char* glb = shape_glb(&body, &size);
  focal_mesh* mesh = load(glb, size);
  shape_destroy(&body);
  free(glb);
  return mesh;
}

static void check_no_skeleton(void) {
  focal_training_set *rigs = NULL, *marks = NULL;
  focal_skeleton* skeleton = NULL;
  focal_skeleton_params params;
  focal_skeleton_info info;
  focal_joint joint;
  const char* names[] = {"nose"};
  uint32_t vertex = 0;
  CHECK_OK(focal_training_set_create(context, NULL, 0, &rigs));
  CHECK_OK(focal_training_set_create(context, names, 1, &marks));
  focal_mesh* mesh = shape_mesh(context, 8, 0);

  /* A mesh from arrays has no file, hence no skin. */
  CHECK_REFUSED(focal_training_set_add_rig(rigs, mesh), FOCAL_ERROR_INVALID_ARGUMENT, "no glTF file");
  CHECK_REFUSED(focal_training_set_add_rig(marks, mesh), FOCAL_ERROR_INVALID_ARGUMENT, "names of its own");
  CHECK_REFUSED(focal_training_set_add_rig(rigs, NULL), FOCAL_ERROR_INVALID_HANDLE, "focal_mesh");
  CHECK_REFUSED(focal_training_set_add_vertices(rigs, mesh, &vertex, 1), FOCAL_ERROR_INVALID_ARGUMENT,
                "without landmark names");
  CHECK(focal_training_set_mesh_count(rigs) == 0);

  CHECK_OK(focal_skeleton_params_init(&params, sizeof params));
  CHECK(params.names == FOCAL_BONE_NAMES_AS_TRAINED && params.joint_names == NULL);
  CHECK_OK(focal_skeleton_info_init(&info, sizeof info));
  CHECK_OK(focal_joint_init(&joint, sizeof joint));
  CHECK_REFUSED(focal_skeleton_create(NULL, &params, NULL, &skeleton), FOCAL_ERROR_INVALID_HANDLE, "is NULL");
  CHECK_REFUSED(focal_skeleton_create(NULL, &params, NULL, NULL), FOCAL_ERROR_INVALID_ARGUMENT,
                "out_skeleton");
  CHECK(skeleton == NULL);
  CHECK_REFUSED(focal_skeleton_get_info(NULL, &info), FOCAL_ERROR_INVALID_HANDLE, "is NULL");
  CHECK_REFUSED(focal_skeleton_get_joint(NULL, 0, &joint), FOCAL_ERROR_INVALID_HANDLE, "is NULL");
  CHECK_REFUSED(focal_skeleton_write_gltf(NULL, "out.glb"), FOCAL_ERROR_INVALID_HANDLE, "is NULL");
  CHECK_OK(focal_skeleton_destroy(NULL));
  CHECK(focal_model_joint_count(NULL) == 0);

  CHECK_OK(focal_mesh_destroy(mesh));
  CHECK_OK(focal_training_set_destroy(marks));
  CHECK_OK(focal_training_set_destroy(rigs));
}

#define TEMPLATE(rest) "{\"format\":\"focal-skeleton-template\",\"version\":1," rest "}"
#define JOINT_A "{\"name\":\"a\",\"surface\":[\"nose\"],\"rest\":[0,0,1]}"
#define JOINTS(list) TEMPLATE("\"joints\":[" list "]")
#define ONE(more) JOINTS("{\"name\":\"a\",\"surface\":[\"nose\"]," more "}")

static const char* const good_template =
    TEMPLATE("\"symmetric\":false,\"joints\":[" JOINT_A
             ",{\"name\":\"b.L\",\"parent\":\"a\",\"centre\":[\"hand.L\"],\"rest\":[1,0,0]},{\"name\":\"c\","
             "\"parent\":\"a\","
             "\"between\":[\"nose\",\"tail\"],\"share\":0.25,\"tip\":\"tail\",\"rest\":[0,1,0]}]");

static focal_status by_template(const focal_detection* detection, const char* text,
                                focal_skeleton** skeleton) {
  focal_skeleton_params params;
  CHECK_OK(focal_skeleton_params_init(&params, sizeof params));
  params.skeleton_template = text;
  return focal_skeleton_create(detection, &params, NULL, skeleton);
}

static void check_bad_templates(const focal_detection* detection) {
  static const struct {
    const char *text, *message;
  } wrong[] = {
      {"[]", "has no \"format\""},
      {"{}", "has no \"format\""},
      {"{\"format\":null}", "has no \"format\""},
      {"{\"format\":3}", "\"format\" that is no text"},
      {"{\"format\":\"another\",\"version\":1,\"joints\":[]}", "has no \"format\""},
      {TEMPLATE("\"joint\":[]"), "unknown \"joint\""},
      {TEMPLATE("\"symmetric\":1,\"joints\":[]"), "neither true nor false"},
      {TEMPLATE("\"symmetric\":true"), "no list of \"joints\""},
      {TEMPLATE("\"joints\":3"), "no list of \"joints\""},
      {JOINTS("3"), "a joint that is not an object"},
      {JOINTS("{\"name\":3}"), "\"name\" that is no text"},
      {JOINTS("{\"nane\":\"a\"}"), "unknown \"nane\""},
      {JOINTS("{\"name\":\"a\",\"centre\":\"nose\"}"), "\"centre\" that is no list"},
      {JOINTS("{\"name\":\"a\",\"centre\":[3]}"), "\"centre\" that is no list of names"},
      {ONE("\"share\":\"half\""), "\"share\" that is no number"},
      {ONE("\"rest\":3"), "no list of three numbers"},
      {ONE("\"rest\":{\"x\":1,\"y\":2,\"z\":3}"), "no list of three numbers"},
      {ONE("\"rest\":[1,2]"), "no list of three numbers"},
      {ONE("\"rest\":[1,2,\"3\"]"), "no list of three numbers"},
      {ONE("\"rest\":[0,0,0]"), "without a direction"},
      {ONE("\"rest\":[0,1e-9,0]"), "without a direction"},
      {ONE("\"rest\":[1e300,1e300,0]"), "without a direction"},
  };
  static const char* const versions[] = {"{\"format\":\"focal-skeleton-template\"}",
                                         "{\"format\":\"focal-skeleton-template\",\"version\":\"1\"}",
                                         "{\"format\":\"focal-skeleton-template\",\"version\":1.5}",
                                         "{\"format\":\"focal-skeleton-template\",\"version\":2}"};
  focal_skeleton* skeleton = NULL;
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; ++i)
    CHECK_REFUSED(by_template(detection, wrong[i].text, &skeleton), FOCAL_ERROR_INVALID_ARGUMENT,
                  wrong[i].message);
  for (size_t i = 0; i < sizeof versions / sizeof *versions; ++i)
    CHECK_REFUSED(by_template(detection, versions[i], &skeleton), FOCAL_ERROR_UNSUPPORTED, "another version");
  CHECK_REFUSED(by_template(detection, "{", &skeleton), FOCAL_ERROR_INVALID_FILE,
                "the skeleton template: JSON");
  CHECK(skeleton == NULL);
  CHECK_OK(by_template(detection, ONE("\"rest\":[1e9,0,0]"), &skeleton));
  focal_skeleton_destroy(skeleton);
}

static void check_weights(const focal_skeleton* skeleton, uint32_t joints) {
  focal_skeleton_info info;
  CHECK_OK(focal_skeleton_info_init(&info, sizeof info));
  CHECK_OK(focal_skeleton_get_info(skeleton, &info));
  CHECK(info.joint_count == joints && info.max_influences >= 1 && info.max_influences <= 4 &&
        info.unweighted_vertices == 0);
  uint32_t* numbers = malloc(4 * info.vertex_count * sizeof *numbers);
  float* weights = malloc(4 * info.vertex_count * sizeof *weights);
  CHECK_OK(focal_skeleton_weights(skeleton, info.vertex_count, numbers, weights));
  for (uint64_t v = 0; v < info.vertex_count; ++v) {
    float sum = 0;
    for (int i = 0; i < 4; ++i) sum += weights[4 * v + (uint64_t)i];
    CHECK(fabsf(sum - 1) < 1e-4f);
    for (int i = 0; i < 4; ++i) CHECK(numbers[4 * v + (uint64_t)i] < joints);
  }
  CHECK_REFUSED(focal_skeleton_weights(skeleton, info.vertex_count - 1, numbers, weights),
                FOCAL_ERROR_INVALID_ARGUMENT, "vertex_count is");
  free(numbers), free(weights);
  focal_joint joint;
  CHECK_OK(focal_joint_init(&joint, sizeof joint));
  CHECK_OK(focal_skeleton_get_joint(skeleton, joints - 1, &joint));
  CHECK_REFUSED(focal_skeleton_get_joint(skeleton, joints, &joint), FOCAL_ERROR_INVALID_ARGUMENT,
                "joints, there is no number");
}

/* As a caller of the first release sees it, and as one of this release does. */
static void check_verdict(const focal_skeleton* skeleton) {
  focal_skeleton_info info;
  CHECK_OK(focal_skeleton_info_init(&info, sizeof info));
  CHECK_OK(focal_skeleton_get_info(skeleton, &info));
  CHECK(info.verdict >= FOCAL_VERDICT_GOOD && info.verdict <= FOCAL_VERDICT_FAILED);
  CHECK(info.quality >= 0 && info.quality <= 1 && info.guessed_joints <= info.joint_count);
  if (info.verdict != FOCAL_VERDICT_GOOD) { /* then a warning says why */
    int said = 0;
    for (uint32_t i = 0; i < info.warning_count; ++i)
      said |= strstr(focal_skeleton_warning(skeleton, i), "the rig ") != NULL;
    CHECK(said);
  }
  memset(&info, 0x55, sizeof info);
  CHECK_REFUSED(focal_skeleton_info_init(&info, 31), FOCAL_ERROR_INVALID_ARGUMENT, "struct_size is 31");
  CHECK_OK(focal_skeleton_info_init(&info, 32));
  CHECK_OK(focal_skeleton_get_info(skeleton, &info));
  CHECK(info.struct_size == 32 && info.joint_count > 0 && info.verdict == 0x55555555);
}

/* Written with the mesh it can be learned from as any character. */
static void check_written(const focal_skeleton* skeleton) {
  focal_mesh* mesh = NULL;
  focal_training_set* set = NULL;
  CHECK_OK(focal_skeleton_write_gltf(skeleton, "skeleton_test.glb"));
  CHECK_OK(focal_mesh_load_gltf(context, "skeleton_test.glb", NULL, &mesh));
  CHECK_OK(focal_training_set_create(context, NULL, 0, &set));
  CHECK_OK(focal_training_set_add_rig(set, mesh));
  focal_training_set_destroy(set);
  focal_mesh_destroy(mesh);
  remove("skeleton_test.glb");
}

static void check_templates(void) {
  focal_training_set* set = shape_training_set(context, RINGS, 3);
  focal_model* model = shape_model(set);
  focal_mesh *mesh = bare_mesh(), *character = rigged_mesh(0);
  focal_detection* detection = NULL;
  focal_skeleton* skeleton = NULL;
  focal_skeleton_params params;
  focal_joint joint;
  const char* names[] = {"first", NULL, "third"};
  CHECK_OK(focal_model_detect(model, mesh, NULL, NULL, &detection));
  check_bad_templates(detection);
  CHECK_REFUSED(focal_skeleton_create(detection, NULL, NULL, &skeleton), FOCAL_ERROR_INVALID_ARGUMENT, "");

  CHECK_OK(by_template(detection, good_template, &skeleton));
  check_weights(skeleton, 3);
  check_verdict(skeleton);
  check_written(skeleton);
  CHECK_OK(focal_joint_init(&joint, sizeof joint));
  CHECK_OK(focal_skeleton_get_joint(skeleton, 1, &joint));
  CHECK(strcmp(joint.name, "b.L") == 0 && joint.parent == 0);
  focal_skeleton_destroy(skeleton), skeleton = NULL;

  CHECK_OK(focal_skeleton_params_init(&params, sizeof params));
  params.skeleton_template = good_template;
  params.joint_names = names, params.joint_name_count = 2;
  CHECK_REFUSED(focal_skeleton_create(detection, &params, NULL, &skeleton), FOCAL_ERROR_INVALID_ARGUMENT,
                "joint_name_count is 2, the skeleton has 3 joints");
  params.joint_names = NULL, params.joint_name_count = 3;
  CHECK_REFUSED(focal_skeleton_create(detection, &params, NULL, &skeleton), FOCAL_ERROR_INVALID_ARGUMENT,
                "joint_name_count is 3");
  params.joint_names = names, params.rest_pose = 1, params.symmetric = 1,
  params.names = FOCAL_BONE_NAMES_UNITY;
  CHECK_OK(focal_skeleton_create(detection, &params, NULL, &skeleton));
  CHECK_OK(focal_skeleton_get_joint(skeleton, 0, &joint));
  CHECK(strcmp(joint.name, "first") == 0);
  CHECK_OK(focal_skeleton_get_joint(skeleton, 1, &joint));
  CHECK(strcmp(joint.name, "b.L") == 0); /* none has a role in the convention: kept, and said so */
  CHECK(focal_skeleton_warning(skeleton, 0) &&
        strstr(focal_skeleton_warning(skeleton, 0), "no bone has a role"));
  check_written(skeleton);
  focal_skeleton_destroy(skeleton), skeleton = NULL;

  CHECK_OK(focal_skeleton_params_init(&params, sizeof params));
  params.skeleton_template = ONE("\"share\":0.5"), params.rest_pose = 1;
  CHECK_REFUSED(focal_skeleton_create(detection, &params, NULL, &skeleton), FOCAL_ERROR_INVALID_ARGUMENT,
                "no rest pose");
  params.rest_pose = 0, params.animations = character;
  CHECK_REFUSED(focal_skeleton_create(detection, &params, NULL, &skeleton), FOCAL_ERROR_INVALID_ARGUMENT,
                "together with a template");
  params.animations = NULL, params.rest_pose = 4;
  CHECK_REFUSED(focal_skeleton_create(detection, &params, NULL, &skeleton), FOCAL_ERROR_INVALID_ARGUMENT,
                "rest_pose is 4");
  params.rest_pose = 0, params.drop_helpers = 2;
  CHECK_REFUSED(focal_skeleton_create(detection, &params, NULL, &skeleton), FOCAL_ERROR_INVALID_ARGUMENT,
                "drop_helpers is 2");
  params.drop_helpers = 0;
  CHECK(skeleton == NULL);
  focal_detection_destroy(detection);
  focal_mesh_destroy(mesh), focal_mesh_destroy(character);
  focal_model_destroy(model);
  focal_training_set_destroy(set);
}

/* A model that carries a template rigs by it, now and from its file. */
static void check_carried_template(void) {
  focal_training_set *set = shape_training_set(context, RINGS, 3), *rigs = NULL;
  focal_model *bare = shape_model(set), *model = NULL, *loaded = NULL;
  focal_mesh *mesh = bare_mesh(), *character = rigged_mesh(0);
  focal_detection* detection = NULL;
  focal_skeleton* skeleton = NULL;
  focal_skeleton_params params;
  focal_blob* blob = NULL;
  CHECK(focal_model_skeleton_template(bare) == NULL && focal_model_joint_count(bare) == 0);
  CHECK_REFUSED(focal_training_set_set_skeleton(set, JOINTS("{\"name\":\"a\",\"centre\":[\"nothing\"]}")),
                FOCAL_ERROR_INVALID_ARGUMENT, "nothing");
  CHECK_REFUSED(focal_training_set_set_skeleton(set, "{"), FOCAL_ERROR_INVALID_FILE, "JSON");
  char* spaces = malloc((1 << 20) + 2);
  memset(spaces, ' ', (1 << 20) + 1), spaces[(1 << 20) + 1] = 0;
  CHECK_REFUSED(focal_training_set_set_skeleton(set, spaces), FOCAL_ERROR_UNSUPPORTED, "longer than 1 MiB");
  free(spaces);
  CHECK_OK(focal_training_set_create(context, NULL, 0, &rigs));
  CHECK_REFUSED(focal_training_set_set_skeleton(rigs, good_template), FOCAL_ERROR_INVALID_ARGUMENT,
                "without landmark names");
  CHECK_OK(focal_training_set_set_skeleton(set, good_template));
  model = shape_model(set);
  CHECK_OK(focal_training_set_set_skeleton(set, NULL));
  focal_model* without = shape_model(set);
  CHECK(focal_model_skeleton_template(without) == NULL);
  CHECK_OK(focal_model_save_memory(model, &blob));
  CHECK_OK(focal_model_load_memory(context, focal_blob_data(blob), focal_blob_size(blob), &loaded));
  CHECK(strcmp(focal_model_skeleton_template(loaded), good_template) == 0);
  CHECK(focal_model_joint_count(loaded) == 3 && strcmp(focal_model_joint_name(loaded, 1), "b.L") == 0);
  CHECK_OK(focal_model_detect(loaded, mesh, NULL, NULL, &detection));
  CHECK_OK(focal_skeleton_create(detection, NULL, NULL, &skeleton));
  check_weights(skeleton, 3);
  focal_skeleton_destroy(skeleton), skeleton = NULL;
  CHECK_OK(by_template(detection, ONE("\"share\":0.5"), &skeleton)); /* the caller's goes before it */
  check_weights(skeleton, 1);
  focal_skeleton_destroy(skeleton), skeleton = NULL;
  CHECK_OK(focal_skeleton_params_init(&params, sizeof params));
  params.animations = character;
  CHECK_REFUSED(focal_skeleton_create(detection, &params, NULL, &skeleton), FOCAL_ERROR_INVALID_ARGUMENT,
                "together with a template");
  focal_mesh_info info;
  CHECK_OK(focal_mesh_info_init(&info, sizeof info));
  CHECK_OK(focal_mesh_get_info(mesh, &info));
  int32_t* parts = malloc(info.triangle_count * sizeof *parts);
  CHECK_OK(focal_detection_segment(detection, FOCAL_SEGMENTATION_AUTO, NULL, info.triangle_count, parts));
  int seen = 0; /* parts are those of the joints */
  for (uint64_t t = 0; t < info.triangle_count; ++t)
    seen |= parts[t] >= 0 && parts[t] < 3 ? 1 << parts[t] : 8;
  CHECK(seen == 7);
  free(parts);
  focal_blob_destroy(blob), focal_detection_destroy(detection);
  focal_mesh_destroy(mesh), focal_mesh_destroy(character);
  focal_model_destroy(bare), focal_model_destroy(model), focal_model_destroy(loaded),
      focal_model_destroy(without);
  focal_training_set_destroy(set), focal_training_set_destroy(rigs);
}

static void check_learned(void) {
  focal_training_set* set = NULL;
  focal_mesh *first = rigged_mesh(0), *second = rigged_mesh(0.06f), *bare = bare_mesh(),
             *arrays = shape_mesh(context, RINGS, 0);
  focal_detection* detection = NULL;
  focal_skeleton* skeleton = NULL;
  focal_skeleton_params params;
  focal_train_params trained;
  CHECK_OK(focal_training_set_create(context, NULL, 0, &set));
  CHECK_OK(focal_training_set_add_rig(set, first));
  CHECK_OK(focal_training_set_add_rig(set, second));
  focal_model* model = shape_model(set);
  CHECK(focal_model_joint_count(model) == 4 && strcmp(focal_model_joint_name(model, 0), "root") == 0);
  CHECK(focal_model_joint_name(model, 4) == NULL);
  CHECK_OK(focal_train_params_init(&trained, sizeof trained));
  CHECK_OK(focal_model_get_train_params(model, &trained));
  CHECK(trained.rigged_shapes >= 2);
  CHECK_OK(focal_model_detect(model, bare, NULL, NULL, &detection));
  CHECK_OK(focal_skeleton_params_init(&params, sizeof params));
  params.animations = first;
  CHECK_OK(focal_skeleton_create(detection, &params, NULL, &skeleton));
  check_weights(skeleton, 4);
  check_verdict(skeleton);
  check_written(skeleton);
  focal_skeleton_destroy(skeleton), skeleton = NULL;
  params.animations = arrays;
  CHECK_REFUSED(focal_skeleton_create(detection, &params, NULL, &skeleton), FOCAL_ERROR_INVALID_ARGUMENT,
                "no glTF file to take animations from");
  params.animations = bare;
  CHECK_REFUSED(focal_skeleton_create(detection, &params, NULL, &skeleton), FOCAL_ERROR_INVALID_ARGUMENT,
                "has no skin");
  CHECK(skeleton == NULL);
  int32_t* parts = malloc(4096 * sizeof *parts);
  focal_mesh_info info;
  CHECK_OK(focal_mesh_info_init(&info, sizeof info));
  CHECK_OK(focal_mesh_get_info(bare, &info));
  CHECK_OK(focal_detection_segment(detection, FOCAL_SEGMENTATION_AUTO, NULL, info.triangle_count, parts));
  int seen = 0; /* parts are those of the joints */
  for (uint64_t t = 0; t < info.triangle_count; ++t)
    seen |= parts[t] >= 0 && parts[t] < 4 ? 1 << parts[t] : 16;
  CHECK(seen == 15);
  free(parts);
  focal_detection_destroy(detection), focal_model_destroy(model), focal_training_set_destroy(set);
  focal_mesh_destroy(first), focal_mesh_destroy(second), focal_mesh_destroy(bare), focal_mesh_destroy(arrays);
}

int main(void) {
  CHECK_OK(focal_context_create(NULL, &context));
  check_no_skeleton();
  check_templates();
  check_carried_template();
  check_learned();
  CHECK_OK(focal_context_destroy(context));
  FINISH();
}
