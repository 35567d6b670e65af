// Whole files out: temporary file, write, fsync, rename.
#include "write_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "command_error.h"

namespace focal_cli {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail_writing(const std::string& path) {
  throw CommandError("cannot write '" + path + "': " + std::strerror(errno),
                     "check that the folder exists, may be written to and has room");
}

void write_all(int file, std::string_view bytes, const std::string& path) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(file, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail_writing(path);
    bytes.remove_prefix(static_cast<size_t>(written));
  }
}

struct OpenFile {
  int descriptor = -1;
  explicit OpenFile(int d) : descriptor(d) {}
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  ~OpenFile() {
    if (descriptor >= 0) ::close(descriptor);
  }
};

// Removes the temporary file unless it has been renamed.
struct TemporaryFile {
  std::string path;
  bool kept = false;
  ~TemporaryFile() {
    if (!kept) ::unlink(path.c_str());
  }
};

mode_t permissions_for(const std::string& path) {
  struct stat old;
  if (::stat(path.c_str(), &old) == 0) return old.st_mode & 07777;
  const mode_t mask = ::umask(0);
  ::umask(mask);
  return 0666 & ~mask;
}

void sync_folder(const fs::path& folder) {
  const OpenFile handle(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (handle.descriptor >= 0) ::fsync(handle.descriptor);
}

}  // namespace

void write_file_atomically(const std::string& path, std::string_view bytes) {
  std::error_code code;
  const fs::file_status target = fs::status(path, code);
  if (fs::exists(target) && !fs::is_regular_file(target)) {
    const OpenFile file(::open(path.c_str(), O_WRONLY | O_CLOEXEC));
    if (file.descriptor < 0) fail_writing(path);
    return write_all(file.descriptor, bytes, path);
  }
  // Through a link the file it names is replaced, not the link.
  const fs::path real = fs::exists(target) ? fs::canonical(path, code) : fs::path(path);
  TemporaryFile temporary{real.string() + ".XXXXXX"};
  const mode_t permissions = permissions_for(real.string());
  const OpenFile file(::mkostemp(temporary.path.data(), O_CLOEXEC));
  if (file.descriptor < 0) {
    temporary.kept = true;  // nothing was made, so there is nothing to remove
    fail_writing(path);
  }
  write_all(file.descriptor, bytes, path);
  if (::fchmod(file.descriptor, permissions) != 0 || ::fsync(file.descriptor) != 0) fail_writing(path);
  if (::rename(temporary.path.c_str(), real.c_str()) != 0) fail_writing(path);
  temporary.kept = true;
  sync_folder(real.has_parent_path() ? real.parent_path() : fs::path("."));
}

}  // namespace focal_cli
