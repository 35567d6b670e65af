// Devices, names that lead elsewhere, names of any letters and length, and saves that are killed half-way.
#include <doctest/doctest.h>
#include <windows.h>

#include <cstdlib>
#include <string>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/file_calls.h"
#include "platform.h"
#include "temporary_folder.h"

using namespace focal;
using focal_test::filled, focal_test::status_of, focal_test::TemporaryFolder;
namespace fs = std::filesystem;

namespace {

HANDLE opened(const fs::path& path, DWORD share) {
  return ::CreateFileW(path.c_str(), GENERIC_READ, share, nullptr, OPEN_EXISTING, 0, nullptr);
}

// This program once more, in the test case that saves until it is killed.
HANDLE started_saver(const fs::path& file) {
  wchar_t program[1024];
  REQUIRE(::GetModuleFileNameW(nullptr, program, 1024) > 0);
  std::wstring line =
      L"\"" + std::wstring(program) + L"\" --no-skip \"--test-case=saves until it is killed\"";
  REQUIRE(::SetEnvironmentVariableW(L"FOCAL_SAVED_FILE", file.c_str()));
  STARTUPINFOW start{};
  start.cb = sizeof start;
  PROCESS_INFORMATION process{};
  REQUIRE(
      ::CreateProcessW(program, line.data(), nullptr, nullptr, FALSE, 0, nullptr, nullptr, &start, &process));
  ::CloseHandle(process.hThread);
  return process.hProcess;
}

constexpr size_t size_a = 400'000, size_b = 300'000;

}  // namespace

TEST_CASE("saves until it is killed" * doctest::skip()) {
  const wchar_t* const file = _wgetenv(L"FOCAL_SAVED_FILE");
  if (!file) return;
  for (;;) {
    write_file_atomically(file, filled(size_b, 'b'));
    write_file_atomically(file, filled(size_a, 'a'));
  }
}

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

TEST_CASE("names of any letters, with spaces, of any length") {
  const TemporaryFolder folder;
  fs::path deep = folder.path;
  while (deep.native().size() < 300) {
    deep /= fs::path(std::u8string(u8"ein Ordner für キャラクター 🦊"));
    REQUIRE(::CreateDirectoryW((L"\\\\?\\" + deep.native()).c_str(), nullptr));
  }
  const auto path = path_from_text(text_of(deep / std::u8string(u8"狐 und Füchse.bin")));
  REQUIRE(path);
  write_file_atomically(*path, filled(3, 'u'));
  CHECK(read_file(*path) == filled(3, 'u'));
  CHECK(read_file_inside(path->parent_path(), path->filename()) == filled(3, 'u'));
  CHECK(text_of(*path).find("\\\\?\\") == std::string::npos);
  CHECK(text_of(*path).ends_with(reinterpret_cast<const char*>(u8"狐 und Füchse.bin")));
  CHECK_FALSE(path_from_text("\xff\xfe"));
  fs::remove_all(L"\\\\?\\" + (folder.path / *std::next(path->begin(), std::distance(folder.path.begin(),
                                                                                     folder.path.end())))
                                  .native());
}

TEST_CASE("devices and folders are refused at once") {
  const TemporaryFolder folder;
  for (const char* name : {"NUL", "nul.txt", "CON", "COM1", "lpt1.bin", "\\\\.\\NUL", "\\\\.\\COM1"}) {
    CAPTURE(name);
    CHECK(status_of([&] { read_file(name); }) == Status::invalid_file);
    CHECK(status_of([&] { write_file_atomically(name, {}); }) == Status::invalid_argument);
    CHECK(status_of([&] { read_file(folder.path / name); }) == Status::invalid_file);
  }
  CHECK(status_of([&] { read_file(folder.path); }) == Status::invalid_file);
  CHECK(status_of([&] { read_file(folder.path / "nothing"); }) == Status::file_not_found);
  CHECK(status_of([&] { read_file(folder.path / "nothing" / "below"); }) == Status::file_not_found);
  CHECK(status_of([&] { read_file(std::string("a\0b", 3)); }) == Status::invalid_argument);
  CHECK(status_of([&] { read_file("Q:\\no\\drive"); }) == Status::file_not_found);
  CHECK(status_of([&] { write_file_atomically(folder.path, {}); }) == Status::invalid_argument);
  CHECK(status_of([&] { write_file_atomically(folder.path / "no" / "file", {}); }) == Status::file_not_found);
  CHECK(folder.entries() == 0);
}

