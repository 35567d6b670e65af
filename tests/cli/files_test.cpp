// Names of files, and files that cannot be read or written.
#include "files.h"

#include <doctest/doctest.h>

#include "command_error.h"
#include "paths.h"
#include "scratch_folder.h"

using namespace focal_cli;

TEST_CASE("names are UTF-8") {
  const ScratchFolder scratch;
  const std::string path = scratch / "x" + reinterpret_cast<const char*>(u8"狐 und Füchse.json");
  write_file_atomically(path, "{}");
  CHECK(read_text_file(path) == "{}");
  CHECK(std::filesystem::exists(path_of(path)));
  CHECK(text_of(path_of(path)) == path);
}

TEST_CASE("what cannot be written or read says so, with a hint") {
  const ScratchFolder scratch;
  CHECK_THROWS_AS(write_file_atomically(scratch / "missing/a.txt", "x"), CommandError);
  CHECK_THROWS_AS(read_text_file(scratch / "missing.txt"), CommandError);
  CHECK_THROWS_AS(read_text_file(scratch.path.string()), CommandError);
  CHECK(read_text_file(scratch.write("empty.txt", "")).empty());
}
