/* Prints everything in a detection: places, confidences, the second-best place, warnings, and the time of each
 * stage; writes the mesh's file with the landmarks in it.
 * usage: detect MODEL MESH.glb OUT.glb */
#include <focal/focal.h>
#include <stdio.h>

static int failed(void) {
  fprintf(stderr, "%s\n", focal_last_error());
  return 1;
}

static void print_landmark(const focal_landmark* landmark) {
  static const char* const names[] = {"found", "uncertain", "absent"};
  printf("%-20s %-9s confidence %.2f, expected error %.3g", landmark->name, names[landmark->status],
         landmark->confidence, landmark->expected_error);
  if (landmark->point.triangle != FOCAL_NO_TRIANGLE)
    printf(", triangle %u, vertex %u", (unsigned)landmark->point.triangle, (unsigned)landmark->vertex);
  if (landmark->has_runner_up)
    printf("; or vertex %u with %.2f", (unsigned)landmark->runner_up_vertex, landmark->runner_up_confidence);
  printf("\n");
}

static int print_detection(const focal_detection* detection) {
  focal_landmark landmark;
  focal_detection_info info;
  focal_stage_seconds seconds;
  uint32_t i;
  focal_landmark_init(&landmark, sizeof landmark);
  focal_detection_info_init(&info, sizeof info);
  focal_stage_seconds_init(&seconds, sizeof seconds);
  if (focal_detection_get_info(detection, &info)) return failed();
  if (focal_detection_get_seconds(detection, &seconds)) return failed();
  for (i = 0; i < info.warning_count; ++i) printf("warning: %s\n", focal_detection_warning(detection, i));
  for (i = 0; i < info.landmark_count; ++i) {
    if (focal_detection_get_landmark(detection, i, &landmark)) return failed();
    print_landmark(&landmark);
  }
  printf("%lu vertices, of the model's category: %.2f; %.3f s, of them spectrum %.3f, geodesics %.3f\n",
         (unsigned long)info.vertex_count, info.category_fit, seconds.total, seconds.spectrum,
         seconds.geodesics);
  return 0;
}

int main(int argc, char** argv) {
  focal_context* context = NULL;
  focal_model* model = NULL;
  focal_mesh* mesh = NULL;
  focal_detection* detection = NULL;
  focal_detect_params params;
  if (argc != 4) return fprintf(stderr, "usage: detect MODEL MESH.glb OUT.glb\n"), 2;
  if (focal_context_create(NULL, &context)) return failed();
  if (focal_model_load(context, argv[1], &model)) return failed();
  if (focal_mesh_load_gltf(context, argv[2], NULL, &mesh)) return failed();

  focal_detect_params_init(&params, sizeof params);
  params.quality = FOCAL_QUALITY_BEST;
  params.keep_votes = 0; /* saves a float for each landmark and vertex */
  if (focal_model_detect(model, mesh, &params, NULL, &detection)) return failed();
  if (print_detection(detection)) return 1;
  if (focal_detection_write_gltf(detection, argv[3])) return failed();

  focal_detection_destroy(detection);
  focal_mesh_destroy(mesh);
  focal_model_destroy(model);
  focal_context_destroy(context);
  return 0;
}
