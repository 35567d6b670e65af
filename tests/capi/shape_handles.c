#include <stdio.h>
#include <stdlib.h>

#include "shapes.h"

focal_mesh_desc shape_desc(const shape* shape) {
  focal_mesh_desc desc;
  focal_mesh_desc_init(&desc, sizeof desc);
  desc.positions = shape->positions;
  desc.vertex_count = shape->vertex_count;
  desc.indices = shape->indices;
  desc.index_count = shape->index_count;
  return desc;
}

static void insist(focal_status status) {
  if (status == FOCAL_OK) return;
  fprintf(stderr, "%s: %s\n", focal_status_name(status), focal_last_error());
  exit(2);
}

focal_mesh* shape_mesh(const focal_context* context, int rings, float variation) {
  shape body = shape_create(rings, variation);
  const focal_mesh_desc desc = shape_desc(&body);
  focal_mesh* mesh = NULL;
  insist(focal_mesh_create(context, &desc, NULL, &mesh));
  shape_destroy(&body);
  return mesh;
}

focal_training_set* shape_training_set(const focal_context* context, int rings, int count) {
  focal_training_set* set = NULL;
  insist(focal_training_set_create(context, shape_mark_names, SHAPE_MARKS, &set));
  for (int i = 0; i < count; ++i) {
    const float variation = 0.05f * (float)i;
    shape body = shape_create(rings, variation);
    focal_mesh* mesh = shape_mesh(context, rings, variation);
    insist(focal_training_set_add_vertices(set, mesh, body.marks, SHAPE_MARKS));
    focal_mesh_destroy(mesh);
    shape_destroy(&body);
  }
  return set;
}

focal_model* shape_model(const focal_training_set* set) {
  focal_model* model = NULL;
  focal_train_params params;
  insist(focal_train_params_init(&params, sizeof params));
  params.eigenpair_count = 40, params.tree_count = 4, params.learn_confidence = 0;
  params.max_samples_per_shape = 150, params.proxy_vertices = 150, params.rigged_shapes = 2;
  insist(focal_model_train(set, &params, NULL, &model));
  return model;
}
