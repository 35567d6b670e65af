#define _GNU_SOURCE
#include "allocations.h"

#include <dlfcn.h>
#include <errno.h>
#include <malloc.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdlib.h>

extern void* __libc_malloc(size_t size);
extern void* __libc_calloc(size_t count, size_t size);
extern void* __libc_realloc(void* block, size_t size);
extern void* __libc_memalign(size_t alignment, size_t size);
extern void __libc_free(void* block);

static atomic_int_fast64_t live_blocks, live_bytes, peak_bytes;
static atomic_int_fast64_t asked, first_to_fail;
static atomic_int armed, fails_ever;

/* Where a debugger stops to see who asked. */
__attribute__((noinline)) void allocation_refused(void) { errno = ENOMEM; }

static int refuses(void) {
  if (!atomic_load_explicit(&armed, memory_order_relaxed)) return 0;
  const int64_t number = atomic_fetch_add(&asked, 1) + 1, first = atomic_load(&first_to_fail);
  if (first == 0 || (number != first && !(number > first && atomic_load(&fails_ever)))) return 0;
  allocation_refused();
  return 1;
}

static void* counted(void* block) {
  if (!block) return NULL;
  const int64_t size = (int64_t)malloc_usable_size(block);
  atomic_fetch_add(&live_blocks, 1);
  const int64_t now = atomic_fetch_add(&live_bytes, size) + size;
  int64_t peak = atomic_load(&peak_bytes);
  while (now > peak && !atomic_compare_exchange_weak(&peak_bytes, &peak, now)) {
  }
  return block;
}

static void uncount(void* block) {
  if (!block) return;
  atomic_fetch_sub(&live_blocks, 1);
  atomic_fetch_sub(&live_bytes, (int64_t)malloc_usable_size(block));
}

void* malloc(size_t size) { return refuses() ? NULL : counted(__libc_malloc(size)); }

void* calloc(size_t count, size_t size) { return refuses() ? NULL : counted(__libc_calloc(count, size)); }

void* realloc(void* block, size_t size) {
  if (refuses()) return NULL;
  const int64_t before = block ? (int64_t)malloc_usable_size(block) : 0;
  void* const moved = __libc_realloc(block, size);
  if (block && (moved || size == 0)) atomic_fetch_sub(&live_blocks, 1), atomic_fetch_sub(&live_bytes, before);
  return counted(moved);
}

void* memalign(size_t alignment, size_t size) {
  return refuses() ? NULL : counted(__libc_memalign(alignment, size));
}

void* aligned_alloc(size_t alignment, size_t size) { return memalign(alignment, size); }

int posix_memalign(void** block, size_t alignment, size_t size) {
  void* const made = memalign(alignment, size);
  if (!made) return ENOMEM;
  *block = made;
  return 0;
}

void free(void* block) {
  uncount(block);
  __libc_free(block);
}

int64_t allocations_live_blocks(void) { return atomic_load(&live_blocks); }
int64_t allocations_live_bytes(void) { return atomic_load(&live_bytes); }
int64_t allocations_peak_bytes(void) { return atomic_load(&peak_bytes); }
void allocations_mark_peak(void) { atomic_store(&peak_bytes, atomic_load(&live_bytes)); }

void allocations_fail(int64_t first, int ever) {
  atomic_store(&asked, 0);
  atomic_store(&first_to_fail, first);
  atomic_store(&fails_ever, ever);
  atomic_store(&armed, 1);
}

int64_t allocations_spare(void) {
  atomic_store(&armed, 0);
  return atomic_load(&asked);
}

static atomic_int was_armed;

void allocations_pause(void) { atomic_store(&was_armed, atomic_exchange(&armed, 0)); }
void allocations_resume(void) { atomic_store(&armed, atomic_load(&was_armed)); }

typedef int (*create_fn)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*);
static create_fn real_create;
static atomic_int_fast64_t threads_left = -1;

__attribute__((constructor)) static void find_real(void) {
  *(void**)&real_create = dlsym(RTLD_NEXT, "pthread_create");
}

void threads_fail_after(int64_t count) { atomic_store(&threads_left, count); }

int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*run)(void*), void* data) {
  const int64_t left = atomic_load(&threads_left);
  if (left == 0) return EAGAIN;
  if (left > 0) atomic_fetch_sub(&threads_left, 1);
  return real_create(thread, attributes, run, data);
}
