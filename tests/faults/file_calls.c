#define _GNU_SOURCE
#include "file_calls.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

static file_plan plan;
static int active, renamed, interrupted;
static int64_t calls;

void file_calls_begin(file_plan next) {
  plan = next;
  calls = 0, renamed = 0, interrupted = 0;
  active = 1;
}

int64_t file_calls_end(void) {
  active = 0;
  return calls;
}

int file_calls_renamed(void) { return renamed; }

static void die(void) {
  kill(getpid(), SIGKILL);
  for (;;) pause();
}

/* Whether the call that begins is to fail; errno says how. */
static int fails(void) {
  if (!active) return 0;
  if (interrupted < plan.interruptions) {
    ++interrupted;
    errno = EINTR;
    return 1;
  }
  interrupted = 0;
  ++calls;
  if (plan.die_at == 2 * calls - 1) die();
  errno = plan.error;
  return calls == plan.fail_at;
}

static long ended(long result) {
  if (active && plan.die_at == 2 * calls) die();
  return result;
}

int open(const char* path, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const mode_t mode = flags & O_CREAT ? va_arg(more, mode_t) : 0;
  va_end(more);
  if (fails()) return -1;
  return (int)ended(syscall(SYS_openat, AT_FDCWD, path, flags, mode));
}

int fchmod(int file, mode_t mode) { return fails() ? -1 : (int)ended(syscall(SYS_fchmod, file, mode)); }

ssize_t write(int file, const void* data, size_t size) {
  if (active && file > STDERR_FILENO) {
    if (fails()) return errno ? -1 : 0;
    if (plan.longest_write && size > plan.longest_write) size = plan.longest_write;
  }
  return ended(syscall(SYS_write, file, data, size));
}

int fsync(int file) { return fails() ? -1 : (int)ended(syscall(SYS_fsync, file)); }

/* Linux closes the file whatever it says, so an interrupted close is not tried again. */
int close(int file) {
  const int fail = fails(), error = errno;
  if (fail && interrupted) interrupted = 0;
  const long result = syscall(SYS_close, file);
  if (!fail) return (int)ended(result);
  errno = error;
  return -1;
}

int rename(const char* from, const char* to) {
  if (fails()) return -1;
  const long result = syscall(SYS_renameat2, AT_FDCWD, from, AT_FDCWD, to, 0);
  if (result == 0) renamed = 1;
  return (int)ended(result);
}
