// Files are written whole or not at all.
#include <doctest/doctest.h>
#include <sys/stat.h>

#include "files.h"
#include "scratch_folder.h"

using namespace focal_cli;

TEST_CASE("a file is replaced as a whole, keeps its permissions and leaves nothing beside it") {
  const ScratchFolder scratch;
  const std::string path = scratch.write("a.txt", "old");
  ::chmod(path.c_str(), 0640);
  write_file_atomically(path, "new and longer");
  CHECK(read_text_file(path) == "new and longer");
  struct stat status;
  REQUIRE(::stat(path.c_str(), &status) == 0);
  CHECK((status.st_mode & 0777) == 0640);
  CHECK(std::distance(std::filesystem::directory_iterator(scratch.path), {}) == 1);
}

TEST_CASE("through a link the file it names is written") {
  const ScratchFolder scratch;
  const std::string path = scratch.write("real.txt", "old");
  std::filesystem::create_symlink("real.txt", scratch / "link.txt");
  write_file_atomically(scratch / "link.txt", "new");
  CHECK(read_text_file(path) == "new");
  CHECK(std::filesystem::is_symlink(scratch / "link.txt"));
}

TEST_CASE("a device is written to, not replaced") {
  write_file_atomically("/dev/null", "gone");
  CHECK(std::filesystem::is_character_file("/dev/null"));
}
