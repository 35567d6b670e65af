/* A character: the test body of shapes.h with a bone in each limb, skin weights and an animation, as a .glb. */
#ifndef FOCAL_TEST_RIGGED_SHAPE_H
#define FOCAL_TEST_RIGGED_SHAPE_H

#include <stddef.h>

/* In fresh memory; *size gets its length. */
unsigned char* rigged_glb(int rings, float variation, size_t* size);

#endif
