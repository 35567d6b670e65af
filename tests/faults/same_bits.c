/* Every scenario gives the same bits with any number of threads, with the host's own loop, in a thread of 256 KiB, with
 * any rounding and flushing of the host, and with a decimal comma. Prints how much stack was used.
 * usage: same_bits [RINGS] */
#define _GNU_SOURCE
#include <fenv.h>
#include <locale.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>
#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

#include "fixture.h"

enum { STACK = 256 << 10, MOST_SCENARIOS = 64, LOOP_THREADS = 3 };

static uint64_t expected[MOST_SCENARIOS];
static long compared, different;

static uint64_t run_one(const fixture* f, size_t s) {
  uint64_t digest = 1;
  const focal_status status = scenarios[s].run(f, &digest);
  if (status == FOCAL_OK) return digest;
  fprintf(stderr, "%s: %s: %s\n", scenarios[s].name, focal_status_name(status), focal_last_error());
  return 0;
}

static void compare(const fixture* f, size_t s, const char* setting) {
  ++compared;
  if (run_one(f, s) == expected[s]) return;
  ++different;
  fprintf(stderr, "%s: other bits with %s\n", scenarios[s].name, setting);
}

static void compare_all(const fixture* f, const char* setting) {
  for (size_t s = 0; s < scenario_count; ++s) compare(f, s, setting);
}

typedef struct loop_part {
  focal_parallel_body_fn body;
  void* body_data;
  int64_t from, to;
} loop_part;

static void* run_part(void* data) {
  const loop_part* part = data;
  for (int64_t i = part->to - 1; i >= part->from; --i) part->body(part->body_data, i);
  return NULL;
}

/* The host's threads run backwards and have odd settings of their own. */
static void host_loop(void* user_data, int64_t count, focal_parallel_body_fn body, void* body_data) {
  loop_part parts[LOOP_THREADS];
  pthread_t threads[LOOP_THREADS];
  (void)user_data;
  fesetround(FE_DOWNWARD); /* threads inherit it */
  for (int i = 0; i < LOOP_THREADS; ++i) {
    parts[i] = (loop_part){body, body_data, count * i / LOOP_THREADS, count * (i + 1) / LOOP_THREADS};
    if (pthread_create(&threads[i], NULL, run_part, &parts[i]) != 0) exit(2);
  }
  for (int i = 0; i < LOOP_THREADS; ++i) pthread_join(threads[i], NULL);
  fesetround(FE_TONEAREST);
}

/* The meshes and models too are made anew: in a context of its own. */
static void with_threads(int rings, int threads, focal_parallel_for_fn loop, const char* setting) {
  fixture f;
  focal_context_params params;
  focal_context_params_init(&params, sizeof params);
  params.thread_count = threads, params.parallel_for = loop;
  fixture_create(&f, rings, &params);
  compare_all(&f, setting);
  fixture_destroy(&f);
}

typedef struct stack_call {
  const fixture* f;
  size_t scenario;
} stack_call;

static void* run_on_stack(void* data) {
  const stack_call* call = data;
  compare(call->f, call->scenario, "a stack of 256 KiB");
  return NULL;
}

/* JSON of many levels must be refused, not followed. */
static void* load_deep(void* data) {
  const fixture* f = ((const stack_call*)data)->f;
  enum { DEPTH = 200000 };
  static char text[2 * DEPTH + 64];
  char* at = text + sprintf(text, "{\"asset\":{\"version\":\"2.0\"},\"extras\":");
  memset(at, '[', DEPTH);
  memset(at + DEPTH, ']', DEPTH);
  at[2 * DEPTH] = '}';
  focal_mesh* mesh = NULL;
  focal_skeleton* skeleton = NULL;
  focal_skeleton_params params;
  focal_skeleton_params_init(&params, sizeof params);
  params.skeleton_template = at;
  compared += 2;
  different +=
      focal_mesh_load_gltf_memory(f->context, text, strlen(text), NULL, &mesh) != FOCAL_ERROR_UNSUPPORTED;
  different += focal_skeleton_create(f->detection, &params, NULL, &skeleton) != FOCAL_ERROR_UNSUPPORTED;
  return NULL;
}

