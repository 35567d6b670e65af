// Every allocation inside the shared library comes through here, those of the C++ runtime and of Eigen too: the linker
// puts __wrap_X in the place of X (CMakeLists.txt). So what is held is known to the byte, and a budget is kept by refusing memory, which
// every call bears (tests/faults).
#if defined(FOCAL_COUNTS_MEMORY)
#include <malloc.h>

#include <cerrno>
#include <cstddef>

#include "base/memory_budget.h"

extern "C" {

void* __real_malloc(size_t size);
void* __real_calloc(size_t count, size_t size);
void* __real_realloc(void* block, size_t size);
#if !defined(_WIN32)
void* __real_memalign(size_t alignment, size_t size);
#endif
void __real_free(void* block);

}  // extern "C"

namespace {

#if defined(_WIN32)
int64_t bytes_of(void* block) { return static_cast<int64_t>(_msize(block)); }
#else
int64_t bytes_of(void* block) { return static_cast<int64_t>(malloc_usable_size(block)); }
#endif

// Asked for before it is there, so that the budget is not exceeded for a moment either.
template <class Allocate>
void* taken(size_t size, Allocate&& allocate) {
  const auto asked = static_cast<int64_t>(size);
  if (asked < 0 || !focal::take_memory(asked)) {
    errno = ENOMEM;
    return nullptr;
  }
  void* const block = allocate();
  focal::give_memory(asked - (block ? bytes_of(block) : 0));  // it may be a little larger
  return block;
}

}  // namespace

extern "C" {

void* __wrap_malloc(size_t size) {
  return taken(size, [&] { return __real_malloc(size); });
}

void* __wrap_calloc(size_t count, size_t size) {
  size_t bytes = 0;
  if (__builtin_mul_overflow(count, size, &bytes)) bytes = SIZE_MAX;
  return taken(bytes, [&] { return __real_calloc(count, size); });
}

#if !defined(_WIN32)  // there, aligned blocks have functions and a free of their own, which stay uncounted
void* __wrap_memalign(size_t alignment, size_t size) {
  return taken(size, [&] { return __real_memalign(alignment, size); });
}

void* __wrap_aligned_alloc(size_t alignment, size_t size) { return __wrap_memalign(alignment, size); }

int __wrap_posix_memalign(void** block, size_t alignment, size_t size) {
  void* const made = __wrap_memalign(alignment, size);
  if (!made) return ENOMEM;
  *block = made;
  return 0;
}
#endif

void __wrap_free(void* block) {
  if (!block) return;
  focal::give_memory(bytes_of(block));
  __real_free(block);
}

// A block that grows is asked for before it is moved, as it cannot be moved back.
void* __wrap_realloc(void* block, size_t size) {
  if (!block) return __wrap_malloc(size);
  const int64_t before = bytes_of(block), growth = static_cast<int64_t>(size) - before;
  if (growth > 0 && !focal::take_memory(growth)) {
    errno = ENOMEM;
    return nullptr;
  }
  void* const moved = __real_realloc(block, size);
  const int64_t after = moved ? bytes_of(moved) : size == 0 ? 0 : before;
  focal::give_memory(before + (growth > 0 ? growth : 0) - after);
  return moved;
}

}  // extern "C"
#endif

// What the C++ runtime inside the library keeps for good, given back when the library is unloaded: its reserve for
// exceptions when there is no memory, 73 KB, which a host that loads and unloads the library would lose each time.
#if defined(FOCAL_STATIC_RUNTIME)

namespace __gnu_cxx {
void __freeres();  // of libstdc++, for tools that look for leaks
}

namespace {

[[gnu::destructor]] void give_reserve_back() { __gnu_cxx::__freeres(); }

}  // namespace

#endif
