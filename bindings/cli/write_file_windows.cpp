// Whole files out: temporary file, write, FlushFileBuffers, move.
#include <windows.h>

#include <algorithm>
#include <system_error>

#include "command_error.h"
#include "paths.h"
#include "write_file.h"

namespace focal_cli {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail_writing(const std::string& path) {
  throw CommandError("cannot write '" + path + "' (Windows error " + std::to_string(::GetLastError()) + ")",
                     "check that the folder exists, may be written to and has room");
}

struct OpenFile {
  HANDLE handle;
  explicit OpenFile(HANDLE h) : handle(h) {}
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  ~OpenFile() { close(); }
  bool valid() const { return handle != INVALID_HANDLE_VALUE; }
  void close() {
    if (valid()) ::CloseHandle(handle);
    handle = INVALID_HANDLE_VALUE;
  }
};

// Removed unless it has been moved.
struct TemporaryFile {
  fs::path path;
  bool kept = false;
  ~TemporaryFile() {
    if (!kept) ::DeleteFileW(path.c_str());
  }
};

OpenFile opened(const fs::path& path, DWORD how) {
  return OpenFile(::CreateFileW(path.c_str(), GENERIC_WRITE, FILE_SHARE_READ, nullptr, how,
                                FILE_ATTRIBUTE_NORMAL, nullptr));
}

void write_all(HANDLE file, std::string_view bytes, const std::string& path) {
  while (!bytes.empty()) {
    constexpr size_t chunk = size_t{1} << 30;
    DWORD written = 0;
    if (!::WriteFile(file, bytes.data(), static_cast<DWORD>(std::min(bytes.size(), chunk)), &written,
                     nullptr))
      fail_writing(path);
    bytes.remove_prefix(written);
  }
}

// NUL, CON, COM1, a pipe: opened, as nothing is lost by that, and asked what it is.
bool is_device(const fs::path& path) {
  const OpenFile file(::CreateFileW(path.c_str(), GENERIC_WRITE, FILE_SHARE_READ | FILE_SHARE_WRITE, nullptr,
                                    OPEN_EXISTING, 0, nullptr));
  return file.valid() && ::GetFileType(file.handle) != FILE_TYPE_DISK;
}

}  // namespace

void write_file_atomically(const std::string& path, std::string_view bytes) {
  const fs::path target = path_of(path);
  if (is_device(target)) {
    const OpenFile device = opened(target, OPEN_EXISTING);
    if (!device.valid()) fail_writing(path);
    return write_all(device.handle, bytes, path);
  }
  // Through a link the file it names is replaced, not the link.
  std::error_code code;
  const fs::path real = fs::is_symlink(target, code) ? fs::canonical(target, code) : target;
  TemporaryFile temporary{real};
  temporary.path += L"." + std::to_wstring(::GetCurrentProcessId()) + L".tmp";
  {
    OpenFile file = opened(temporary.path, CREATE_NEW);
    if (!file.valid()) {
      temporary.kept = true;  // nothing was made, so there is nothing to remove
      fail_writing(path);
    }
    write_all(file.handle, bytes, path);
    if (!::FlushFileBuffers(file.handle)) fail_writing(path);
  }
  if (!::MoveFileExW(temporary.path.c_str(), real.c_str(),
                     MOVEFILE_REPLACE_EXISTING | MOVEFILE_WRITE_THROUGH))
    fail_writing(path);
  temporary.kept = true;
}

}  // namespace focal_cli