/* Runs in a thread whose stack was filled before; returns how much of it was touched. */
static size_t stack_used(void* (*run)(void*), stack_call* call) {
  const size_t page = (size_t)sysconf(_SC_PAGESIZE);
  unsigned char* const all =
      mmap(NULL, STACK + page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_STACK, -1, 0);
  pthread_attr_t attributes;
  pthread_t thread;
  if (all == MAP_FAILED || mprotect(all, page, PROT_NONE) != 0)
    exit(2); /* one step too far ends the program */
  memset(all + page, 0xA5, STACK);
  pthread_attr_init(&attributes);
  if (pthread_attr_setstack(&attributes, all + page, STACK) != 0) exit(2);
  if (pthread_create(&thread, &attributes, run, call) != 0) exit(2);
  pthread_join(thread, NULL);
  size_t untouched = 0;
  while (untouched < STACK && all[page + untouched] == 0xA5) ++untouched;
  munmap(all, STACK + page);
  return STACK - untouched;
}

static void on_small_stack(const fixture* f) {
  size_t most = 0, worst = 0;
  for (size_t s = 0; s <= scenario_count; ++s) {
    stack_call call = {f, s};
    const size_t used = stack_used(s < scenario_count ? run_on_stack : load_deep, &call);
    if (used > most) most = used, worst = s;
  }
  printf("stack: at most %zu KiB of 256, in \"%s\"\n", most >> 10,
         worst < scenario_count ? scenarios[worst].name : "deep JSON");
}

static void with_odd_floats(const fixture* f) {
  static const struct {
    int mode;
    const char* name;
  } modes[] = {{FE_UPWARD, "rounding up"}, {FE_DOWNWARD, "rounding down"}, {FE_TOWARDZERO, "rounding to 0"}};
  for (size_t i = 0; i < sizeof modes / sizeof *modes; ++i) {
    fesetround(modes[i].mode);
    compare_all(f, modes[i].name);
    different += fegetround() != modes[i].mode;
    fesetround(FE_TONEAREST);
  }
#if defined(__SSE2__)
  _mm_setcsr(_mm_getcsr() | 0x8040); /* flush to zero, denormals are zero */
  compare_all(f, "flushing to zero");
  different += (_mm_getcsr() & 0x8040) != 0x8040;
  _mm_setcsr(0x1F80);
#endif
}

/* LOCPATH may lead to one made by localedef: see run.sh. */
static void with_comma(const fixture* f) {
  static const char* const names[] = {"de_DE.UTF-8", "de_DE.utf8", "de_DE", "fr_FR.UTF-8"};
  const char* set = NULL;
  for (size_t i = 0; !set && i < sizeof names / sizeof *names; ++i) set = setlocale(LC_ALL, names[i]);
  if (!set || *localeconv()->decimal_point != ',') {
    printf("skipped: no locale with a decimal comma is installed\n");
    return;
  }
  compare_all(f, "a decimal comma");
  setlocale(LC_ALL, "C");
}

int main(int argc, char** argv) {
  const int rings = argc > 1 ? atoi(argv[1]) : 7;
  fixture f;
  focal_context_params params;
  focal_context_params_init(&params, sizeof params);
  params.thread_count = 1;
  fixture_create(&f, rings, &params);
  for (size_t s = 0; s < scenario_count; ++s) {
    expected[s] = run_one(&f, s);
    if (expected[s] == 0) return 1;
  }
#if !defined(__SANITIZE_THREAD__) /* which needs more stack for itself */
  on_small_stack(&f);
#else
  (void)on_small_stack;
#endif
  with_odd_floats(&f);
  with_comma(&f);
  fixture_destroy(&f);
  with_threads(rings, 2, NULL, "2 threads");
  with_threads(rings, 4, NULL, "4 threads");
  with_threads(rings, 8, NULL, "8 threads");
  with_threads(rings, 0, host_loop, "the host's loop");
  printf("%zu scenarios of %llu vertices, %ld compared, %ld with other bits\n", scenario_count,
         (unsigned long long)(2 * rings * rings + 2), compared, different);
  return different != 0;
}
