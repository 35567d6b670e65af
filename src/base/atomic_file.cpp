// Reads and writes whole files. Writing is the usual safe sequence: temporary file in the same folder, write,
// fsync, rename, fsync of the folder.
#include "base/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <new>
#include <string>
#include <system_error>
#include <utility>

#include "base/error.h"

namespace focal {
namespace {

namespace fs = std::filesystem;

class FileDescriptor {
 public:
  explicit FileDescriptor(int fd) : fd_(fd) {}
  FileDescriptor(FileDescriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  FileDescriptor& operator=(FileDescriptor&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  ~FileDescriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  int get() const { return fd_; }
  bool valid() const { return fd_ >= 0; }
  int close() { return ::close(std::exchange(fd_, -1)); }

 private:
  int fd_;
};

// Repeats a system call that a signal interrupted.
template <class Call>
auto uninterrupted(Call&& call) {
  for (;;)
    if (const auto result = call(); result >= 0 || errno != EINTR) return result;
}

std::string quoted(const fs::path& path) { return "'" + path.string() + "'"; }

[[noreturn]] void fail(const std::string& doing, const fs::path& path, int error) {
  if (error == ENOMEM) throw std::bad_alloc();
  const std::string message = doing + " " + quoted(path) + ": " + std::generic_category().message(error);
  if (error == ENOENT || error == ENOTDIR)
    throw Error(Status::file_not_found, message, "check the path and the folder the program runs in");
  throw Error(Status::io, message, "check permissions and free space");
}

// A C string ends at the first NUL, so a name with a NUL would open another file than the one it shows.
void require_plain_name(const fs::path& path) {
  if (path.empty() || path.native().find('\0') != std::string::npos)
    throw Error(Status::invalid_argument, "the file name is empty or holds a NUL byte", "pass a file name");
}

std::vector<std::byte> read_all(const FileDescriptor& file, const fs::path& path, int64_t size_limit) {
  struct stat info {};
  if (::fstat(file.get(), &info) != 0) fail("cannot examine", path, errno);
  if (!S_ISREG(info.st_mode))
    throw Error(Status::invalid_file, quoted(path) + " is a folder, pipe or device",
                "pass the path of a regular file");
  const auto too_large = [&] {
    return Error(Status::unsupported,
                 quoted(path) + " is larger than " + std::to_string(size_limit) + " bytes",
                 "reduce the file or raise the size limit");
  };
  if (info.st_size > size_limit) throw too_large();
  // One byte more than the reported size, so that the end of file is detected without growing; the size may
  // also be wrong (/proc).
  std::vector<std::byte> bytes(static_cast<size_t>(info.st_size) + 1);
  size_t filled = 0;
  for (;;) {
    const ssize_t got =
        uninterrupted([&] { return ::read(file.get(), bytes.data() + filled, bytes.size() - filled); });
    if (got < 0) fail("cannot read", path, errno);
    if (got == 0) break;
    filled += static_cast<size_t>(got);
    if (static_cast<int64_t>(filled) > size_limit) throw too_large();
    if (filled == bytes.size()) bytes.resize(2 * filled);
  }
  bytes.resize(filled);
  return bytes;
}

// A temporary file that is deleted unless it was renamed to its final name.
class TemporaryFile {
 public:
  TemporaryFile(const fs::path& folder, mode_t mode) : file_(-1) {
    static std::atomic<uint32_t> counter{0};
    for (int attempt = 0; attempt < 100; ++attempt) {
      path_ = folder / (".focal-" + std::to_string(::getpid()) + "-" + std::to_string(counter++) + ".tmp");
      constexpr int flags = O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC;
      file_ = FileDescriptor(uninterrupted([&] { return ::open(path_.c_str(), flags, mode); }));
      if (file_.valid()) return;
      if (errno != EEXIST) break;
    }
    fail("cannot create", path_, errno);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    if (!renamed_) ::unlink(path_.c_str());
  }

  int descriptor() const { return file_.get(); }

  void write_and_sync(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
      constexpr size_t chunk = size_t{1} << 30;  // Linux writes at most 2 GiB per call
      const ssize_t written =
          uninterrupted([&] { return ::write(file_.get(), bytes.data(), std::min(bytes.size(), chunk)); });
      if (written <= 0) fail("cannot write", path_, written < 0 ? errno : ENOSPC);
      bytes = bytes.subspan(static_cast<size_t>(written));
    }
    if (uninterrupted([&] { return ::fsync(file_.get()); }) != 0) fail("cannot flush", path_, errno);
    // After EINTR the descriptor is closed all the same, and the data is already on disk.
    if (file_.close() != 0 && errno != EINTR) fail("cannot close", path_, errno);
  }

  void rename_to(const fs::path& target) {
    if (uninterrupted([&] { return ::rename(path_.c_str(), target.c_str()); }) != 0)
      fail("cannot replace", target, errno);
    renamed_ = true;
  }

 private:
  fs::path path_;
  FileDescriptor file_;
  bool renamed_ = false;
};

// Makes the rename itself durable. A file system without fsync on folders is not an error.
void sync_folder(const fs::path& folder) {
  const FileDescriptor handle(
      uninterrupted([&] { return ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC); }));
  if (!handle.valid()) return;  // a folder may be writable but not readable
  if (uninterrupted([&] { return ::fsync(handle.get()); }) != 0 && errno != EINVAL && errno != ENOTSUP)
    fail("cannot flush", folder, errno);
}

}  // namespace

std::string text_of(const fs::path& path) {
  const auto text = path.u8string();
  return {text.begin(), text.end()};
}

std::optional<fs::path> path_from_text(std::string_view text) { return fs::path(text); }

std::vector<std::byte> read_file(const fs::path& path, int64_t size_limit) {
  require_plain_name(path);
  // O_NONBLOCK: opening a pipe without a writer returns at once, and read_all then refuses it.
  const FileDescriptor file(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY));
  if (!file.valid()) fail("cannot open", path, errno);
  return read_all(file, path, size_limit);
}

