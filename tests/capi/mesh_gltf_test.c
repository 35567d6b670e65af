/* Meshes from glTF files and from their bytes, also posed, and every way these can be wrong. */
#include <math.h>
#include <stdlib.h>

#include "check.h"
#include "rigged_shape.h"
#include "shapes.h"

static focal_context* context;

static focal_status load_memory(const void* data, size_t size) {
  focal_mesh* mesh = NULL;
  const focal_status status = focal_mesh_load_gltf_memory(context, data, size, NULL, &mesh);
  CHECK((status == FOCAL_OK) == (mesh != NULL));
  focal_mesh_destroy(mesh);
  return status;
}

static void check_gltf(shape* body) {
  size_t size = 0;
  unsigned char* glb = shape_glb(body, &size);
  focal_mesh* mesh = NULL;
  CHECK_OK(load_memory(glb, size));
  CHECK_REFUSED(load_memory(glb, size / 2), FOCAL_ERROR_INVALID_FILE, "");
  CHECK_REFUSED(load_memory(glb, 11), FOCAL_ERROR_INVALID_FILE, "");
  CHECK_REFUSED(load_memory("", 0), FOCAL_ERROR_INVALID_FILE, "");
  CHECK_REFUSED(load_memory("not a glTF file at all", 22), FOCAL_ERROR_INVALID_FILE, "");
  CHECK_REFUSED(load_memory(NULL, 10), FOCAL_ERROR_INVALID_ARGUMENT, "data is NULL");
  CHECK_REFUSED(focal_mesh_load_gltf(context, "no/such/file.glb", NULL, &mesh), FOCAL_ERROR_FILE_NOT_FOUND,
                "no/such/file.glb");
  CHECK_REFUSED(focal_mesh_load_gltf(context, "", NULL, &mesh), FOCAL_ERROR_INVALID_ARGUMENT,
                "path is empty");
  CHECK_REFUSED(focal_mesh_load_gltf(context, NULL, NULL, &mesh), FOCAL_ERROR_INVALID_ARGUMENT,
                "path is NULL");
  CHECK_REFUSED(focal_mesh_load_gltf(context, "x.glb", NULL, NULL), FOCAL_ERROR_INVALID_ARGUMENT,
                "out_mesh is NULL");
  FILE* file = fopen("truncated.glb", "wb");
  CHECK(file && fwrite(glb, 1, size - 100, file) == size - 100 && fclose(file) == 0);
  CHECK_REFUSED(focal_mesh_load_gltf(context, "truncated.glb", NULL, &mesh), FOCAL_ERROR_INVALID_FILE,
                "truncated.glb");
  CHECK(mesh == NULL);
  focal_mesh_params params;
  CHECK_OK(focal_mesh_params_init(&params, sizeof params));
  params.max_vertices = 10;
  CHECK_REFUSED(focal_mesh_load_gltf_memory(context, glb, size, &params, &mesh), FOCAL_ERROR_UNSUPPORTED, "");
  params.max_vertices = 0;
  CHECK_REFUSED(focal_mesh_load_gltf_memory(context, glb, size, &params, &mesh), FOCAL_ERROR_INVALID_ARGUMENT,
                "max_vertices is 0");
  free(glb);
  body->positions[7] = NAN;
  glb = shape_glb(body, &size);
  CHECK_REFUSED(load_memory(glb, size), FOCAL_ERROR_INVALID_MESH, "");
  free(glb);
}

