/* Rigs through the C ABI: what is misused has its own status, message and hint. (What comes out is tested by samples/rig.) */
#include "check.h"
#include "shapes.h"

int main(void) {
  focal_context* context = NULL;
  focal_training_set* rigs = NULL;
  focal_training_set* marks = NULL;
  focal_mesh* mesh = NULL;
  focal_skeleton* skeleton = NULL;
  focal_skeleton_params params;
  focal_skeleton_info info;
  focal_joint joint;
  const char* names[] = {"nose"};
  uint32_t vertex = 0;
  CHECK_OK(focal_context_create(NULL, &context));
  CHECK_OK(focal_training_set_create(context, NULL, 0, &rigs));
  CHECK_OK(focal_training_set_create(context, names, 1, &marks));
  mesh = shape_mesh(context, 8, 0);

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
  CHECK_OK(focal_context_destroy(context));
  FINISH();
}
