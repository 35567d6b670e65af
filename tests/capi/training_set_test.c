/* The training set as a builder, and training sets that nothing can be learned from. */
#include <math.h>
#include <stdlib.h>

#include "check.h"
#include "rigged_shape.h"
#include "shapes.h"

static focal_context* context;

static void check_names(void) {
  focal_training_set* set = NULL;
  const char* const twice[] = {"nose", "nose"};
  const char* const empty[] = {"nose", ""};
  CHECK_REFUSED(focal_training_set_create(context, twice, 2, &set), FOCAL_ERROR_INVALID_ARGUMENT,
                "two landmarks are named \"nose\"");
  CHECK_REFUSED(focal_training_set_create(context, empty, 2, &set), FOCAL_ERROR_INVALID_ARGUMENT,
                "landmark name 1 is empty");
  CHECK_REFUSED(focal_training_set_create(context, NULL, 2, &set), FOCAL_ERROR_INVALID_ARGUMENT, "is NULL");
  CHECK_REFUSED(focal_training_set_create(context, twice, 0, &set), FOCAL_ERROR_INVALID_ARGUMENT,
                "landmark_count is 0");
  CHECK_REFUSED(focal_training_set_create(NULL, twice, 1, &set), FOCAL_ERROR_INVALID_HANDLE,
                "focal_context is NULL");
  CHECK(set == NULL);
}

static void check_name_count(void) {
  enum { MOST = 4096 };
  static char texts[MOST + 1][8];
  const char* names[MOST + 1];
  for (int i = 0; i <= MOST; ++i) snprintf(texts[i], sizeof texts[i], "n%d", i), names[i] = texts[i];
  focal_training_set* set = NULL;
  CHECK_REFUSED(focal_training_set_create(context, names, MOST + 1, &set), FOCAL_ERROR_INVALID_ARGUMENT,
                "landmark_count is 4097");
  for (uint64_t count = 1; count <= MOST; count += MOST - 1) {
    CHECK_OK(focal_training_set_create(context, names, count, &set));
    CHECK(focal_training_set_landmark_count(set) == count);
    focal_training_set_destroy(set);
  }
}

/* The first and the last vertex and triangle are there, the next ones are not; weights are those of a point. */
static void check_places(void) {
  shape body = shape_create(8, 0);
  focal_mesh* mesh = shape_mesh(context, 8, 0);
  const uint32_t vertices = (uint32_t)body.vertex_count, triangles = (uint32_t)body.index_count / 3;
  focal_surface_point point;
  float position[3];
  CHECK_OK(focal_mesh_point_at_vertex(mesh, vertices - 1, &point));
  CHECK_REFUSED(focal_mesh_point_at_vertex(mesh, vertices, &point), FOCAL_ERROR_INVALID_LANDMARK,
                "no vertex");
  const focal_surface_point last = {triangles - 1, {0, 0, 1}}, behind = {triangles, {0, 0, 1}},
                            nowhere = {0, {0, 0, 0}}, far_away = {0, {1, INFINITY, 0}};
  CHECK_OK(focal_mesh_position_of(mesh, &last, position));
  CHECK_REFUSED(focal_mesh_position_of(mesh, &behind, position), FOCAL_ERROR_INVALID_LANDMARK, "no triangle");
  CHECK_REFUSED(focal_mesh_position_of(mesh, &nowhere, position), FOCAL_ERROR_INVALID_LANDMARK,
                "barycentric");
  CHECK_REFUSED(focal_mesh_position_of(mesh, &far_away, position), FOCAL_ERROR_INVALID_LANDMARK,
                "barycentric");
  focal_mesh_destroy(mesh);
  shape_destroy(&body);
}

