// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "base/file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

#include "base/memory.h"
#include "lanthorn/error.h"

namespace lanthorn {
namespace fs = std::filesystem;
namespace {

const char* advice(int code) {
  switch (code) {
    case ENOSPC:
    case EDQUOT:
      return "; free some space or choose another folder";
    case EACCES:
    case EPERM:
    case EROFS:
      return "; choose a folder that you may write to";
    case ENOENT:
    case ENOTDIR:
      return "; create the folder first";
    case EISDIR:
      return "; give the name of a file";
    default:
      return "";
  }
}

[[noreturn]] void fail(const fs::path& path, int code) {
  throw Error({path.string()}, fmt::format("cannot write: {}{}", std::generic_category().message(code), advice(code)));
}

/// An open file that is closed, and removed if it has a name, unless it was kept.
class OpenFile {
 public:
  OpenFile(int descriptor, fs::path remove) : descriptor_(descriptor), remove_(std::move(remove)) {}
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  ~OpenFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
    if (!remove_.empty()) ::unlink(remove_.c_str());
  }

  /// 0 or the error number.
  int write(std::span<const std::byte> bytes) const {
    while (!bytes.empty()) {
      const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
      if (written < 0 && errno != EINTR) return errno;
      if (written > 0) bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    return 0;
  }
  /// Fills `bytes` as far as the file goes; the number of bytes.
  std::size_t read(std::span<char> bytes) const {
    std::size_t got = 0;
    while (got < bytes.size()) {
      const ssize_t count = ::read(descriptor_, bytes.data() + got, bytes.size() - got);
      if (count == 0 || (count < 0 && errno != EINTR)) break;
      if (count > 0) got += static_cast<std::size_t>(count);
    }
    return got;
  }
  bool is_at_end() const {
    char next = 0;
    return ::read(descriptor_, &next, 1) == 0;
  }
  int descriptor() const { return descriptor_; }
  int sync() const { return ::fsync(descriptor_) == 0 ? 0 : errno; }
  int close() { return ::close(std::exchange(descriptor_, -1)) == 0 ? 0 : errno; }
  void keep() { remove_.clear(); }

 private:
  int descriptor_;
  fs::path remove_;
};

void write_in_place(const fs::path& path, std::span<const std::byte> bytes) {
  OpenFile file(::open(path.c_str(), O_WRONLY | O_CLOEXEC), {});
  if (const int code = file.write(bytes)) fail(path, code);
  if (const int code = file.close()) fail(path, code);
}

fs::path real_path_of(int descriptor, const fs::path& name) {
  std::error_code code;
  fs::path real = fs::read_symlink(fmt::format("/proc/self/fd/{}", descriptor), code);
  return code ? fs::canonical(name, code) : real;
}

}  // namespace

void write_file(const fs::path& path, std::span<const std::byte> bytes) {
  std::error_code ignored;
  const fs::file_status status = fs::status(path, ignored);
  if (fs::is_directory(status)) fail(path, EISDIR);
  if (fs::exists(status) && !fs::is_regular_file(status)) return write_in_place(path, bytes);
  // A link keeps pointing to its file.
  fs::path target = fs::is_symlink(path, ignored) ? fs::weakly_canonical(path, ignored) : path;
  if (target.empty()) target = path;

  fs::path temporary = target;
  temporary += fmt::format(".{}.tmp", ::getpid());
  const int descriptor = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor < 0) fail(path, errno);
  OpenFile file(descriptor, temporary);
  if (const int code = file.write(bytes)) fail(path, code);
  if (const int code = file.sync()) fail(path, code);
  if (const int code = file.close()) fail(path, code);
  if (::rename(temporary.c_str(), target.c_str()) != 0) fail(path, errno);
  file.keep();
}

OpenedFile read_opened_file(const fs::path& path) {
  const SourceLocation place{path.string()};
  std::error_code code;
  if (!fs::exists(path, code)) throw Error(place, "no such file");
  // Before it is opened, which some devices take for a command, and after, when it cannot become another.
  if (!fs::is_regular_file(path, code)) throw Error(place, "not a regular file");
  const OpenFile file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY), {});
  if (file.descriptor() < 0) throw Error(place, "cannot be read; check its permissions");
  struct stat status {};
  if (::fstat(file.descriptor(), &status) != 0 || !S_ISREG(status.st_mode)) throw Error(place, "not a regular file");
  const auto size = static_cast<std::size_t>(status.st_size);
  require_memory(static_cast<double>(size), place, "the file");
  OpenedFile result{std::string(size, '\0'), real_path_of(file.descriptor(), path)};
  if (file.read(result.bytes) != size) throw Error(place, "cannot be read to its end");
  // Files of the kernel hide their size.
  if (!file.is_at_end()) throw Error(place, "not an ordinary file, or one that grows while it is read");
  return result;
}

std::string read_file(const fs::path& path) { return read_opened_file(path).bytes; }

}  // namespace lanthorn
