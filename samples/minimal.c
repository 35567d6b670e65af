/* The shortest use of focal: a model, a mesh, its landmarks.
 * usage: minimal MODEL MESH.glb */
#include <focal/focal.h>
#include <stdio.h>

static int failed(void) {
  fprintf(stderr, "%s\n", focal_last_error());
  return 1;
}

int main(int argc, char** argv) {
  focal_context* context = NULL;
  focal_model* model = NULL;
  focal_mesh* mesh = NULL;
  focal_detection* detection = NULL;
  focal_landmark landmark;
  uint32_t i;
  if (argc != 3) return fprintf(stderr, "usage: minimal MODEL MESH.glb\n"), 2;
  if (focal_context_create(NULL, &context)) return failed();
  if (focal_model_load(context, argv[1], &model)) return failed();
  if (focal_mesh_load_gltf(context, argv[2], NULL, &mesh)) return failed();
  if (focal_model_detect(model, mesh, NULL, NULL, &detection)) return failed();

  focal_landmark_init(&landmark, sizeof landmark);
  for (i = 0; i < focal_detection_landmark_count(detection); ++i) {
    if (focal_detection_get_landmark(detection, i, &landmark)) return failed();
    if (landmark.status == FOCAL_LANDMARK_ABSENT) continue;
    printf("%s %g %g %g\n", landmark.name, (double)landmark.position[0], (double)landmark.position[1],
           (double)landmark.position[2]);
  }

  focal_detection_destroy(detection);
  focal_mesh_destroy(mesh);
  focal_model_destroy(model);
  focal_context_destroy(context);
  return 0;
}
