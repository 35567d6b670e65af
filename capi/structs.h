// Structs that grow: every one begins with struct_size, the size its caller was compiled with.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>

#include "arguments.h"
#include "base/error.h"
#include "boundary.h"
#include "mesh/rig.h"

namespace focal {

// No struct will ever be this large, so a struct_size above it comes from memory that was never initialised.
inline constexpr size_t largest_struct = 4096;

// What a caller must know of each struct. `first_size` is its size in the first release and stays.
// Static members: const char* name; size_t first_size; T defaults().
template <class T>
struct StructTraits;

// At global scope, before the struct is read or written: its traits and the function that fills it with its defaults.
#define FOCAL_STRUCT_WITH_DEFAULTS(type, size, make_defaults)               \
  template <>                                                               \
  struct focal::StructTraits<type> {                                        \
    static constexpr const char* name = #type;                              \
    static constexpr size_t first_size = size;                              \
    static type defaults() { return make_defaults(); }                      \
  };                                                                        \
  focal_status type##_init(type* given, size_t struct_size) {               \
    return focal::guarded([&] { focal::init_struct(given, struct_size); }); \
  }                                                                         \
  static_assert(std::is_trivially_copyable_v<type> && offsetof(type, struct_size) == 0)
// One whose defaults are 0.
#define FOCAL_STRUCT(type, size) FOCAL_STRUCT_WITH_DEFAULTS(type, size, type)

// Of structs that are 0 but for this field.
template <class T>
T with_max_influences() {
  T params{};
  params.max_influences = max_influences;
  return params;
}

template <class T>
void check_struct_size(size_t size) {
  if (size >= StructTraits<T>::first_size && size <= largest_struct) return;
  const std::string name = StructTraits<T>::name;
  throw Error(Status::invalid_argument,
              name + ".struct_size is " + std::to_string(size) + ", at least " +
                  std::to_string(StructTraits<T>::first_size) + " expected",
              "fill the struct with " + name + "_init(&it, sizeof it) first");
}

template <class T>
void require_struct(const T* given) {
  if (!given)
    throw Error(Status::invalid_argument, std::string("the ") + StructTraits<T>::name + " is NULL",
                "pass the address of a struct");
}

template <class T>
void write_struct(T* given, size_t size, const T& value) {
  auto* bytes = reinterpret_cast<unsigned char*>(given);
  const size_t known = std::min(size, sizeof(T));
  std::memcpy(bytes, &value, known);
  std::memset(bytes + known, 0, size - known);
  given->struct_size = static_cast<uint32_t>(size);
}

// *_init.
template <class T>
void init_struct(T* given, size_t size) {
  require_struct(given);
  check_struct_size<T>(size);
  write_struct(given, size, StructTraits<T>::defaults());
}

// Parameters: NULL gives the defaults, and so do fields that an older caller does not have.
template <class T>
T read_struct(const T* given) {
  T value = StructTraits<T>::defaults();
  if (!given) return value;
  const size_t size = given->struct_size;
  check_struct_size<T>(size);
  const auto* bytes = reinterpret_cast<const unsigned char*>(given);
  const auto is_set = [](unsigned char byte) { return byte != 0; };
  if (size > sizeof(T) && std::any_of(bytes + sizeof(T), bytes + size, is_set))
    throw Error(Status::unsupported,
                std::string(StructTraits<T>::name) + " sets a field this library does not know",
                "use a newer library, or leave the new fields 0");
  std::memcpy(&value, bytes, std::min(size, sizeof(T)));
  return value;
}

// Results: fills what the caller has room for; looked at first where the result takes long.
template <class T>
void check_result(const T* out) {
  require_struct(out);
  check_struct_size<T>(out->struct_size);
}
template <class T>
void write_result(T* out, const T& value) {
  check_result(out);
  write_struct(out, out->struct_size, value);
}

}  // namespace focal
