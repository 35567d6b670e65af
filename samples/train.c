/* Learns a model from marked meshes. A MARKS file has one line a landmark, "NAME VERTEX"; the first file says
 * which landmarks there are and in which order; a name that a later file lacks is absent on its mesh.
 * usage: train MODEL MESH.glb MARKS [MESH.glb MARKS]... */
#include <focal/focal.h>
#include <stdio.h>
#include <string.h>

enum { MOST_MARKS = 256, NAME_SIZE = 64 };

typedef struct marks {
  char names[MOST_MARKS][NAME_SIZE];
  uint32_t vertices[MOST_MARKS];
  size_t count;
} marks;

static int failed(void) {
  fprintf(stderr, "%s\n", focal_last_error());
  return 1;
}

static int read_marks(const char* path, marks* out) {
  FILE* file = fopen(path, "r");
  unsigned vertex;
  if (!file) return fprintf(stderr, "cannot open %s\n", path), 0;
  out->count = 0;
  while (out->count < MOST_MARKS && fscanf(file, "%63s %u", out->names[out->count], &vertex) == 2)
    out->vertices[out->count++] = vertex;
  fclose(file);
  return 1;
}

/* The vertices of `from` in the order of `order`. */
static void arrange(const marks* order, const marks* from, uint32_t* vertices) {
  size_t i, j;
  for (i = 0; i < order->count; ++i) {
    vertices[i] = FOCAL_NO_VERTEX;
    for (j = 0; j < from->count; ++j)
      if (strcmp(order->names[i], from->names[j]) == 0) vertices[i] = from->vertices[j];
  }
}

int main(int argc, char** argv) {
  static marks order, here;
  const char* names[MOST_MARKS];
  uint32_t vertices[MOST_MARKS];
  focal_context* context = NULL;
  focal_training_set* set = NULL;
  focal_model* model = NULL;
  focal_model_info info;
  size_t i;
  int a;
  if (argc < 4 || argc % 2)
    return fprintf(stderr, "usage: train MODEL MESH.glb MARKS [MESH.glb MARKS]...\n"), 2;
  if (!read_marks(argv[3], &order)) return 1;
  for (i = 0; i < order.count; ++i) names[i] = order.names[i];
  if (focal_context_create(NULL, &context)) return failed();
  if (focal_training_set_create(context, names, order.count, &set)) return failed();

  for (a = 2; a < argc; a += 2) {
    focal_mesh* mesh = NULL;
    if (!read_marks(argv[a + 1], &here)) return 1;
    arrange(&order, &here, vertices);
    if (focal_mesh_load_gltf(context, argv[a], NULL, &mesh)) return failed();
    if (focal_training_set_add_vertices(set, mesh, vertices, order.count)) return failed();
    focal_mesh_destroy(mesh); /* the set keeps what it needs */
  }
  if (focal_model_train(set, NULL, NULL, &model)) return failed();
  if (focal_model_save(model, argv[1])) return failed();

  focal_model_info_init(&info, sizeof info);
  if (focal_model_get_info(model, &info)) return failed();
  printf("%s: %u landmarks learned on %u meshes, %.1f MB\n", argv[1], (unsigned)info.landmark_count,
         (unsigned)info.shape_count, (double)info.file_bytes / 1e6);
  focal_model_destroy(model);
  focal_training_set_destroy(set);
  focal_context_destroy(context);
  return 0;
}
