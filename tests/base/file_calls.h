// What the tests of files on every platform share.
#pragma once
#include <doctest/doctest.h>

#include <cstddef>
#include <vector>

#include "base/error.h"

namespace focal_test {

inline std::vector<std::byte> filled(size_t size, char c) {
  return std::vector<std::byte>(size, std::byte(c));
}

template <class Call>
focal::Status status_of(Call&& call) {
  try {
    call();
    return focal::Status::ok;
  } catch (const focal::Error& error) {
    CHECK_FALSE(error.hint().empty());
    return error.status();
  }
}

}  // namespace focal_test