/* A character as it stands at a time of its animation; and what has no such animation. */
static void check_pose(void) {
  size_t size = 0, bare_size = 0;
  unsigned char* glb = rigged_glb(8, 0, &size);
  shape body = shape_create(8, 0);
  unsigned char* bare = shape_glb(&body, &bare_size);
  focal_mesh_params params;
  focal_mesh *mesh = NULL, *posed = NULL;
  CHECK_OK(focal_mesh_params_init(&params, sizeof params));
  params.keep_source_file = 0;
  CHECK_OK(focal_mesh_load_gltf_memory(context, glb, size, &params, &mesh));
  params.pose_animation = "wave", params.pose_time = 1;
  CHECK_OK(focal_mesh_load_gltf_memory(context, glb, size, &params, &posed));
  int moved = 0, still = 0;
  for (uint64_t v = 0; posed && v < body.vertex_count; ++v) {
    const float *before = focal_mesh_positions(mesh) + 3 * v, *after = focal_mesh_positions(posed) + 3 * v;
    if (memcmp(before, after, 12) == 0)
      ++still;
    else
      ++moved;
    CHECK(fabsf(after[2] - before[2]) < 1e-5f); /* it turns about z */
  }
  CHECK(moved > 3 && still > 3);
  focal_mesh_destroy(posed), posed = NULL;
  params.pose_animation = "walk";
  CHECK_REFUSED(focal_mesh_load_gltf_memory(context, glb, size, &params, &posed),
                FOCAL_ERROR_INVALID_ARGUMENT, "no animation 'walk'");
  CHECK(strstr(focal_last_error(), "it has: 'wave'") != NULL);
  CHECK_REFUSED(focal_mesh_load_gltf_memory(context, bare, bare_size, &params, &posed),
                FOCAL_ERROR_INVALID_ARGUMENT, "no animation 'walk'");
  CHECK(strstr(focal_last_error(), "it has no skin") != NULL);
  for (size_t i = 0; i + 13 < size; ++i) /* its animations under another name: none */
    if (memcmp(glb + i, "\"animations\"", 12) == 0) glb[i + 1] = 'x';
  CHECK_REFUSED(focal_mesh_load_gltf_memory(context, glb, size, &params, &posed),
                FOCAL_ERROR_INVALID_ARGUMENT, "no animation 'walk'");
  CHECK(strstr(focal_last_error(), "it has no animations") != NULL);
  CHECK(posed == NULL);
  focal_mesh_destroy(mesh);
  free(glb), free(bare);
  shape_destroy(&body);
}

/* A file on disk, with its neighbours allowed or not, kept or not, and misuse that is not the file's. */
static void check_path(shape* body) {
  size_t size = 0;
  unsigned char* glb = shape_glb(body, &size);
  FILE* file = fopen("mesh_test.glb", "wb");
  CHECK(file && fwrite(glb, 1, size, file) == size && fclose(file) == 0);
  focal_mesh_params params;
  focal_mesh* mesh = NULL;
  focal_mesh_info info;
  CHECK_OK(focal_mesh_info_init(&info, sizeof info));
  CHECK_OK(focal_mesh_params_init(&params, sizeof params));
  for (int kept = 0; kept < 2; ++kept)
    for (int external = 0; external < 2; ++external) {
      params.keep_source_file = kept, params.allow_external_files = external;
      CHECK_OK(focal_mesh_load_gltf(context, "mesh_test.glb", &params, &mesh));
      CHECK_OK(focal_mesh_get_info(mesh, &info));
      CHECK(info.vertex_count == body->vertex_count);
      focal_mesh_destroy(mesh), mesh = NULL;
    }
  params.weld = 7;
  CHECK_REFUSED(focal_mesh_load_gltf(context, "mesh_test.glb", &params, &mesh), FOCAL_ERROR_INVALID_ARGUMENT,
                "weld is 7");
  CHECK(strstr(focal_last_error(), "mesh_test.glb") == NULL); /* the file is not to blame */
  CHECK_REFUSED(focal_mesh_load_gltf(NULL, "mesh_test.glb", NULL, &mesh), FOCAL_ERROR_INVALID_HANDLE,
                "focal_context is NULL");
  CHECK(strstr(focal_last_error(), "mesh_test.glb") == NULL);
  remove("mesh_test.glb");
  free(glb);
}

int main(void) {
  shape body = shape_create(8, 0);
  CHECK_OK(focal_context_create(NULL, &context));
  check_pose();
  check_path(&body);
  check_gltf(&body);
  shape_destroy(&body);
  focal_context_destroy(context);
  FINISH();
}
