#include "shapes.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char* const shape_mark_names[SHAPE_MARKS] = {"nose", "hand.L", "tail"};

static const float limb_directions[SHAPE_MARKS][3] = {{0, 0, 1}, {0.8f, 0.6f, 0}, {0, -0.6f, -0.8f}};

static float dot(const float* a, const float* b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/* Pushes a point of the unit sphere out along the limbs. */
static void push_out(float* p, float variation) {
  const float lengths[SHAPE_MARKS] = {0.6f, 1.0f + variation, 1.5f - variation};
  float radius = 1;
  for (int limb = 0; limb < SHAPE_MARKS; ++limb)
    radius += lengths[limb] * expf(-12 * (1 - dot(p, limb_directions[limb])));
  for (int i = 0; i < 3; ++i) p[i] *= radius;
}

static void fill_positions(shape* shape, int rings, float variation) {
  const int around = 2 * rings;
  const double pi = 3.14159265358979;
  for (uint64_t v = 0; v < shape->vertex_count; ++v) {
    float* p = shape->positions + 3 * v;
    if (v < 2) {
      p[0] = p[1] = 0, p[2] = v ? -1.0f : 1.0f;
    } else {
      const double polar = pi * (double)((int)(v - 2) / around + 1) / (rings + 1);
      const double turn = 2 * pi * ((int)(v - 2) % around) / around;
      p[0] = (float)(sin(polar) * cos(turn)), p[1] = (float)(sin(polar) * sin(turn)),
      p[2] = (float)cos(polar);
    }
    push_out(p, variation);
  }
}

static void fill_triangles(shape* shape, int rings) {
  const uint32_t around = 2 * (uint32_t)rings;
  uint32_t* next = shape->indices;
  for (uint32_t ring = 0; ring <= (uint32_t)rings; ++ring)
    for (uint32_t j = 0; j < around; ++j) {
      const uint32_t k = (j + 1) % around, below = 2 + ring * around, above = below - around;
      if (ring == 0) {
        *next++ = 0, *next++ = below + j, *next++ = below + k;
      } else if (ring == (uint32_t)rings) {
        *next++ = above + j, *next++ = 1, *next++ = above + k;
      } else {
        *next++ = above + j, *next++ = below + j, *next++ = below + k;
        *next++ = above + j, *next++ = below + k, *next++ = above + k;
      }
    }
}

shape shape_create(int rings, float variation) {
  shape result;
  const uint64_t around = 2 * (uint64_t)rings;
  result.vertex_count = around * (uint64_t)rings + 2;
  result.index_count = 6 * around * (uint64_t)rings;
  result.positions = malloc(result.vertex_count * 3 * sizeof(float));
  result.indices = malloc(result.index_count * sizeof(uint32_t));
  if (!result.positions || !result.indices) exit(2);
  fill_positions(&result, rings, variation);
  fill_triangles(&result, rings);
  for (int limb = 0; limb < SHAPE_MARKS; ++limb) {
    uint32_t best = 0;
    for (uint32_t v = 1; v < result.vertex_count; ++v)
      if (dot(result.positions + 3 * v, limb_directions[limb]) >
          dot(result.positions + 3 * best, limb_directions[limb]))
        best = v;
    result.marks[limb] = best;
  }
  return result;
}

void shape_destroy(shape* shape) {
  free(shape->positions);
  free(shape->indices);
}

static unsigned char* put_u32(unsigned char* at, uint32_t value) {
  for (int i = 0; i < 4; ++i) *at++ = (unsigned char)(value >> (8 * i));
  return at;
}

unsigned char* shape_glb(const shape* shape, size_t* size) {
  const uint32_t position_bytes = (uint32_t)(shape->vertex_count * 12);
  const uint32_t index_bytes = (uint32_t)(shape->index_count * 4), bin_bytes = position_bytes + index_bytes;
  char json[1024];
  int json_bytes = snprintf(
      json, sizeof json,
      "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],"
      "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1}]}],"
      "\"buffers\":[{\"byteLength\":%u}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":%u},"
      "{\"buffer\":0,\"byteOffset\":%u,\"byteLength\":%u}],\"accessors\":[{\"bufferView\":0,"
      "\"componentType\":5126,\"count\":%u,\"type\":\"VEC3\",\"min\":[-9,-9,-9],\"max\":[9,9,9]},{"
      "\"bufferView\":1,"
      "\"componentType\":5125,\"count\":%u,\"type\":\"SCALAR\"}]}",
      bin_bytes, position_bytes, position_bytes, index_bytes, (uint32_t)shape->vertex_count,
      (uint32_t)shape->index_count);
  while (json_bytes % 4) json[json_bytes++] = ' ';
  *size = 12 + 8 + (size_t)json_bytes + 8 + bin_bytes;
  unsigned char* glb = malloc(*size);
  if (!glb) exit(2);
  unsigned char* at = put_u32(put_u32(put_u32(glb, 0x46546C67), 2), (uint32_t)*size);
  at = put_u32(put_u32(at, (uint32_t)json_bytes), 0x4E4F534A);
  memcpy(at, json, (size_t)json_bytes);
  at = put_u32(put_u32(at + json_bytes, bin_bytes), 0x004E4942);
  memcpy(at, shape->positions, position_bytes); /* tests run on little-endian machines */
  memcpy(at + position_bytes, shape->indices, index_bytes);
  return glb;
}
