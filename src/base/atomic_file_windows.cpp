// Reads and writes whole files. Writing: temporary file in the same folder, write, FlushFileBuffers, and a move over the target that
// returns when it is on the disk.
#include <windows.h>

#include <algorithm>
#include <atomic>
#include <new>
#include <string>
#include <utility>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/reserved_names.h"
#include "base/text_windows.h"

namespace focal {
namespace {

namespace fs = std::filesystem;

class Handle {
 public:
  explicit Handle(HANDLE handle = INVALID_HANDLE_VALUE) : handle_(handle) {}
  Handle(Handle&& other) noexcept : handle_(std::exchange(other.handle_, INVALID_HANDLE_VALUE)) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(handle_, other.handle_);
    return *this;
  }
  ~Handle() { close(); }
  HANDLE get() const { return handle_; }
  bool valid() const { return handle_ != INVALID_HANDLE_VALUE; }
  bool close() { return !valid() || ::CloseHandle(std::exchange(handle_, INVALID_HANDLE_VALUE)); }

 private:
  HANDLE handle_;
};

std::string quoted(const fs::path& path) { return "'" + text_of(path) + "'"; }

[[noreturn]] void fail(const std::string& doing, const fs::path& path, DWORD error) {
  if (error == ERROR_NOT_ENOUGH_MEMORY || error == ERROR_OUTOFMEMORY) throw std::bad_alloc();
  const std::string message = doing + " " + quoted(path) + ": " + system_message(error);
  constexpr DWORD absent[] = {ERROR_FILE_NOT_FOUND, ERROR_PATH_NOT_FOUND, ERROR_INVALID_NAME,
                              ERROR_BAD_NETPATH,    ERROR_BAD_NET_NAME,   ERROR_FILENAME_EXCED_RANGE,
                              ERROR_DIRECTORY};
  if (std::find(std::begin(absent), std::end(absent), error) != std::end(absent))
    throw Error(Status::file_not_found, message, "check the path and the folder the program runs in");
  throw Error(Status::io, message, "check permissions and free space");
}

[[noreturn]] void fail_not_regular(const fs::path& path, Status status) {
  throw Error(status, quoted(path) + " is a folder, pipe or device", "pass the path of a regular file");
}

// Windows opens the device for NUL, COM1, nul.txt and the like, in any folder. `status` is for such a name.
void require_plain_name(const fs::path& path, Status status) {
  if (path.empty() || path.native().find(L'\0') != std::wstring::npos)
    throw Error(Status::invalid_argument, "the file name is empty or holds a NUL byte", "pass a file name");
  if (path.native().starts_with(L"\\\\.\\") || is_device_name(path.filename().wstring()))
    fail_not_regular(path, status);
}

bool is_folder(const fs::path& path) {
  const DWORD attributes = ::GetFileAttributesW(any_length(path.native()).c_str());
  return attributes != INVALID_FILE_ATTRIBUTES && (attributes & FILE_ATTRIBUTE_DIRECTORY);
}

constexpr DWORD share_all = FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE;

Handle open_existing(const fs::path& path, DWORD access, DWORD share, DWORD flags) {
  return Handle(::CreateFileW(any_length(path.native()).c_str(), access, share, nullptr, OPEN_EXISTING, flags,
                              nullptr));
}

// A symbolic link or a junction; a file of a cloud folder is a reparse point too, but stands for itself.
bool is_link(const Handle& file) {
  FILE_ATTRIBUTE_TAG_INFO info{};
  return ::GetFileInformationByHandleEx(file.get(), FileAttributeTagInfo, &info, sizeof info) &&
         (info.FileAttributes & FILE_ATTRIBUTE_REPARSE_POINT) && IsReparseTagNameSurrogate(info.ReparseTag);
}

std::vector<std::byte> read_all(const Handle& file, const fs::path& path, int64_t size_limit) {
  if (::GetFileType(file.get()) != FILE_TYPE_DISK) fail_not_regular(path, Status::invalid_file);
  const auto too_large = [&] {
    return Error(Status::unsupported,
                 quoted(path) + " is larger than " + std::to_string(size_limit) + " bytes",
                 "reduce the file or raise the size limit");
  };
  LARGE_INTEGER size{};
  if (!::GetFileSizeEx(file.get(), &size)) fail("cannot examine", path, ::GetLastError());
  if (size.QuadPart > size_limit) throw too_large();
  // One byte more than the reported size, so that the end of file is detected without growing.
  std::vector<std::byte> bytes(static_cast<size_t>(size.QuadPart) + 1);
  size_t filled = 0;
  for (;;) {
    constexpr size_t chunk = size_t{1} << 30;
    DWORD got = 0;
    if (!::ReadFile(file.get(), bytes.data() + filled,
                    static_cast<DWORD>(std::min(bytes.size() - filled, chunk)), &got, nullptr))
      fail("cannot read", path, ::GetLastError());
    if (got == 0) break;
    filled += got;
    if (static_cast<int64_t>(filled) > size_limit) throw too_large();
    if (filled == bytes.size()) bytes.resize(2 * filled);
  }
  bytes.resize(filled);
  return bytes;
}

// A temporary file that is deleted unless it was moved to its final name.
class TemporaryFile {
 public:
  explicit TemporaryFile(const fs::path& folder) {
    static std::atomic<uint32_t> counter{0};
    for (int attempt = 0; attempt < 100; ++attempt) {
      path_ = folder / (L".focal-" + std::to_wstring(::GetCurrentProcessId()) + L"-" +
                        std::to_wstring(counter++) + L".tmp");
      name_ = any_length(path_.native());
      file_ = Handle(::CreateFileW(name_.c_str(), GENERIC_WRITE, 0, nullptr, CREATE_NEW,
                                   FILE_ATTRIBUTE_NORMAL, nullptr));
      if (file_.valid()) return;
      if (::GetLastError() != ERROR_FILE_EXISTS) break;
    }
    fail("cannot create", path_, ::GetLastError());
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    file_.close();
    if (!moved_) ::DeleteFileW(name_.c_str());
  }

