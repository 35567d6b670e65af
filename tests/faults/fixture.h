/* One of each thing, tiny, and calls over all of the C interface that a fault may hit at any place. */
#ifndef FOCAL_TEST_FIXTURE_H
#define FOCAL_TEST_FIXTURE_H

#include <focal/focal.h>
#include <stddef.h>

#include "shapes.h"

typedef struct fixture {
  char folder[256]; /* for files; its own */
  focal_context* context;
  shape body;
  focal_mesh *mesh, *other, *rigged; /* rigged: from a .glb with a skin and an animation */
  focal_training_set *set, *rigs;
  focal_model *model, *paper, *rig_model;
  focal_analysis *analysis, *other_analysis, *rig_analysis;
  focal_detection *detection, *other_detection, *rig_detection;
  unsigned char *glb, *rigged_glb;
  size_t glb_size, rigged_size;
} fixture;

/* rings: 7 for meshes of 100 vertices; their number grows with its square. */
void fixture_create(fixture* f, int rings, const focal_context_params* params);
void fixture_destroy(fixture* f);

/* A test's own work inside a call that is watched; both may be NULL. */
extern void (*fixture_pause)(void);
extern void (*fixture_resume)(void);

/* Makes its call or calls, adds what they give to the digest, destroys it. Returns the first status that is not
 * FOCAL_OK. */
typedef struct scenario {
  const char* name;
  focal_status (*run)(const fixture* f, uint64_t* digest);
} scenario;

extern const scenario scenarios[];
extern const size_t scenario_count;
const scenario* scenario_named(const char* name);
int scenario_chosen(const scenario* what, int count, char** names); /* count 0: all are */
/* The digest; ends the program when a call fails. */
uint64_t scenario_run_well(const scenario* what, const fixture* f);

/* The path of a file in the fixture's folder; valid until the next call. */
const char* fixture_path(const fixture* f, const char* name);
uint64_t digest_bytes(uint64_t digest, const void* data, size_t size);
uint64_t digest_file(uint64_t digest, const char* path);

#endif
