// Files are written whole or not at all.
#include <doctest/doctest.h>

#include "files.h"
#include "scratch_folder.h"

using namespace focal_cli;

TEST_CASE("a file is replaced as a whole and leaves nothing beside it") {
  const ScratchFolder scratch;
  const std::string path = scratch.write("a.txt", "old");
  write_file_atomically(path, "new and longer");
  CHECK(read_text_file(path) == "new and longer");
  CHECK(std::distance(std::filesystem::directory_iterator(scratch.path), {}) == 1);
}

TEST_CASE("a device is written to, not replaced") {
  write_file_atomically("NUL", "gone");
  CHECK_FALSE(std::filesystem::is_regular_file("NUL"));
}
