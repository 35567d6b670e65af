#include "boundary.h"

#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <cstring>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

#include "base/error.h"

namespace focal {
namespace {

// A plain array: setting it needs no memory, and a thread that ends has nothing to destroy.
thread_local char error_text[2048] = "";

void set_last_error(std::string_view message, std::string_view hint) noexcept {
  constexpr std::string_view separator = "\nhint: ";
  constexpr size_t capacity = sizeof error_text - 1;
  size_t size = 0;
  const auto append = [&](std::string_view text, size_t limit) {
    size_t count = std::min(text.size(), limit - size);
    // Never cut inside a UTF-8 character.
    while (count > 0 && count < text.size() && (text[count] & 0xC0) == 0x80) --count;
    std::memcpy(error_text + size, text.data(), count);
    size += count;
  };
  // The hint is kept whole as far as it can be: a message may quote a long path, a hint never does.
  append(message, capacity - std::min(separator.size() + hint.size(), capacity / 2));
  append(separator, capacity);
  append(hint, capacity);
  error_text[size] = '\0';
}

// Whole megabytes, up: the numbers are for a person, and the host's locale has no part in them.
int64_t megabytes(int64_t bytes) { return (bytes + (1 << 20) - 1) >> 20; }

void set_out_of_memory() noexcept {
  const MemoryBudget* const budget = memory_budget();
  const int64_t asked = budget ? budget->asked.exchange(0) : 0;
  if (asked == 0)
    return set_last_error("out of memory", "close other programs, or use a mesh with fewer vertices");
  char message[200];
  std::snprintf(message, sizeof message,
                "the memory budget of %" PRId64 " bytes is too small: %" PRId64 " are held, %" PRId64
                " more are needed here",
                budget->limit, budget->held.load(), asked);
  char hint[200];
  std::snprintf(hint, sizeof hint,
                "raise focal_context_params.memory_budget_bytes to well over %" PRId64
                " MB, destroy handles that you do not need, or use a mesh with fewer vertices",
                megabytes(budget->held + asked));
  set_last_error(message, hint);
}

}  // namespace

DefaultFloatEnvironment::DefaultFloatEnvironment() noexcept {
  std::fegetenv(&host_);
  std::fesetenv(FE_DFL_ENV);
#if defined(__SSE2__)
  _mm_setcsr(0x1F80);  // FE_DFL_ENV does not promise to clear flush-to-zero and denormals-are-zero
#endif
}

DefaultFloatEnvironment::~DefaultFloatEnvironment() { std::fesetenv(&host_); }

focal_status record_current_exception() noexcept {
  try {
    throw;
  } catch (const Error& error) {
    set_last_error(error.what(), error.hint());
    return static_cast<focal_status>(error.status());
  } catch (const std::bad_alloc&) {
    set_out_of_memory();
    return FOCAL_ERROR_OUT_OF_MEMORY;
  } catch (const std::length_error&) {
    set_last_error("out of memory: a size beyond any memory", "use a mesh with fewer vertices");
    return FOCAL_ERROR_OUT_OF_MEMORY;
  } catch (const std::exception& error) {
    set_last_error(error.what(), "this is a mistake of focal: please report it with the mesh");
    return FOCAL_ERROR_INTERNAL;
  } catch (...) {
    set_last_error("an exception of unknown type", "does a callback of the host throw? It must not");
    return FOCAL_ERROR_INTERNAL;
  }
}

const char* last_error() noexcept { return error_text; }

}  // namespace focal