std::vector<std::byte> read_file_inside(const fs::path& folder, const fs::path& relative,
                                        int64_t size_limit) {
  require_plain_name(relative);
  const auto leaves = [](const fs::path& part) { return part == ".."; };
  if (relative.is_absolute() || !relative.has_filename() ||
      std::any_of(relative.begin(), relative.end(), leaves))
    throw Error(Status::invalid_file, quoted(relative) + " leads out of the file's folder",
                "keep referenced files beside the file that names them");
  const fs::path start = folder.empty() ? fs::path(".") : folder;
  FileDescriptor at(::open(start.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!at.valid()) fail("cannot open", start, errno);
  for (auto part = relative.begin(); part != relative.end(); ++part) {
    const bool last = std::next(part) == relative.end();
    const int flags = O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY | O_NOFOLLOW | (last ? 0 : O_DIRECTORY);
    FileDescriptor next(::openat(at.get(), part->c_str(), flags));
    if (!next.valid() && errno == ELOOP)
      throw Error(Status::invalid_file, quoted(relative) + " goes through a symbolic link",
                  "replace the link by the file itself");
    if (!next.valid()) fail("cannot open", relative, errno);
    at = std::move(next);
  }
  return read_all(at, relative, size_limit);
}

void write_file_atomically(const fs::path& path, std::span<const std::byte> bytes) {
  require_plain_name(path);
  std::error_code error;
  // Replaces the target of a link and keeps the link.
  const bool is_link = fs::is_symlink(path, error);
  error.clear();
  const fs::path target = is_link ? fs::weakly_canonical(path, error) : path;
  if (error) fail("cannot follow", path, error.value());
  struct stat old {};
  const bool replaces = ::stat(target.c_str(), &old) == 0;
  if ((replaces && !S_ISREG(old.st_mode)) || !target.has_filename())
    throw Error(Status::invalid_argument, quoted(path) + " is a folder, pipe or device",
                "pass the path of a regular file");
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  TemporaryFile temporary(folder, 0666);
  if (replaces)
    (void)::fchmod(temporary.descriptor(), old.st_mode & 0777);  // keeps the permissions of the old file
  temporary.write_and_sync(bytes);
  temporary.rename_to(target);
  sync_folder(folder);
}

}  // namespace focal
