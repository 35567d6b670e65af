/* Stock models through the C ABI: by name from a folder of the host's, and what an unknown name is answered with. */
#include <stdlib.h>

#include "check.h"
#include "portable.h"
#include "shapes.h"

static focal_context* context_with(const char* folder) {
  focal_context_params params;
  focal_context* context = NULL;
  CHECK_OK(focal_context_params_init(&params, sizeof params));
  params.models_folder = folder;
  CHECK_OK(focal_context_create(&params, &context));
  return context;
}

static int has(const focal_context* context, const char* name) {
  for (uint32_t i = 0; i < focal_context_stock_count(context); ++i)
    if (strcmp(focal_context_stock_name(context, i), name) == 0) return 1;
  return 0;
}

int main(void) {
  char folder[] = "stock_test", good[64], bad[64];
  if (!make_folder(folder)) return 2;
  snprintf(good, sizeof good, "%s/dumbbell.focal", folder);
  snprintf(bad, sizeof bad, "%s/broken.focal", folder);
  focal_context* context = context_with(folder);
  focal_training_set* set = shape_training_set(context, 10, 2);
  focal_model *model = shape_model(set), *stock = NULL;
  CHECK_OK(focal_model_save(model, good));
  FILE* file = fopen(bad, "w");
  CHECK(file && fputs("no model", file) >= 0 && fclose(file) == 0);

  CHECK(has(context, "dumbbell") && has(context, "broken") && !has(context, "dragon"));
  CHECK(strstr(focal_context_stock_path(context, 0), ".focal"));
  CHECK_OK(focal_model_load_stock(context, "dumbbell", &stock));
  CHECK(strcmp(focal_model_landmark_name(stock, 1), focal_model_landmark_name(model, 1)) == 0);
  focal_model_destroy(stock), stock = NULL;
  CHECK_REFUSED(focal_model_load_stock(context, "dragon", &stock), FOCAL_ERROR_FILE_NOT_FOUND,
                "no stock model 'dragon'");
  CHECK(strstr(focal_last_error(), "dumbbell"));
  CHECK_REFUSED(focal_model_load_stock(context, "broken", &stock), FOCAL_ERROR_INVALID_FILE, "broken.focal");
  CHECK_REFUSED(focal_model_load_stock(context, NULL, &stock), FOCAL_ERROR_INVALID_ARGUMENT, "name");
  CHECK_REFUSED(focal_model_load_stock(context, "dumbbell", NULL), FOCAL_ERROR_INVALID_ARGUMENT, "out_model");
  CHECK_REFUSED(focal_model_load_stock(NULL, "dumbbell", &stock), FOCAL_ERROR_INVALID_HANDLE, "is NULL");
  CHECK(stock == NULL);
  CHECK(focal_context_stock_name(context, 100000) == NULL);
  CHECK(strstr(focal_last_error(), "no number 100000"));
  CHECK(focal_context_stock_path(context, 100000) == NULL && focal_context_stock_count(NULL) == 0);

  /* FOCAL_MODELS names folders too; a context looks once. */
  focal_context* before = context_with(NULL);
  CHECK(!has(before, "dumbbell"));
  CHECK(set_variable("FOCAL_MODELS", folder));
  focal_context* after = context_with(NULL);
  CHECK(has(after, "dumbbell") && !has(before, "dumbbell"));
  focal_context_destroy(before), focal_context_destroy(after);

  focal_model_destroy(model), focal_training_set_destroy(set), focal_context_destroy(context);
  remove(good), remove(bad), remove_folder(folder);
  FINISH();
}