  void write_and_sync(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
      constexpr size_t chunk = size_t{1} << 30;
      DWORD written = 0;
      if (!::WriteFile(file_.get(), bytes.data(), static_cast<DWORD>(std::min(bytes.size(), chunk)), &written,
                       nullptr))
        fail("cannot write", path_, ::GetLastError());
      if (written == 0) fail("cannot write", path_, ERROR_DISK_FULL);
      bytes = bytes.subspan(written);
    }
    if (!::FlushFileBuffers(file_.get())) fail("cannot flush", path_, ::GetLastError());
    if (!file_.close()) fail("cannot close", path_, ::GetLastError());
  }

  // Virus scanners and indexers hold a new file, or the old one, open for a moment.
  void move_to(const fs::path& target) {
    const std::wstring to = any_length(target.native());
    for (int attempt = 0;; ++attempt) {
      if (::MoveFileExW(name_.c_str(), to.c_str(), MOVEFILE_REPLACE_EXISTING | MOVEFILE_WRITE_THROUGH)) break;
      const DWORD error = ::GetLastError();
      if ((error != ERROR_SHARING_VIOLATION && error != ERROR_ACCESS_DENIED) || attempt >= 20)
        fail("cannot replace", target, error);
      ::Sleep(10);
    }
    moved_ = true;
  }

 private:
  fs::path path_;
  std::wstring name_;
  Handle file_;
  bool moved_ = false;
};

// The file that a link leads to, so that the link stays; else the path itself.
fs::path behind_link(const fs::path& path) {
  const Handle link = open_existing(path, FILE_READ_ATTRIBUTES, share_all,
                                    FILE_FLAG_BACKUP_SEMANTICS | FILE_FLAG_OPEN_REPARSE_POINT);
  if (!link.valid() || !is_link(link)) return path;
  const Handle file = open_existing(path, FILE_READ_ATTRIBUTES, share_all, FILE_FLAG_BACKUP_SEMANTICS);
  if (!file.valid()) fail("cannot follow", path, ::GetLastError());
  std::wstring target(::GetFinalPathNameByHandleW(file.get(), nullptr, 0, 0), L'\0');
  target.resize(::GetFinalPathNameByHandleW(file.get(), target.data(), static_cast<DWORD>(target.size()), 0));
  if (target.empty()) fail("cannot follow", path, ::GetLastError());
  return target;
}

}  // namespace

std::string text_of(const fs::path& path) { return utf8_text(shown_path(path.native())); }

std::optional<fs::path> path_from_text(std::string_view text) {
  try {
    return fs::path(any_length(wide_text(text)));
  } catch (const Error&) {
    return std::nullopt;
  }
}

std::vector<std::byte> read_file(const fs::path& path, int64_t size_limit) {
  require_plain_name(path, Status::invalid_file);
  if (is_folder(path)) fail_not_regular(path, Status::invalid_file);
  const Handle file = open_existing(path, GENERIC_READ, share_all, 0);
  if (!file.valid()) fail("cannot open", path, ::GetLastError());
  return read_all(file, path, size_limit);
}

std::vector<std::byte> read_file_inside(const fs::path& folder, const fs::path& relative,
                                        int64_t size_limit) {
  require_plain_name(relative, Status::invalid_file);
  if (!is_plain_relative_path(relative.native()))
    throw Error(Status::invalid_file, quoted(relative) + " leads out of the file's folder",
                "keep referenced files beside the file that names them");
  const fs::path start = folder.empty() ? fs::path(L".") : folder;
  if (!is_folder(start)) fail("cannot open", start, ERROR_PATH_NOT_FOUND);
  // Folders stay open, and not shared for deletion, until the file is open: nobody can put a link in their place.
  std::vector<Handle> folders;
  fs::path at = start;
  for (auto part = relative.begin(); part != relative.end(); ++part) {
    at /= *part;
    const bool last = std::next(part) == relative.end();
    constexpr DWORD flags = FILE_FLAG_OPEN_REPARSE_POINT | FILE_FLAG_BACKUP_SEMANTICS;
    folders.push_back(open_existing(at, last ? GENERIC_READ : DWORD{FILE_LIST_DIRECTORY},
                                    FILE_SHARE_READ | FILE_SHARE_WRITE, flags));
    if (!folders.back().valid()) fail("cannot open", relative, ::GetLastError());
    if (is_link(folders.back()))
      throw Error(Status::invalid_file, quoted(relative) + " goes through a symbolic link",
                  "replace the link by the file itself");
    if (!last && !is_folder(at)) fail("cannot open", relative, ERROR_PATH_NOT_FOUND);
  }
  if (is_folder(at)) fail_not_regular(relative, Status::invalid_file);
  // Again without the flag, for files whose content a file system filter brings.
  const Handle file = open_existing(at, GENERIC_READ, share_all, 0);
  if (!file.valid()) fail("cannot open", relative, ::GetLastError());
  return read_all(file, relative, size_limit);
}

void write_file_atomically(const fs::path& path, std::span<const std::byte> bytes) {
  require_plain_name(path, Status::invalid_argument);
  if (is_folder(path) || !path.has_filename()) fail_not_regular(path, Status::invalid_argument);
  const fs::path target = behind_link(path);
  TemporaryFile temporary(target.has_parent_path() ? target.parent_path() : fs::path(L"."));
  temporary.write_and_sync(bytes);
  temporary.move_to(target);
}

}  // namespace focal
