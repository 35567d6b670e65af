// What the operating system is asked for, besides files and libraries. All text is UTF-8.
//
// Uses strings and system calls instead of std::filesystem, whose paths and iterators terminate the process
// when an allocation fails.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace focal {

// Of the process so far; 0 where the system does not report it.
uint64_t peak_memory_bytes();

std::string environment_variable(const char* name);  // empty: not set
// Between the folders of a list such as PATH.
extern const char list_separator;

bool is_regular_file(const std::string& path);
// Their names, in no order. A folder that is missing or unreadable holds none.
std::vector<std::string> regular_files_in(const std::string& folder);

}  // namespace focal
