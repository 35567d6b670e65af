/* Every allocation of every scenario fails in turn: alone, and with all that follow. The call must say
 * FOCAL_ERROR_OUT_OF_MEMORY, or get by without and give the same bits; nothing may leak, and the same handles then give
 * the same bits.
 * usage: out_of_memory [--most COUNT] [--threads COUNT] [--only NUMBER] [SCENARIO...]
 * --most: of the allocations of a scenario, spread over it; 0, the default: all. --only: one, for a debugger that
 * stops in allocation_refused. */
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "allocations.h"
#include "fixture.h"

typedef struct tally {
  long faults, refused, done_without, wrong, leaks, corrupted;
} tally;

static const char* at_scenario = "";
static long at_allocation;
static int at_ever;
static int
    one_thread; /* with more the C library keeps what belongs to a thread for the next one: no exact sums */

static void tell_where(int number) {
  char text[256];
  const int size = snprintf(text, sizeof text, "signal %d in \"%s\", allocation %ld%s\n", number, at_scenario,
                            at_allocation, at_ever ? " and all after it" : "");
  if (write(STDERR_FILENO, text, (size_t)size) < 0) _exit(4);
  _exit(3);
}

static void complain(const char* why, focal_status status) {
  fprintf(stderr, "%s, allocation %ld%s: %s (%s: %s)\n", at_scenario, at_allocation,
          at_ever ? " and all after it" : "", why, focal_status_name(status), focal_last_error());
}

/* Whole: the scenario is run once more without a fault, on the same handles. */
static void fail_one(const scenario* what, const fixture* f, uint64_t expected, int whole, tally* sum) {
  const int64_t blocks = allocations_live_blocks(), bytes = allocations_live_bytes();
  uint64_t digest = 1;
  allocations_fail(at_allocation, at_ever);
  const focal_status status = what->run(f, &digest);
  allocations_spare();
  ++sum->faults;
  if (status == FOCAL_OK && digest == expected) {
    ++sum->done_without;
  } else if (status == FOCAL_ERROR_OUT_OF_MEMORY && strstr(focal_last_error(), "\nhint: ")) {
    ++sum->refused;
  } else {
    ++sum->wrong;
    complain("another answer", status);
  }
  if (one_thread && (allocations_live_blocks() != blocks || allocations_live_bytes() != bytes)) {
    ++sum->leaks;
    complain("a leak", status);
  }
  if (whole && scenario_run_well(what, f) != expected) {
    ++sum->corrupted;
    complain("other results afterwards", status);
  }
}

/* Every allocation, or `most` of them spread evenly, always with the first and the last. Of over 1,000, or of some only, each
 * tenth is followed by a whole run: those are what takes the time. */
static tally fail_each(const scenario* what, const fixture* f, long most, long only) {
  tally sum = {0};
  at_scenario = what->name;
  scenario_run_well(what, f); /* what is kept from the first use on */
  allocations_fail(0, 0);
  const uint64_t expected = scenario_run_well(what, f);
  const long count = (long)allocations_spare(), tried = most > 0 && most < count ? most : count;
  for (at_ever = 0; at_ever <= 1; ++at_ever)
    for (long i = 0; i < tried; ++i) {
      if (only > 0 && (i > 0 || at_ever)) continue;
      at_allocation = only > 0    ? only
                      : tried > 1 ? 1 + (long)((double)i * (double)(count - 1) / (double)(tried - 1))
                                  : 1;
      fail_one(what, f, expected, (most == 0 && tried <= 1000) || i % 10 == 0, &sum);
    }
  printf(
      "%-26s %7ld allocations, %7ld faults: %7ld out of memory, %4ld got by, %ld wrong, %ld leaks, %ld "
      "corrupted\n",
      what->name, count, sum.faults, sum.refused, sum.done_without, sum.wrong, sum.leaks, sum.corrupted);
  fflush(stdout);
  return sum;
}

/* Threads that cannot be started: the others do the work. */
static void fail_threads(const scenario* what, const fixture* f, int threads, tally* sum) {
  const uint64_t expected = scenario_run_well(what, f);
  for (int left = 0; left < threads; ++left) {
    threads_fail_after(left);
    ++sum->faults;
    if (scenario_run_well(what, f) == expected)
      ++sum->done_without;
    else
      ++sum->wrong, fprintf(stderr, "%s: other results with %d threads started\n", what->name, left);
    threads_fail_after(-1);
  }
}

int main(int argc, char** argv) {
  long most = 0, only = 0;
  focal_context_params params;
  focal_context_params_init(&params, sizeof params);
  params.thread_count = 1;
  int at = 1;
  for (; at + 1 < argc && strncmp(argv[at], "--", 2) == 0; at += 2) {
    if (strcmp(argv[at], "--most") == 0) most = atol(argv[at + 1]);
    if (strcmp(argv[at], "--only") == 0) only = atol(argv[at + 1]);
    if (strcmp(argv[at], "--threads") == 0) params.thread_count = atoi(argv[at + 1]);
  }
  one_thread = params.thread_count == 1;
  signal(SIGABRT, tell_where), signal(SIGSEGV, tell_where), signal(SIGFPE, tell_where);
  fixture f;
  fixture_create(&f, 7, &params);
  fixture_pause = allocations_pause, fixture_resume = allocations_resume;
  tally all = {0};
  size_t used = 0;
  for (size_t i = 0; i < scenario_count; ++i) {
    if (!scenario_chosen(&scenarios[i], argc - at, argv + at)) continue;
    tally one = fail_each(&scenarios[i], &f, most, only);
    if (params.thread_count > 1) fail_threads(&scenarios[i], &f, params.thread_count, &one);
    ++used;
    all.faults += one.faults, all.refused += one.refused, all.done_without += one.done_without;
    all.wrong += one.wrong, all.leaks += one.leaks, all.corrupted += one.corrupted;
  }
  fixture_destroy(&f);
  printf(
      "%zu scenarios, %ld faults: %ld out of memory, %ld got by with the same result, %ld other answers, 0 "
      "aborts, "
      "%ld leaks, %ld corrupted handles\n",
      used, all.faults, all.refused, all.done_without, all.wrong, all.leaks, all.corrupted);
  return used == 0 || all.wrong || all.leaks || all.corrupted;
}