static void check_rigs(void) {
  size_t size = 0;
  unsigned char* glb = rigged_glb(8, 0, &size);
  focal_mesh *rigged = NULL, *bare = NULL, *idle = NULL;
  focal_training_set *rigs = NULL, *marks = shape_training_set(context, 8, 1);
  CHECK_OK(focal_training_set_create(context, NULL, 0, &rigs));
  CHECK_OK(focal_mesh_load_gltf_memory(context, glb, size, NULL, &rigged));
  CHECK_OK(focal_training_set_add_rig(rigs, rigged));
  CHECK(focal_training_set_mesh_count(rigs) == 1 && focal_training_set_landmark_count(rigs) == 0);
  CHECK_REFUSED(focal_training_set_add_rig(marks, rigged), FOCAL_ERROR_INVALID_ARGUMENT,
                "landmark names of its own");
  for (size_t i = 0; i + 10 < size; ++i) { /* no influences, then no skin either */
    if (memcmp(glb + i, "\"WEIGHTS_0\"", 11) == 0) memcpy(glb + i, "\"_EIGHTS_0\"", 11);
  }
  CHECK_OK(focal_mesh_load_gltf_memory(context, glb, size, NULL, &idle));
  CHECK_REFUSED(focal_training_set_add_rig(rigs, idle), FOCAL_ERROR_INVALID_ARGUMENT,
                "no vertex of the mesh is moved");
  free(glb);
  shape body = shape_create(8, 0);
  glb = shape_glb(&body, &size);
  CHECK_OK(focal_mesh_load_gltf_memory(context, glb, size, NULL, &bare));
  CHECK_REFUSED(focal_training_set_add_rig(rigs, bare), FOCAL_ERROR_INVALID_ARGUMENT, "the mesh has no skin");
  CHECK(focal_training_set_mesh_count(rigs) == 1);
  free(glb);
  shape_destroy(&body);
  focal_mesh_destroy(rigged), focal_mesh_destroy(bare), focal_mesh_destroy(idle);
  focal_training_set_destroy(rigs), focal_training_set_destroy(marks);
}

static focal_mesh* rigged_mesh(const unsigned char* glb, size_t size) {
  focal_mesh* mesh = NULL;
  CHECK_OK(focal_mesh_load_gltf_memory(context, glb, size, NULL, &mesh));
  return mesh;
}

static void replace(unsigned char* bytes, size_t size, const char* from, const char* to) {
  for (size_t i = 0; i + strlen(from) <= size; ++i)
    if (memcmp(bytes + i, from, strlen(from)) == 0) memcpy(bytes + i, to, strlen(from));
}

/* Three weights of the character are no weights. */
static void spoil_weights(unsigned char* glb, size_t size) {
  const float weights[12] = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0},
              corrupted[12] = {NAN, 0, 0, 0, 1, -1, 0, 0, 1, INFINITY};
  for (size_t i = 0; i + sizeof weights <= size; i += 4) {
    if (memcmp(glb + i, weights, sizeof weights) != 0) continue;
    memcpy(glb + i, corrupted, sizeof corrupted);
    return;
  }
  CHECK(!"the file has weights");
}

/* What is odd about characters is said before any training; those of other skeletons are refused. */
static void check_teachers(void) {
  size_t size = 0;
  unsigned char* glb = rigged_glb(8, 0, &size);
  focal_mesh* sound = rigged_mesh(glb, size);
  spoil_weights(glb, size);
  focal_mesh* corrupted = rigged_mesh(glb, size);
  replace(glb, size, "\"bone.", "\"limb.");
  focal_mesh* foreign = rigged_mesh(glb, size);
  focal_training_set *set = NULL, *marks = shape_training_set(context, 8, 1);
  focal_model* model = NULL;
  CHECK_OK(focal_training_set_create(context, NULL, 0, &set));
  CHECK_REFUSED(focal_training_set_check(set), FOCAL_ERROR_INVALID_ARGUMENT, "no rigged character");
  CHECK_REFUSED(focal_training_set_check(NULL), FOCAL_ERROR_INVALID_HANDLE, "is NULL");
  CHECK_OK(focal_training_set_check(marks)); /* nothing to say of marks */
  CHECK(focal_training_set_warning_count(marks) == 0);
  CHECK_OK(focal_training_set_add_rig(set, sound));
  CHECK_OK(focal_training_set_check(set));
  CHECK(focal_training_set_warning_count(set) == 0 && focal_training_set_warning(set, 0) == NULL);
  CHECK_OK(focal_training_set_add_rig(set, corrupted));
  CHECK(focal_training_set_warning_count(set) == 0); /* until it is looked at again */
  CHECK_OK(focal_training_set_check(set));
  CHECK(focal_training_set_warning_count(set) == 1);
  CHECK(strstr(focal_training_set_warning(set, 0),
               "character 2: 3 skin weights are negative, NaN or infinite"));
  CHECK(focal_training_set_warning(set, 1) == NULL);
  focal_training_set_destroy(set), set = NULL;
  CHECK_OK(focal_training_set_create(context, NULL, 0, &set));
  CHECK_OK(focal_training_set_add_rig(set, sound));
  CHECK_OK(focal_training_set_add_rig(set, foreign));
  CHECK_REFUSED(focal_training_set_check(set), FOCAL_ERROR_INVALID_ARGUMENT, "share 1 of 4 joints");
  CHECK_REFUSED(focal_model_train(set, NULL, NULL, &model), FOCAL_ERROR_INVALID_ARGUMENT, "'root'");
  CHECK(model == NULL);
  free(glb);
  focal_training_set_destroy(set), focal_training_set_destroy(marks);
  focal_mesh_destroy(sound), focal_mesh_destroy(corrupted), focal_mesh_destroy(foreign);
}

