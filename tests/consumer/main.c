/* What a stranger's first program does: link, ask the version, make and drop a context. */
#include <focal/focal.h>
#include <stdio.h>

int main(void) {
  focal_context* context = NULL;
  if (focal_version() >> 16 != FOCAL_VERSION_MAJOR) return 1;
  if (focal_context_create(NULL, &context) != FOCAL_OK) {
    fprintf(stderr, "%s\n", focal_last_error());
    return 1;
  }
  printf("focal %s, %d threads\n", focal_version_string(), (int)focal_context_thread_count(context));
  return focal_context_destroy(context) == FOCAL_OK ? 0 : 1;
}
