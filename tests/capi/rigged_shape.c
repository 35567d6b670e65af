#include "rigged_shape.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "shapes.h"

enum { JOINTS = SHAPE_MARKS + 1, KEYS = 2, PARTS = 7 };

/* The accessors of the file, in their order. */
enum { POSITION, INDICES, JOINT_NUMBERS, WEIGHTS, INVERSE_BINDS, TIMES, TURNS };

static unsigned char* put(unsigned char* at, const void* data, size_t size) {
  memcpy(at, data, size); /* tests run on little-endian machines */
  return at + size;
}

static unsigned char* put_u32(unsigned char* at, uint32_t value) { return put(at, &value, sizeof value); }

/* A bone starts half-way up its limb; the root is at the origin. */
static void joint_place(const shape* body, int joint, float* place) {
  for (int i = 0; i < 3; ++i) place[i] = joint ? 0.5f * body->positions[3 * body->marks[joint - 1] + i] : 0;
}

/* All to the bone that begins below the vertex, else to the root. */
static int joint_of(const shape* body, const float* p) {
  for (int joint = 1; joint < JOINTS; ++joint) {
    float place[3], along = 0, size = 0, length = 0;
    joint_place(body, joint, place);
    for (int i = 0; i < 3; ++i) along += p[i] * place[i], size += place[i] * place[i], length += p[i] * p[i];
    if (along > size && along * along > 0.8f * size * length) return joint;
  }
  return 0;
}

static unsigned char* put_skin(unsigned char* at, const shape* body) {
  for (uint64_t v = 0; v < body->vertex_count; ++v) {
    const uint8_t joints[4] = {(uint8_t)joint_of(body, body->positions + 3 * v), 0, 0, 0};
    at = put(at, joints, sizeof joints);
  }
  for (uint64_t v = 0; v < body->vertex_count; ++v) {
    const float weights[4] = {1, 0, 0, 0};
    at = put(at, weights, sizeof weights);
  }
  for (int joint = 0; joint < JOINTS; ++joint) {
    float inverse[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, place[3];
    joint_place(body, joint, place);
    for (int i = 0; i < 3; ++i) inverse[12 + i] = -place[i];
    at = put(at, inverse, sizeof inverse);
  }
  return at;
}

static unsigned char* put_animation(unsigned char* at) {
  const float times[KEYS] = {0, 1}, turns[KEYS][4] = {{0, 0, 0, 1}, {0, 0, 0.6f, 0.8f}};
  return put(put(at, times, sizeof times), turns, sizeof turns);
}

static int write_json(char* json, size_t room, const shape* body, const uint32_t* sizes) {
  const uint32_t vertices = (uint32_t)body->vertex_count;
  const struct {
    int component;
    uint32_t count;
    const char* type;
  } accessors[PARTS] = {{5126, vertices, "VEC3\",\"min\":[-9,-9,-9],\"max\":[9,9,9],\"name\":\"positions"},
                        {5125, (uint32_t)body->index_count, "SCALAR"},
                        {5121, vertices, "VEC4"},
                        {5126, vertices, "VEC4"},
                        {5126, JOINTS, "MAT4"},
                        {5126, KEYS, "SCALAR\",\"min\":[0],\"max\":[1],\"name\":\"times"},
                        {5126, KEYS, "VEC4"}};
  uint32_t offset = 0;
  int n =
      snprintf(json, room,
               "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0,1]}],\"meshes\":[{"
               "\"primitives\":[{\"attributes\":{\"POSITION\":0,\"JOINTS_0\":2,\"WEIGHTS_0\":3},\"indices\":"
               "1}]}],\"skins\":[{\"joints\":[1,2,3,4],\"inverseBindMatrices\":4}],\"animations\":[{\"name\":"
               "\"wave\",\"samplers\":[{\"input\":5,\"output\":6}],\"channels\":[{\"sampler\":0,\"target\":{"
               "\"node\":3,\"path\":\"rotation\"}}]}],\"nodes\":[{\"mesh\":0,\"skin\":0},{\"name\":\"root\","
               "\"children\":[2,3,4]}");
  for (int joint = 1; joint < JOINTS; ++joint) {
    float place[3];
    joint_place(body, joint, place);
    n += snprintf(json + n, room - (size_t)n, ",{\"name\":\"bone.%s\",\"translation\":[%.9g,%.9g,%.9g]}",
                  shape_mark_names[joint - 1], place[0], place[1], place[2]);
  }
  n += snprintf(json + n, room - (size_t)n, "],\"bufferViews\":[");
  for (int i = 0; i < PARTS; offset += sizes[i++])
    n += snprintf(json + n, room - (size_t)n, "%s{\"buffer\":0,\"byteOffset\":%u,\"byteLength\":%u}",
                  i ? "," : "", offset, sizes[i]);
  n += snprintf(json + n, room - (size_t)n, "],\"buffers\":[{\"byteLength\":%u}],\"accessors\":[", offset);
  for (int i = 0; i < PARTS; ++i)
    n += snprintf(json + n, room - (size_t)n,
                  "%s{\"bufferView\":%d,\"componentType\":%d,\"count\":%u,\"type\":\"%s\"}", i ? "," : "", i,
                  accessors[i].component, accessors[i].count, accessors[i].type);
  return n + snprintf(json + n, room - (size_t)n, "]}");
}

unsigned char* rigged_glb(int rings, float variation, size_t* size) {
  shape body = shape_create(rings, variation);
  const uint32_t vertices = (uint32_t)body.vertex_count;
  const uint32_t sizes[PARTS] = {[POSITION] = 12 * vertices,
                                 [INDICES] = 4 * (uint32_t)body.index_count,
                                 [JOINT_NUMBERS] = 4 * vertices,
                                 [WEIGHTS] = 16 * vertices,
                                 [INVERSE_BINDS] = 64 * JOINTS,
                                 [TIMES] = 4 * KEYS,
                                 [TURNS] = 16 * KEYS};
  uint32_t bin_bytes = 0;
  for (int i = 0; i < PARTS; ++i) bin_bytes += sizes[i];
  char json[4096];
  int json_bytes = write_json(json, sizeof json, &body, sizes);
  while (json_bytes % 4) json[json_bytes++] = ' ';
  *size = 12 + 8 + (size_t)json_bytes + 8 + bin_bytes;
  unsigned char* const glb = malloc(*size);
  if (!glb) exit(2);
  unsigned char* at = put_u32(put_u32(put_u32(glb, 0x46546C67), 2), (uint32_t)*size);
  at = put(put_u32(put_u32(at, (uint32_t)json_bytes), 0x4E4F534A), json, (size_t)json_bytes);
  at = put(put_u32(put_u32(at, bin_bytes), 0x004E4942), body.positions, sizes[POSITION]);
  at = put_skin(put(at, body.indices, sizes[INDICES]), &body);
  put_animation(at);
  shape_destroy(&body);
  return glb;
}
