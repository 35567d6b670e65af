/* What a host may bring: its own threads, a log, odd floating-point settings, a comma-decimal locale; and
 * that the result is the same bits with each of them. */
#include <fenv.h>
#include <locale.h>
#include <pthread.h>
#include <stdlib.h>
#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

#include "check.h"
#include "shapes.h"

enum { RINGS = 12 };

typedef struct loop {
  focal_parallel_body_fn body;
  void* body_data;
  int64_t count, first, step;
} loop;

static void* run_part(void* data) {
  const loop* part = data;
  for (int64_t i = part->first; i < part->count; i += part->step) part->body(part->body_data, i);
  return NULL;
}

/* A host's loop on three threads, last index first to be different from focal's own order. */
static void host_parallel_for(void* user_data, int64_t count, focal_parallel_body_fn body, void* body_data) {
  enum { PARTS = 3 };
  loop parts[PARTS];
  pthread_t threads[PARTS];
  ++*(int*)user_data;
  for (int i = PARTS - 1; i >= 0; --i) {
    parts[i] = (loop){body, body_data, count, i, PARTS};
    pthread_create(&threads[i], NULL, run_part, &parts[i]);
  }
  for (int i = 0; i < PARTS; ++i) pthread_join(threads[i], NULL);
}

static void count_log(void* user_data, focal_log_level level, const char* message) {
  if (level >= FOCAL_LOG_INFO && *message) ++*(int*)user_data;
}

static void keep_settings(void) {}

/* Trains a small model and returns its bytes; `upset` and `restore` surround the training alone, as the
 * shapes that the test computes must stay what they are. */
static focal_blob* trained_amid(const focal_context_params* params, void (*upset)(void),
                                void (*restore)(void)) {
  focal_context* context = NULL;
  focal_model* model = NULL;
  focal_blob* blob = NULL;
  focal_train_params train;
  CHECK_OK(focal_context_create(params, &context));
  CHECK_OK(focal_train_params_init(&train, sizeof train));
  train.eigenpair_count = 40, train.tree_count = 4;
  focal_training_set* set = shape_training_set(context, RINGS, 3);
  upset();
  CHECK_OK(focal_model_train(set, &train, NULL, &model));
  restore();
  if (model) CHECK_OK(focal_model_save_memory(model, &blob));
  focal_model_destroy(model);
  focal_training_set_destroy(set);
  focal_context_destroy(context);
  return blob;
}

static focal_blob* trained(const focal_context_params* params) {
  return trained_amid(params, keep_settings, keep_settings);
}

static void check_same(const focal_blob* expected, focal_blob* blob, const char* what) {
  const uint64_t size = focal_blob_size(expected);
  if (size == 0 || focal_blob_size(blob) != size ||
      memcmp(focal_blob_data(blob), focal_blob_data(expected), (size_t)size) != 0) {
    ++check_failures;
    fprintf(stderr, "another model with %s\n", what);
  }
  focal_blob_destroy(blob);
}

static void check_threads(const focal_blob* expected) {
  focal_context_params params;
  int loops = 0, messages = 0;
  CHECK_OK(focal_context_params_init(&params, sizeof params));
  params.thread_count = 2;
  check_same(expected, trained(&params), "two threads");
  params.thread_count = 0;
  params.parallel_for = host_parallel_for, params.parallel_for_user_data = &loops;
  params.log = count_log, params.log_user_data = &messages;
  check_same(expected, trained(&params), "the host's threads");
  CHECK(loops > 0 && messages > 0);
}

static void upset_floats(void) {
  fesetround(FE_UPWARD);
#if defined(__SSE2__)
  _mm_setcsr(_mm_getcsr() | 0x8040); /* flush to zero, denormals are zero */
#endif
}

static void check_and_restore_floats(void) {
  CHECK(fegetround() == FE_UPWARD);
#if defined(__SSE2__)
  CHECK((_mm_getcsr() & 0x8040) == 0x8040);
  _mm_setcsr(0x1F80);
#endif
  fesetround(FE_TONEAREST);
}

static void check_locale(const focal_blob* expected, const focal_context_params* params) {
  static const char* const names[] = {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "cs_CZ.UTF-8"};
  const char* set = NULL;
  for (size_t i = 0; !set && i < sizeof names / sizeof *names; ++i) set = setlocale(LC_ALL, names[i]);
  if (!set) {
    printf("skipped: no locale with a decimal comma is installed\n");
    return;
  }
  check_same(expected, trained(params), "a decimal comma");
  setlocale(LC_ALL, "C");
}

int main(void) {
  focal_context_params one_thread;
  CHECK_OK(focal_context_params_init(&one_thread, sizeof one_thread));
  one_thread.thread_count = 1;
  focal_blob* expected = trained(&one_thread);
  check_same(expected, trained(&one_thread), "the same settings");
  check_threads(expected);
  check_same(expected, trained_amid(&one_thread, upset_floats, check_and_restore_floats), "odd rounding");
  check_locale(expected, &one_thread);
  focal_blob_destroy(expected);
  FINISH();
}
