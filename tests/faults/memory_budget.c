/* Every scenario under memory budgets that leave it more and less than it needs. Within the budget means that what malloc gave never
 * exceeds it; a call that needs more says FOCAL_ERROR_OUT_OF_MEMORY and how much, leaks nothing, and its handles work on.
 * The budget is the context's; names in another context, which has none, fill it up step by step.
 * usage: memory_budget [--steps COUNT] [--rings COUNT] [--threads COUNT] [SCENARIO...] */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "allocations.h"
#include "fixture.h"

enum {
  LIMIT = 64 << 20,
  OWN = 64 << 10 /* bytes: what the C library and the test itself allocate meanwhile */
};

static const double enough = 1.05; /* of the peak: threads overlap in other ways each time */

typedef struct tally {
  long runs, refused, kept, beyond, wrong;
} tally;

static struct {
  focal_context* context;
  focal_training_set* set; /* for its one name, as long as is wanted */
  char name[LIMIT + 1];    /* of the length wanted */
  int64_t peak;            /* until the test's own work began */
} ballast;

static void complain(const scenario* what, const char* why, int64_t bytes, focal_status status) {
  fprintf(stderr, "%s with %" PRId64 " bytes to go: %s (%s: %s)\n", what->name, bytes, why,
          focal_status_name(status), focal_last_error());
}

static int64_t left(void) { return LIMIT - (int64_t)focal_context_memory_held(ballast.context); }

static void note_peak(void) {
  if (allocations_peak_bytes() > ballast.peak) ballast.peak = allocations_peak_bytes();
  allocations_mark_peak();
}

/* What a scenario does for itself needs no budget, and may keep something. */
static void make_room(void) {
  note_peak();
  focal_training_set_destroy(ballast.set);
  ballast.set = NULL;
}
static void take_it_back(void) {
  const char* const name = ballast.name;
  const int64_t size = (int64_t)strlen(name), fits = left() < size ? left() : size;
  ballast.name[fits] = '\0';
  if (fits > 0 && focal_training_set_create(ballast.context, &name, 1, &ballast.set)) exit(2);
  if (fits < size) ballast.name[fits] = 'x';
  allocations_mark_peak();
}

/* Until no more than `bytes` are left, or a few less. */
static void fill_up(int64_t bytes) {
  make_room();
  const int64_t size = left() > bytes ? left() - bytes : 0;
  memset(ballast.name, 'x', (size_t)size);
  ballast.name[size] = '\0';
  take_it_back();
}

static void run_with(const scenario* what, const fixture* f, int64_t peak, uint64_t expected, tally* sum) {
  const int64_t room = left();
  const uint64_t held = focal_context_memory_held(ballast.context);
  const int64_t others = allocations_live_bytes() - (int64_t)held; /* not the library's */
  uint64_t digest = 1;
  ballast.peak = 0;
  allocations_mark_peak();
  const focal_status status = what->run(f, &digest);
  note_peak();
  ++sum->runs;
  if (ballast.peak - others > LIMIT + OWN)
    ++sum->beyond, complain(what, "more than the budget", room, status);
  if (status == FOCAL_OK && digest == expected) {
    ++sum->kept;
  } else if (status == FOCAL_ERROR_OUT_OF_MEMORY &&
             strstr(focal_last_error(), "the memory budget of 67108864 bytes") &&
             (double)room < enough * (double)peak) {
    ++sum->refused;
  } else {
    ++sum->wrong, complain(what, "another answer", room, status);
  }
  if (focal_context_memory_held(ballast.context) > held) /* less, by whole pages, is the allocator's doing */
    ++sum->wrong, complain(what, "a leak", room, status);
}

static tally run_all(const scenario* what, const fixture* f, int steps) {
  tally sum = {0};
  scenario_run_well(what, f); /* what is kept from the first use on */
  const int64_t before = allocations_live_bytes();
  ballast.peak = 0;
  allocations_mark_peak();
  const uint64_t expected = scenario_run_well(what, f);
  note_peak();
  const int64_t peak = ballast.peak - before;
  for (int i = 0; i <= steps; ++i) {
    fill_up((int64_t)(1.2 * enough * (double)peak * i / steps));
    run_with(what, f, peak, expected, &sum);
  }
  fill_up(LIMIT);
  run_with(what, f, peak, expected, &sum);
  printf("%-26s peak %9" PRId64 " bytes; %4ld budgets: %4ld enough, %4ld refused, %ld exceeded, %ld wrong\n",
         what->name, peak, sum.runs, sum.kept, sum.refused, sum.beyond, sum.wrong);
  fflush(stdout);
  return sum;
}

int main(int argc, char** argv) {
  int steps = 20, rings = 7, at = 1;
  focal_context_params params;
  focal_context_params_init(&params, sizeof params);
  params.thread_count = 1, params.memory_budget_bytes = LIMIT;
  for (; at + 1 < argc && strncmp(argv[at], "--", 2) == 0; at += 2) {
    if (strcmp(argv[at], "--steps") == 0) steps = atoi(argv[at + 1]);
    if (strcmp(argv[at], "--rings") == 0) rings = atoi(argv[at + 1]);
    if (strcmp(argv[at], "--threads") == 0) params.thread_count = atoi(argv[at + 1]);
  }
  if (focal_context_create(NULL, &ballast.context)) return 2;
  fixture f;
  fixture_create(&f, rings, &params);
  fixture_pause = make_room, fixture_resume = take_it_back;
  tally all = {0};
  size_t used = 0;
  for (size_t i = 0; i < scenario_count; ++i) {
    if (!scenario_chosen(&scenarios[i], argc - at, argv + at)) continue;
    const tally one = run_all(&scenarios[i], &f, steps);
    ++used;
    all.runs += one.runs, all.kept += one.kept, all.refused += one.refused;
    all.beyond += one.beyond, all.wrong += one.wrong;
  }
  fixture_destroy(&f);
  focal_context_destroy(ballast.context);
  printf("%zu scenarios, %ld budgets: %ld enough, %ld refused, %ld exceeded, %ld wrong answers; %" PRId64
         " bytes held at the end\n",
         used, all.runs, all.kept, all.refused, all.beyond, all.wrong, allocations_live_bytes());
  return used == 0 || all.refused == 0 || all.kept == 0 || all.beyond || all.wrong;
}
