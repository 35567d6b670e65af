/* What of a scene is not the character: reported, left out of the analysis, and kept where that is asked for. */
#include <stdlib.h>

#include "check.h"
#include "shapes.h"

enum { GROUND_VERTICES = 4, GROUND_TRIANGLES = 2 };

static focal_context* context;

/* The body with a quadrilateral below it, far beyond its limbs. */
static shape scene_create(void) {
  static const float corners[3 * GROUND_VERTICES] = {-20, -9, -20, 20, -9, -20, -20, -9, 20, 20, -9, 20};
  static const uint32_t triangles[3 * GROUND_TRIANGLES] = {0, 2, 1, 1, 2, 3};
  shape scene = shape_create(12, 0);
  const size_t vertices = (size_t)scene.vertex_count, indices = (size_t)scene.index_count;
  scene.positions = realloc(scene.positions, 12 * vertices + sizeof corners);
  scene.indices = realloc(scene.indices, 4 * indices + sizeof triangles);
  if (!scene.positions || !scene.indices) abort();
  memcpy(scene.positions + 3 * vertices, corners, sizeof corners);
  for (size_t i = 0; i < 3 * GROUND_TRIANGLES; ++i)
    scene.indices[indices + i] = (uint32_t)vertices + triangles[i];
  scene.vertex_count += GROUND_VERTICES, scene.index_count += 3 * GROUND_TRIANGLES;
  return scene;
}

static focal_mesh* mesh_of(const shape* scene, int keep, focal_mesh_info* info) {
  focal_mesh_params params;
  focal_mesh* mesh = NULL;
  const focal_mesh_desc desc = shape_desc(scene);
  CHECK_OK(focal_mesh_params_init(&params, sizeof params));
  CHECK(params.keep_scenery == 0);
  params.keep_scenery = keep;
  CHECK_OK(focal_mesh_create(context, &desc, &params, &mesh));
  CHECK_OK(focal_mesh_info_init(info, sizeof *info));
  CHECK_OK(focal_mesh_get_info(mesh, info));
  return mesh;
}

static void check_left_out(const shape* scene) {
  focal_mesh_info info;
  focal_left_out ground;
  focal_surface_point point;
  focal_mesh* mesh = mesh_of(scene, 0, &info);
  CHECK(info.vertex_count == scene->vertex_count && 3 * info.triangle_count == scene->index_count);
  CHECK(info.surface_vertex_count == scene->vertex_count - GROUND_VERTICES);
  CHECK(info.component_count == 1 && info.degenerate_triangles == 0);
  CHECK(info.left_out_count == 1 && info.left_out_triangles == GROUND_TRIANGLES);
  CHECK(info.warning_count == 1 && strstr(focal_mesh_warning(mesh, 0), "a flat sheet") != NULL);
  CHECK_OK(focal_left_out_init(&ground, sizeof ground));
  CHECK_OK(focal_mesh_get_left_out(mesh, 0, &ground));
  CHECK(ground.reason == FOCAL_SCENERY_SHEET && ground.triangle_count == GROUND_TRIANGLES);
  CHECK(ground.is_whole_node == 0 && strcmp(ground.name, "the mesh") == 0);
  CHECK_REFUSED(focal_mesh_get_left_out(mesh, 1, &ground), FOCAL_ERROR_INVALID_ARGUMENT, "left out");
  CHECK_REFUSED(focal_mesh_get_left_out(mesh, 0, NULL), FOCAL_ERROR_INVALID_ARGUMENT, "NULL");
  CHECK_REFUSED(focal_mesh_get_left_out(NULL, 0, &ground), FOCAL_ERROR_INVALID_HANDLE, "");
  CHECK_REFUSED(focal_mesh_point_at_vertex(mesh, (uint32_t)scene->vertex_count - 1, &point),
                FOCAL_ERROR_INVALID_LANDMARK, "no triangle uses");
  focal_mesh_destroy(mesh);
}

static void check_kept(const shape* scene) {
  focal_mesh_info info;
  focal_mesh* mesh = mesh_of(scene, 1, &info);
  CHECK(info.surface_vertex_count == scene->vertex_count && info.component_count == 2);
  CHECK(info.left_out_count == 0 && info.left_out_triangles == 0);
  focal_mesh_destroy(mesh);
}

int main(void) {
  CHECK_OK(focal_context_create(NULL, &context));
  shape scene = scene_create();
  check_left_out(&scene);
  check_kept(&scene);
  shape_destroy(&scene);
  focal_context_destroy(context);
  FINISH();
}