TEST_CASE("a named file must stay inside the folder") {
  const TemporaryFolder folder;
  fs::create_directories(folder.path / "in" / "sub");
  write_file_atomically(folder.path / "secret", filled(1, 's'));
  write_file_atomically(folder.path / "in" / "sub" / "data", filled(1, 'd'));
  const auto status = [&](const fs::path& name) {
    return status_of([&] { read_file_inside(folder.path / "in", name); });
  };
  CHECK(read_file_inside(folder.path / "in", "sub/data") == filled(1, 'd'));
  CHECK(read_file_inside(folder.path / "in", "sub\\data") == filled(1, 'd'));
  for (const fs::path& name :
       {fs::path("../secret"), fs::path("..\\secret"), fs::path("sub/../../secret"),
        fs::path("/windows/win.ini"), fs::path("C:\\windows\\win.ini"), fs::path("C:secret"),
        fs::path("\\\\localhost\\c$\\windows\\win.ini"), fs::path("\\\\?\\C:\\windows\\win.ini"),
        fs::path("sub/data:stream"), fs::path("NUL"), fs::path("sub/com1.bin"), fs::path("sub"),
        folder.path / "secret", fs::path("sub/data."), fs::path("sub/.. /../secret")}) {
    CAPTURE(text_of(name));
    CHECK(status(name) == Status::invalid_file);
  }
  CHECK(status("none") == Status::file_not_found);
  CHECK(status("sub/data/below") == Status::file_not_found);
}

TEST_CASE("a write that fails leaves the old file and nothing else") {
  const TemporaryFolder folder;
  const fs::path path = folder.path / "file";
  write_file_atomically(path, filled(10, 'o'));
  const HANDLE reader = opened(path, FILE_SHARE_READ);  // as a program that does not share deletion
  REQUIRE(reader != INVALID_HANDLE_VALUE);
  CHECK(status_of([&] { write_file_atomically(path, filled(20, 'n')); }) == Status::io);
  ::CloseHandle(reader);
  CHECK(read_file(path) == filled(10, 'o'));
  CHECK(folder.entries() == 1);
  const HANDLE sharing = opened(path, FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE);
  CHECK(read_file(path) == filled(10, 'o'));  // a reader does not keep others from reading
  ::CloseHandle(sharing);
}

TEST_CASE("a save killed at any time leaves a whole file") {
  const TemporaryFolder folder;
  const fs::path path = folder.path / "file";
  const auto a = filled(size_a, 'a'), b = filled(size_b, 'b');
  int seen_b = 0;
  for (int round = 0; round < 60; ++round) {
    write_file_atomically(path, filled(1, 'x'));
    const HANDLE saver = started_saver(path);
    const auto is_first = [&] { return fs::file_size(path) == 1; };
    for (int wait = 0; wait < 10000 && is_first(); ++wait) ::Sleep(1);
    REQUIRE_FALSE(is_first());
    ::Sleep(static_cast<DWORD>(round % 8));
    ::TerminateProcess(saver, 1);
    ::WaitForSingleObject(saver, INFINITE);
    ::CloseHandle(saver);
    const auto now = read_file(path);
    CHECK((now == a || now == b));
    seen_b += now == b;
  }
  MESSAGE("60 kills, the other content found " << seen_b << " times");
}
