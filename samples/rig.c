/* Learns the skeleton and skin weights of one or more rigged characters and puts them on a mesh that has none: its own file
 * comes out with joints, weights and a rest pose in which it stands.
 * usage: rig MESH.glb OUT.glb CHARACTER.glb [CHARACTER.glb ...] */
#include <focal/focal.h>
#include <stdio.h>

static int failed(void) {
  fprintf(stderr, "%s\n", focal_last_error());
  return 1;
}

static int learn(const focal_context* context, char** characters, int count, focal_model** model) {
  focal_training_set* set = NULL;
  focal_train_params params;
  int i;
  /* No landmark names: landmarks follow from the skeletons. */
  if (focal_training_set_create(context, NULL, 0, &set)) return failed();
  for (i = 0; i < count; ++i) {
    focal_mesh* character = NULL;
    if (focal_mesh_load_gltf(context, characters[i], NULL, &character)) return failed();
    if (focal_training_set_add_rig(set, character)) return failed();
    focal_mesh_destroy(character);
  }
  focal_train_params_init(&params, sizeof params);
  params.proxy_vertices = 1500; /* a quick model; the default is more accurate */
  params.tree_count = 10;
  params.rigged_shapes = 8;
  params.learn_confidence = 0;
  if (focal_model_train(set, &params, NULL, model)) return failed();
  focal_training_set_destroy(set);
  return 0;
}

static int print_skeleton(const focal_skeleton* skeleton) {
  focal_skeleton_info info;
  focal_joint joint;
  uint32_t i;
  focal_skeleton_info_init(&info, sizeof info);
  focal_joint_init(&joint, sizeof joint);
  if (focal_skeleton_get_info(skeleton, &info)) return failed();
  for (i = 0; i < info.joint_count; ++i) {
    if (focal_skeleton_get_joint(skeleton, i, &joint)) return failed();
    printf("%-24s below %3d  at %.3f %.3f %.3f  confidence %.2f\n", joint.name, (int)joint.parent,
           joint.position[0], joint.position[1], joint.position[2], joint.confidence);
  }
  for (i = 0; i < info.warning_count; ++i) printf("warning: %s\n", focal_skeleton_warning(skeleton, i));
  return 0;
}

int main(int argc, char** argv) {
  focal_context* context = NULL;
  focal_model* model = NULL;
  focal_mesh* mesh = NULL;
  focal_detection* detection = NULL;
  focal_skeleton* skeleton = NULL;
  focal_skeleton_params params;
  if (argc < 4) return fprintf(stderr, "usage: rig MESH.glb OUT.glb CHARACTER.glb ...\n"), 2;
  if (focal_context_create(NULL, &context)) return failed();
  if (learn(context, argv + 3, argc - 3, &model)) return 1;
  if (focal_mesh_load_gltf(context, argv[1], NULL, &mesh)) return failed();
  if (focal_model_detect(model, mesh, NULL, NULL, &detection)) return failed();

  focal_skeleton_params_init(&params, sizeof params);
  params.names = FOCAL_BONE_NAMES_MIXAMO; /* leftUpperArm becomes mixamorig:LeftArm */
  if (focal_skeleton_create(detection, &params, NULL, &skeleton)) return failed();
  if (print_skeleton(skeleton)) return 1;
  if (focal_skeleton_write_gltf(skeleton, argv[2])) return failed();

  focal_skeleton_destroy(skeleton);
  focal_detection_destroy(detection);
  focal_mesh_destroy(mesh);
  focal_model_destroy(model);
  focal_context_destroy(context);
  return 0;
}
