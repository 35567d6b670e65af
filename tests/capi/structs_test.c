/* Parameter structs: defaults, presets, and every wrong struct_size. */
#include "check.h"

/* What a client compiled against a later header would hand in. */
typedef struct later_train_params {
  focal_train_params known;
  uint64_t new_knob;
} later_train_params;

static void check_init(void) {
  focal_train_params params;
  CHECK_OK(focal_train_params_init(&params, sizeof params));
  CHECK(params.struct_size == sizeof params);
  CHECK(params.preset == FOCAL_PRESET_DEFAULT && params.tree_count == 30 && params.eigenpair_count == 128);
  CHECK_REFUSED(focal_train_params_init(NULL, sizeof params), FOCAL_ERROR_INVALID_ARGUMENT, "is NULL");
  CHECK_REFUSED(focal_train_params_init(&params, 4), FOCAL_ERROR_INVALID_ARGUMENT, "struct_size is 4");
  CHECK_REFUSED(focal_train_params_init(&params, 1u << 20), FOCAL_ERROR_INVALID_ARGUMENT, "struct_size");
}

static void check_presets(void) {
  focal_train_params params;
  CHECK_OK(focal_train_params_init(&params, sizeof params));
  params.tree_count = 1;
  CHECK_OK(focal_train_params_set_preset(&params, FOCAL_PRESET_PAPER));
  CHECK(params.preset == FOCAL_PRESET_PAPER && params.tree_count == 30 &&
        params.struct_size == sizeof params);
  CHECK_REFUSED(focal_train_params_set_preset(&params, 7), FOCAL_ERROR_INVALID_ARGUMENT, "preset is 7");
}

static focal_status train_with(const focal_train_params* params) {
  focal_context* context = NULL;
  focal_training_set* set = NULL;
  focal_model* model = NULL;
  const char* const names[] = {"nose"};
  CHECK_OK(focal_context_create(NULL, &context));
  CHECK_OK(focal_training_set_create(context, names, 1, &set));
  const focal_status status = focal_model_train(set, params, NULL, &model);
  CHECK(model == NULL);
  focal_training_set_destroy(set);
  focal_context_destroy(context);
  return status;
}

static void check_sizes(void) {
  later_train_params later;
  CHECK_OK(focal_train_params_init(&later.known, sizeof later));
  CHECK(later.known.struct_size == sizeof later && later.new_knob == 0);
  /* The set is empty, so TOO_FEW_SHAPES says that the parameters were taken. */
  CHECK(train_with(&later.known) == FOCAL_ERROR_TOO_FEW_SHAPES);
  later.new_knob = 1;
  CHECK_REFUSED(train_with(&later.known), FOCAL_ERROR_UNSUPPORTED, "does not know");
  later.known.struct_size = 0;
  CHECK_REFUSED(train_with(&later.known), FOCAL_ERROR_INVALID_ARGUMENT, "struct_size is 0");
  later.known.struct_size = 0xCDCDCDCD;
  CHECK_REFUSED(train_with(&later.known), FOCAL_ERROR_INVALID_ARGUMENT, "struct_size");
}

