/* A model of rigged characters within a second or two, by few trees on few shapes: what is written for it is judged here, not
 * how well it finds joints.
 * usage: focal_quick_model OUT.focal CHARACTER.glb [CHARACTER.glb ...] */
#include <focal/focal.h>
#include <stdio.h>

static int failed(void) {
  fprintf(stderr, "%s\n", focal_last_error());
  return 1;
}

int main(int argc, char** argv) {
  focal_context* context = NULL;
  focal_training_set* set = NULL;
  focal_model* model = NULL;
  focal_train_params params;
  if (argc < 3) return fprintf(stderr, "usage: focal_quick_model OUT.focal CHARACTER.glb ...\n"), 2;
  if (focal_context_create(NULL, &context)) return failed();
  if (focal_training_set_create(context, NULL, 0, &set)) return failed();
  for (int i = 2; i < argc; ++i) {
    focal_mesh* character = NULL;
    if (focal_mesh_load_gltf(context, argv[i], NULL, &character)) return failed();
    if (focal_training_set_add_rig(set, character)) return failed();
    focal_mesh_destroy(character);
  }
  focal_train_params_init(&params, sizeof params);
  params.eigenpair_count = 40;
  params.proxy_vertices = 500;
  params.tree_count = 3;
  params.rigged_shapes = argc; /* fewest: at least half as many again as there are characters */
  params.learn_confidence = 0;
  if (focal_model_train(set, &params, NULL, &model)) return failed();
  if (focal_model_save(model, argv[1])) return failed();
  focal_model_destroy(model);
  focal_training_set_destroy(set);
  focal_context_destroy(context);
  return 0;
}