static void check_marks(void) {
  shape body = shape_create(8, 0);
  focal_mesh* mesh = shape_mesh(context, 8, 0);
  focal_training_set* set = shape_training_set(context, 8, 1);
  uint32_t vertices[SHAPE_MARKS] = {body.marks[0], FOCAL_NO_VERTEX, 1u << 20};
  focal_surface_point points[SHAPE_MARKS] = {
      {5, {1, 1, 2}}, {FOCAL_NO_TRIANGLE, {0, 0, 0}}, {7, {0.5f, 0.5f, -0.1f}}};
  CHECK_REFUSED(focal_training_set_add_vertices(set, mesh, vertices, SHAPE_MARKS),
                FOCAL_ERROR_INVALID_LANDMARK,
                "landmark \"tail\" of training mesh 1: the mesh has no vertex 1048576");
  CHECK_REFUSED(focal_training_set_add(set, mesh, points, SHAPE_MARKS), FOCAL_ERROR_INVALID_LANDMARK,
                "landmark \"tail\" of training mesh 1: its barycentric weights");
  points[2].triangle = 1u << 20;
  CHECK_REFUSED(focal_training_set_add(set, mesh, points, SHAPE_MARKS), FOCAL_ERROR_INVALID_LANDMARK,
                "no triangle 1048576");
  CHECK_REFUSED(focal_training_set_add(set, mesh, points, 2), FOCAL_ERROR_INVALID_ARGUMENT,
                "2 landmarks given");
  CHECK_REFUSED(focal_training_set_add(set, mesh, NULL, SHAPE_MARKS), FOCAL_ERROR_INVALID_ARGUMENT,
                "is NULL");
  CHECK(focal_training_set_mesh_count(set) == 1); /* as it was */
  points[2].triangle = FOCAL_NO_TRIANGLE;
  CHECK_OK(focal_training_set_add(set, mesh, points, SHAPE_MARKS));
  CHECK(focal_training_set_mesh_count(set) == 2 && focal_training_set_landmark_count(set) == SHAPE_MARKS);
  /* "hand.L" and "tail" are marked on one mesh only. */
  focal_model* model = NULL;
  CHECK_REFUSED(focal_model_train(set, NULL, NULL, &model), FOCAL_ERROR_TOO_FEW_SHAPES, "hand.L");
  focal_training_set_destroy(set);
  focal_mesh_destroy(mesh);
  shape_destroy(&body);
}

static void check_one_mesh(void) {
  focal_model* model = NULL;
  focal_training_set* set = shape_training_set(context, 8, 1);
  CHECK_REFUSED(focal_model_train(set, NULL, NULL, &model), FOCAL_ERROR_TOO_FEW_SHAPES, "");
  CHECK_REFUSED(focal_model_train(set, NULL, NULL, NULL), FOCAL_ERROR_INVALID_ARGUMENT, "out_model is NULL");
  CHECK(model == NULL);
  focal_training_set_destroy(set);
}

int main(void) {
  CHECK_OK(focal_context_create(NULL, &context));
  check_names();
  check_name_count();
  check_places();
  check_rigs();
  check_teachers();
  check_marks();
  check_one_mesh();
  focal_context_destroy(context);
  FINISH();
}
