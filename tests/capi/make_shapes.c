/* Writes marked shapes for the samples to run on: FOLDER/shape_0.glb and shape_0.txt ("NAME VERTEX" lines).
 * usage: make_shapes FOLDER COUNT RINGS */
#include <stdio.h>
#include <stdlib.h>

#include "shapes.h"

static int write_shape(const char* folder, int number, int rings) {
  char path[1024];
  size_t size = 0;
  shape body = shape_create(rings, 0.04f * (float)number);
  unsigned char* glb = shape_glb(&body, &size);
  snprintf(path, sizeof path, "%s/shape_%d.glb", folder, number);
  FILE* file = fopen(path, "wb");
  int good = file && fwrite(glb, 1, size, file) == size;
  good = file && fclose(file) == 0 && good;
  snprintf(path, sizeof path, "%s/shape_%d.txt", folder, number);
  file = fopen(path, "w");
  for (int i = 0; file && i < SHAPE_MARKS; ++i) fprintf(file, "%s %u\n", shape_mark_names[i], body.marks[i]);
  good = file && fclose(file) == 0 && good;
  free(glb);
  shape_destroy(&body);
  return good;
}

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  for (int i = 0; i < atoi(argv[2]); ++i)
    if (!write_shape(argv[1], i, atoi(argv[3]))) return 1;
  return 0;
}
