/* Small closed bodies with marks, and glTF files of them, made without any library. */
#ifndef FOCAL_TEST_SHAPES_H
#define FOCAL_TEST_SHAPES_H

#include <focal/focal.h>

enum { SHAPE_MARKS = 3 };

typedef struct shape {
  float* positions;
  uint32_t* indices;
  uint64_t vertex_count, index_count;
  uint32_t marks[SHAPE_MARKS]; /* vertices at the ends of the limbs */
} shape;

extern const char* const shape_mark_names[SHAPE_MARKS];

/* A ball with three limbs of different lengths; variation changes lengths a little. rings >= 6. */
shape shape_create(int rings, float variation);
void shape_destroy(shape* shape);
focal_mesh_desc shape_desc(const shape* shape);

/* A mesh, and a set of `count` marked ones. Both end the test program on failure. */
focal_mesh* shape_mesh(const focal_context* context, int rings, float variation);
focal_training_set* shape_training_set(const focal_context* context, int rings, int count);

/* A model of such a set, or of rigged characters, by few trees: learned in a moment. */
focal_model* shape_model(const focal_training_set* set);

/* A .glb of the shape in fresh memory; *size gets its length. */
unsigned char* shape_glb(const shape* shape, size_t* size);

#endif
