/* The calls with which a file is saved, made to fail, to be cut short or to end the process. They are defined here, so
 * they stand before those of the C library. */
#ifndef FOCAL_TEST_FILE_CALLS_H
#define FOCAL_TEST_FILE_CALLS_H

#include <stddef.h>
#include <stdint.h>

/* Calls are counted from 1: open, fchmod, write, fsync, close, rename. */
typedef struct file_plan {
  int64_t fail_at;      /* this one fails; 0: none */
  int error;            /* with this errno; 0: a write that writes nothing */
  size_t longest_write; /* bytes written at most by one call; 0: all */
  int interruptions;    /* so often each of them is interrupted (EINTR) before it works */
  int64_t die_at; /* kill -9 just before call (die_at + 1) / 2 when odd, just after it when even; 0: never */
} file_plan;

void file_calls_begin(file_plan plan);
/* Ends the plan; returns how many calls there were. */
int64_t file_calls_end(void);
/* Whether a rename worked since file_calls_begin. */
int file_calls_renamed(void);

#endif
