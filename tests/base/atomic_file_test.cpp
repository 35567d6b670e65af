// Files that must not block, links that must not be followed, and saves that are killed half-way.
#include "base/atomic_file.h"

#include <doctest/doctest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <string>

#include "base/error.h"
#include "base/file_calls.h"
#include "temporary_folder.h"

using namespace focal;
using focal_test::filled, focal_test::status_of, focal_test::TemporaryFolder;
namespace fs = std::filesystem;

TEST_CASE("what is written is read, and replaces what was there") {
  const TemporaryFolder folder;
  const fs::path path = folder.path / "file";
  for (const size_t size : {size_t{5000}, size_t{0}, size_t{3'000'000}, size_t{1}}) {
    write_file_atomically(path, filled(size, 'x'));
    CHECK(read_file(path) == filled(size, 'x'));
  }
  CHECK(folder.entries() == 1);
  CHECK(status_of([&] { read_file(path, 0); }) == Status::unsupported);
  CHECK(read_file(path, 1).size() == 1);
}

TEST_CASE("a link stays a link, and permissions stay") {
  const TemporaryFolder folder;
  const fs::path target = folder.path / "target", link = folder.path / "link";
  write_file_atomically(target, filled(1, 'a'));
  fs::permissions(target, fs::perms(0640));
  fs::create_symlink(target, link);
  write_file_atomically(link, filled(2, 'b'));
  CHECK(fs::is_symlink(link));
  CHECK(read_file(target) == filled(2, 'b'));
  CHECK((fs::status(target).permissions() & fs::perms::mask) == fs::perms(0640));
}

TEST_CASE("pipes, devices and folders are refused at once") {
  const TemporaryFolder folder;
  const fs::path pipe = folder.path / "pipe";
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  CHECK(status_of([&] { read_file(pipe); }) == Status::invalid_file);
  CHECK(status_of([&] { read_file("/dev/zero"); }) == Status::invalid_file);
  CHECK(status_of([&] { read_file(folder.path); }) == Status::invalid_file);
  CHECK(status_of([&] { read_file(folder.path / "nothing"); }) == Status::file_not_found);
  CHECK(status_of([&] { read_file(folder.path / "pipe" / "below"); }) == Status::file_not_found);
  CHECK(status_of([&] { read_file(std::string("a\0b", 3)); }) == Status::invalid_argument);
  CHECK(status_of([&] { write_file_atomically(pipe, {}); }) == Status::invalid_argument);
  CHECK(status_of([&] { write_file_atomically("/dev/null", {}); }) == Status::invalid_argument);
  CHECK(status_of([&] { write_file_atomically(folder.path, {}); }) == Status::invalid_argument);
  CHECK(status_of([&] { write_file_atomically(folder.path / "no" / "file", {}); }) == Status::file_not_found);
  CHECK(folder.entries() == 1);
}

TEST_CASE("a named file must stay inside the folder") {
  const TemporaryFolder folder;
  fs::create_directories(folder.path / "in" / "sub");
  write_file_atomically(folder.path / "secret", filled(1, 's'));
  write_file_atomically(folder.path / "in" / "sub" / "data", filled(1, 'd'));
  fs::create_symlink("../secret", folder.path / "in" / "link");
  fs::create_directory_symlink("..", folder.path / "in" / "up");
  REQUIRE(::mkfifo((folder.path / "in" / "pipe").c_str(), 0600) == 0);
  const auto status = [&](const char* name) {
    return status_of([&] { read_file_inside(folder.path / "in", name); });
  };
  CHECK(read_file_inside(folder.path / "in", "sub/data") == filled(1, 'd'));
  CHECK(status("../secret") == Status::invalid_file);
  CHECK(status("sub/../../secret") == Status::invalid_file);
  CHECK(status("/etc/passwd") == Status::invalid_file);
  CHECK(status("link") == Status::invalid_file);
  CHECK(status("up/secret") != Status::ok);
  CHECK(status("pipe") == Status::invalid_file);
  CHECK(status("sub") == Status::invalid_file);
  CHECK(status("none") == Status::file_not_found);
}

TEST_CASE("a write that fails leaves the old file and nothing else") {
  const TemporaryFolder folder;
  const fs::path path = folder.path / "file";
  write_file_atomically(path, filled(10, 'o'));
  const pid_t child = ::fork();
  if (child == 0) {  // the limit is for the process, so it is set in one of its own
    ::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{100'000, 100'000};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    int code = 1;
    try {
      write_file_atomically(path, filled(200'000, 'n'));
    } catch (const Error& error) {
      code = error.status() == Status::io ? 0 : 2;
    }
    ::_exit(code);
  }
  int result = -1;
  ::waitpid(child, &result, 0);
  CHECK(WIFEXITED(result));
  CHECK(WEXITSTATUS(result) == 0);
  CHECK(read_file(path) == filled(10, 'o'));
  CHECK(folder.entries() == 1);
}

TEST_CASE("a save killed at any time leaves a whole file") {
  const TemporaryFolder folder;
  const fs::path path = folder.path / "file";
  const auto a = filled(400'000, 'a'), b = filled(300'000, 'b');
  write_file_atomically(path, a);
  int seen_b = 0;
  for (int round = 0; round < 60; ++round) {
    const pid_t child = ::fork();
    if (child == 0)
      for (;;) {
        write_file_atomically(path, b);
        write_file_atomically(path, a);
      }
    ::usleep(static_cast<useconds_t>(500 + 137 * round));
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    const auto now = read_file(path);
    CHECK((now == a || now == b));
    seen_b += now == b;
  }
  MESSAGE("60 kills, the other content found " << seen_b << " times");
}
