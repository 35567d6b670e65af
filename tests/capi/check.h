/* Checks for the C tests of the ABI: a failed one is printed and counted, FINISH() gives the exit status. */
#ifndef FOCAL_TEST_CHECK_H
#define FOCAL_TEST_CHECK_H

#include <focal/focal.h>
#include <stdio.h>
#include <string.h>

static int check_failures;

#define CHECK(condition)                                                      \
  do {                                                                        \
    if (!(condition)) {                                                       \
      ++check_failures;                                                       \
      fprintf(stderr, "%s:%d: failed: %s\n", __FILE__, __LINE__, #condition); \
    }                                                                         \
  } while (0)

#define CHECK_OK(call)                                                                                   \
  do {                                                                                                   \
    const focal_status check_status = (call);                                                            \
    if (check_status != FOCAL_OK) {                                                                      \
      ++check_failures;                                                                                  \
      fprintf(stderr, "%s:%d: %s: %s\n%s\n", __FILE__, __LINE__, #call, focal_status_name(check_status), \
              focal_last_error());                                                                       \
    }                                                                                                    \
  } while (0)

/* The call fails with this status, a message that contains `fragment`, and a hint. */
static inline void check_refused(focal_status status, focal_status expected, const char* fragment,
                                 const char* what, int line) {
  const char* error = focal_last_error();
  const char* hint = strstr(error, "\nhint: ");
  const char* found = strstr(error, fragment);
  if (status == expected && hint && strlen(hint) > strlen("\nhint: ") && found && found < hint) return;
  ++check_failures;
  fprintf(stderr, "line %d: %s\n  expected %s with \"%s\" and a hint\n  got %s: %s\n", line, what,
          focal_status_name(expected), fragment, focal_status_name(status), error);
}

#define CHECK_REFUSED(call, status, fragment) check_refused((call), (status), (fragment), #call, __LINE__)

#define FINISH() return check_failures ? (fprintf(stderr, "%d checks failed\n", check_failures), 1) : 0

#endif
