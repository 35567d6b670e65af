/* What the files of scenarios share. */
#ifndef FOCAL_TEST_SCENARIO_STEPS_H
#define FOCAL_TEST_SCENARIO_STEPS_H

#include "fixture.h"

#define TRY(call)                                  \
  do {                                             \
    const focal_status try_status = (call);        \
    if (try_status != FOCAL_OK) return try_status; \
  } while (0)

/* Around what a test does for itself inside a watched call. */
static inline void own_work_begins(void) {
  if (fixture_pause) fixture_pause();
}
static inline void own_work_ends(void) {
  if (fixture_resume) fixture_resume();
}

/* Adds a file of the fixture's folder; reading it is the test's own work. */
void add_file(uint64_t* digest, const fixture* f, const char* name);

/* result_scenarios.c */
focal_status run_write(const fixture* f, uint64_t* digest);
focal_status run_maps(const fixture* f, uint64_t* digest);
focal_status run_correspondence(const fixture* f, uint64_t* digest);
focal_status run_segment(const fixture* f, uint64_t* digest);
focal_status run_skeleton(const fixture* f, uint64_t* digest);
focal_status run_template(const fixture* f, uint64_t* digest);
focal_status run_bind(const fixture* f, uint64_t* digest);

#endif