/* A field takes the two values in the middle; the ones around them are refused by its name. */
#define TRAIN(field, below, least, most, above)                                                             \
  do {                                                                                                      \
    const double values[] = {below, least, most, above};                                                    \
    for (int i = 0; i < 4; ++i) {                                                                           \
      focal_train_params params;                                                                            \
      CHECK_OK(focal_train_params_init(&params, sizeof params));                                            \
      params.field = values[i];                                                                             \
      const int taken = i == 1 || i == 2;                                                                   \
      CHECK_REFUSED(train_with(&params), taken ? FOCAL_ERROR_TOO_FEW_SHAPES : FOCAL_ERROR_INVALID_ARGUMENT, \
                    taken ? "" : "focal_train_params." #field " is");                                       \
    }                                                                                                       \
  } while (0)

static void check_ranges(void) {
  const int32_t descriptors = (int32_t)focal_descriptor_count(), distances = (int32_t)focal_distance_count();
  TRAIN(preset, -1, FOCAL_PRESET_DEFAULT, FOCAL_PRESET_DEFAULT, 2);
  TRAIN(eigenpair_count, 7, 8, 2000, 2001);
  TRAIN(tree_count, 0, 1, 10000, 10001);
  TRAIN(min_leaf_samples, 0, 1, INT32_MAX, -1);
  TRAIN(components_per_split, 0, 1, INT32_MAX, -1);
  TRAIN(sampling_rate, 0, 1e-6, 1, 1.5);
  TRAIN(max_samples_per_shape, 0, 1, INT32_MAX, -1);
  TRAIN(proxy_vertices, -1, 0, INT32_MAX, -2);
  TRAIN(learn_confidence, -1, 0, 1, 2);
  TRAIN(rigged_shapes, 1, 2, 10000, 10001);
  TRAIN(descriptor, -1, 0, descriptors - 1, descriptors);
  TRAIN(distance, -1, 0, FOCAL_DISTANCE_EXACT, distances); /* not all suit the preset */
}

static focal_status context_with(const focal_context_params* params) {
  focal_context* context = NULL;
  const focal_status status = focal_context_create(params, &context);
  focal_context_destroy(context);
  return status == FOCAL_OK ? train_with(NULL) : status; /* an empty set: TOO_FEW_SHAPES */
}

#define CONTEXT(field, below, least, most, above)                                      \
  do {                                                                                 \
    const double values[] = {below, least, most, above};                               \
    for (int i = 0; i < 4; ++i) {                                                      \
      focal_context_params params;                                                     \
      CHECK_OK(focal_context_params_init(&params, sizeof params));                     \
      params.field = values[i];                                                        \
      const int taken = i == 1 || i == 2;                                              \
      CHECK_REFUSED(context_with(&params),                                             \
                    taken ? FOCAL_ERROR_TOO_FEW_SHAPES : FOCAL_ERROR_INVALID_ARGUMENT, \
                    taken ? "" : "focal_context_params." #field " is");                \
    }                                                                                  \
  } while (0)

static void check_context_ranges(void) {
  CONTEXT(device_index, -1, 0, 1023, 1024);
  CONTEXT(thread_count, -1, 0, 1024, 1025);
  CONTEXT(backend, -1, FOCAL_BACKEND_AUTO, FOCAL_BACKEND_CUDA, 3);
  CONTEXT(backend, 4, FOCAL_BACKEND_CPU, FOCAL_BACKEND_CPU, 5);
}

/* A long message is cut, between characters; its hint is not. */
static void check_long_message(void) {
  enum { LETTERS = 1500 };
  char path[2 * LETTERS + 2];
  focal_context* context = NULL;
  focal_model* model = NULL;
  CHECK_OK(focal_context_create(NULL, &context));
  for (int odd = 0; odd < 2; ++odd) {
    path[0] = 'x';
    for (int i = 0; i < LETTERS; ++i) memcpy(path + odd + 2 * i, "\xC3\xA9", 2);
    path[odd + 2 * LETTERS] = '\0';
    CHECK(focal_model_load(context, path, &model) != FOCAL_OK);
    const char* hint = strstr(focal_last_error(), "\nhint: ");
    CHECK(hint && strlen(hint) > 8 && strlen(focal_last_error()) < 2048);
    CHECK(hint && hint - focal_last_error() > 1000 && hint[-2] == '\xC3' && hint[-1] == '\xA9');
  }
  focal_context_destroy(context);
}

static void check_context_params(void) {
  focal_context_params params;
  focal_context* context = NULL;
  CHECK_OK(focal_context_params_init(&params, sizeof params));
  params.thread_count = -1;
  CHECK_REFUSED(focal_context_create(&params, &context), FOCAL_ERROR_INVALID_ARGUMENT, "thread_count is -1");
  params.thread_count = 3;
  params.backend = 9;
  CHECK_REFUSED(focal_context_create(&params, &context), FOCAL_ERROR_INVALID_ARGUMENT, "backend is 9");
  CHECK(focal_context_memory_held(NULL) == 0);
  params.backend = FOCAL_BACKEND_CUDA; /* missing or not, it must not fail */
  CHECK_OK(focal_context_create(&params, &context));
  CHECK(focal_context_thread_count(context) == 3);
  CHECK(focal_context_backend(context) != FOCAL_BACKEND_AUTO);
  CHECK(focal_context_backend_reason(context) && *focal_context_backend_reason(context));
  CHECK_REFUSED(focal_context_create(&params, NULL), FOCAL_ERROR_INVALID_ARGUMENT, "out_context is NULL");
  focal_context_destroy(context);
}

int main(void) {
  CHECK(focal_version() ==
        (FOCAL_VERSION_MAJOR << 16 | FOCAL_VERSION_MINOR << 8 | (uint32_t)FOCAL_VERSION_PATCH));
  CHECK(strcmp(focal_status_name(FOCAL_ERROR_TOO_FEW_SHAPES), "FOCAL_ERROR_TOO_FEW_SHAPES") == 0);
  CHECK(strcmp(focal_status_name(12345), "FOCAL_ERROR_UNKNOWN") == 0);
  CHECK(focal_peak_memory_bytes() > 100000);
  check_init();
  check_presets();
  check_sizes();
  check_ranges();
  check_context_params();
  check_context_ranges();
  check_long_message();
  FINISH();
}
