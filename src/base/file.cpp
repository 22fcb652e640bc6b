// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "lanthorn/file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdint>
#include <set>
#include <string>
#include <system_error>
#include <utility>

#include "base/memory.h"
#include "lanthorn/error.h"
#include "lanthorn/text.h"

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
    case ENXIO:
      return "; if it is a pipe, start its reader first";
    case EISDIR:
      return "; give the name of a file";
    case EFBIG:
      return "; raise the limit on the size of files (ulimit -f)";
    default:
      return "";
  }
}

[[noreturn]] void fail(const fs::path& path, int code) {
  throw Error({path.string()}, fmt::format("cannot write: {}{}", std::generic_category().message(code), advice(code)));
}

/// An open file. The destructor closes it, and removes it if it has a name and `keep` was not called.
class OpenFile {
 public:
  OpenFile(int descriptor, fs::path remove) : descriptor_(descriptor), remove_(std::move(remove)) {}
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  OpenFile(OpenFile&& other) noexcept
      : descriptor_(std::exchange(other.descriptor_, -1)), remove_(std::exchange(other.remove_, {})) {}
  OpenFile& operator=(OpenFile&&) = delete;
  // Removes the temporary file before releasing its lock.
  ~OpenFile() {
    if (!remove_.empty()) ::unlink(remove_.c_str());
    if (descriptor_ >= 0) ::close(descriptor_);
  }

  int descriptor() const { return descriptor_; }
  const fs::path& path() const { return remove_; }
  /// Returns 0 or the error number.
  int write(std::span<const std::byte> bytes) const {
    while (!bytes.empty()) {
      const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
      if (written < 0 && errno != EINTR) return errno;
      if (written > 0) bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    return 0;
  }
  /// Fills `bytes` as far as the file goes; returns the number of bytes read.
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
  int sync() const { return ::fsync(descriptor_) == 0 ? 0 : errno; }
  int close() { return ::close(std::exchange(descriptor_, -1)) == 0 ? 0 : errno; }
  void keep() { remove_.clear(); }
  /// Leaves closing the file to the caller.
  int release() { return std::exchange(descriptor_, -1); }

 private:
  int descriptor_;
  fs::path remove_;
};

constexpr int new_file = O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC;
constexpr std::size_t random_digits = 16;

std::string random_name() {
  std::uint64_t number = 0;
  while (::getrandom(&number, sizeof number, 0) < 0 && errno == EINTR) {
  }
  return fmt::format("{:016x}", number);
}

// Temporary files of `target` are named START, random digits, ".tmp".
std::string start_of_temporaries(const fs::path& target) {
  constexpr std::size_t longest = 255 - random_digits - 5;
  return target.filename().string().substr(0, longest) + ".";
}

bool is_temporary(const std::string& name, const std::string& start) {
  constexpr std::string_view end = ".tmp";
  return name.size() == start.size() + random_digits + end.size() && name.starts_with(start) && name.ends_with(end) &&
         std::all_of(name.begin() + static_cast<std::ptrdiff_t>(start.size()), name.end() - end.size(),
                     [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); });
}

fs::path folder_of(const fs::path& path) { return path.has_parent_path() ? path.parent_path() : fs::path("."); }

// A process keeps its temporary file locked as long as it lives: an unlocked one is abandoned.
void remove_abandoned_temporaries(const fs::path& target) {
  const std::string start = start_of_temporaries(target);
  std::error_code error;
  for (fs::directory_iterator entry(folder_of(target), error), end; !error && entry != end; entry.increment(error)) {
    const fs::path& path = entry->path();
    if (!is_temporary(path.filename().string(), start)) continue;
    const int descriptor = ::open(path.c_str(), O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0) continue;
    if (::flock(descriptor, LOCK_EX | LOCK_NB) == 0) ::unlink(path.c_str());
    ::close(descriptor);
  }
}

// Throws Error, naming `path`, the user's name for `target`.
OpenFile create_temporary(const fs::path& target, mode_t mode, const fs::path& path) {
  while (true) {
    const fs::path temporary = folder_of(target) / (start_of_temporaries(target) + random_name() + ".tmp");
    const int descriptor = ::open(temporary.c_str(), new_file, mode);
    if (descriptor < 0 && errno == EEXIST) continue;
    if (descriptor < 0) fail(path, errno);
    OpenFile file(descriptor, temporary);
    // On file systems without locks, abandoned files remain.
    while (::flock(descriptor, LOCK_EX) != 0 && errno == EINTR) {
    }
    struct stat status {};
    // Another process may have removed the file as abandoned before it was locked.
    if (::fstat(descriptor, &status) == 0 && status.st_nlink > 0) return file;
  }
}

// Gives the new file the old one's owner, group and mode. If the group cannot be kept, the new group gets only the
// permissions that all other users have.
void keep_permissions(int descriptor, const struct stat& old) {
  struct stat now {};
  if (::fstat(descriptor, &now) != 0) return;
  bool same_group = now.st_gid == old.st_gid;
  if (now.st_uid != old.st_uid || !same_group)
    same_group = ::fchown(descriptor, old.st_uid, old.st_gid) == 0 ||
                 ::fchown(descriptor, now.st_uid, old.st_gid) == 0 || same_group;
  mode_t mode = old.st_mode & (S_IRWXU | S_IRWXG | S_IRWXO);
  if (!same_group) mode &= S_IRWXU | S_IRWXO | ((mode & S_IRWXO) << 3);
  ::fchmod(descriptor, mode);
}

// Makes the rename durable. Some file systems do not support this; failure is ignored.
void sync_folder(const fs::path& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

// A pipe without a reader is an error: opening it would block, possibly for ever.
void write_in_place(const fs::path& path, std::span<const std::byte> bytes) {
  OpenFile file(::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK), {});
  if (file.descriptor() < 0) fail(path, errno);
  if (::fcntl(file.descriptor(), F_SETFL, 0) != 0) fail(path, errno);  // from here on, waits for a slow reader
  if (const int code = file.write(bytes)) fail(path, code);
  if (const int code = file.close()) fail(path, code);
}

fs::path real_path_of(int descriptor, const fs::path& name) {
  std::error_code code;
  fs::path real = fs::read_symlink(fmt::format("/proc/self/fd/{}", descriptor), code);
  return code ? fs::canonical(name, code) : real;
}

}  // namespace

std::string lower_extension(const fs::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

fs::path follow_links(const fs::path& path) {
  constexpr int most_links = 40;
  std::error_code error;
  fs::path target = path;
  for (int i = 0; i < most_links; ++i) {
    if (!fs::is_symlink(fs::symlink_status(target, error))) return target;
    target = target.parent_path() / fs::read_symlink(target, error);
    if (error) fail(path, error.value());
  }
  fail(path, ELOOP);
}

struct FileSet::Pending {
  OpenFile file;
  fs::path path, target;  ///< the name given, and what it resolves to
};

FileSet::FileSet() = default;
FileSet::~FileSet() = default;

void FileSet::add(const fs::path& path, std::span<const std::byte> bytes) {
  std::error_code ignored;
  const fs::file_status status = fs::status(path, ignored);
  if (fs::is_directory(status)) fail(path, EISDIR);
  if (fs::exists(status) && !fs::is_regular_file(status)) return write_in_place(path, bytes);
  const fs::path target = follow_links(path);
  remove_abandoned_temporaries(target);
  struct stat old {};
  const bool replaces = ::stat(target.c_str(), &old) == 0;
  OpenFile file = create_temporary(target, replaces ? 0600 : 0666, path);
  if (const int code = file.write(bytes)) fail(path, code);
  if (replaces) keep_permissions(file.descriptor(), old);
  if (const int code = file.sync()) fail(path, code);
  pending_.push_back({std::move(file), path, target});
}

void FileSet::commit() {
  std::set<fs::path> folders;
  for (Pending& pending : pending_) {
    if (::rename(pending.file.path().c_str(), pending.target.c_str()) != 0) fail(pending.path, errno);
    pending.file.keep();
    folders.insert(folder_of(pending.target));
  }
  pending_.clear();
  for (const fs::path& folder : folders) sync_folder(folder);
}

void write_file(const fs::path& path, std::span<const std::byte> bytes) {
  FileSet files;
  files.add(path, bytes);
  files.commit();
}

fs::path write_private_file(const fs::path& folder, const std::string& prefix, const std::string& suffix,
                            std::span<const std::byte> bytes) {
  const fs::path path = folder / (prefix + random_name() + suffix);
  const int descriptor = ::open(path.c_str(), new_file, 0600);
  if (descriptor < 0) fail(path, errno);
  OpenFile file(descriptor, path);
  if (const int code = file.write(bytes)) fail(path, code);
  if (const int code = file.sync()) fail(path, code);
  file.keep();
  sync_folder(folder);
  return path;
}

std::vector<std::string> file_names_beside(const fs::path& path) {
  constexpr int most = 1000;
  const fs::path folder = path.parent_path();
  std::vector<std::string> names;
  std::error_code code;
  fs::directory_iterator entry(folder.empty() ? "." : folder, code);
  for (int i = 0; i < most && !code && entry != fs::directory_iterator(); ++i, entry.increment(code))
    if (std::error_code ignored; !entry->is_directory(ignored))
      names.push_back((folder / entry->path().filename()).string());
  std::sort(names.begin(), names.end());
  return names;
}

namespace {

struct RegularFile {
  OpenFile file;
  std::uint64_t size;
};

RegularFile open_regular_file(const fs::path& path) {
  const SourceLocation place{path.string()};
  std::error_code code;
  if (!fs::exists(path, code))
    throw Error(place, "no such file" + printable(did_you_mean(path.string(), file_names_beside(path))));
  // Checked before opening, because opening some devices triggers an action; checked again on the descriptor, because
  // the name may refer to something else by then.
  if (!fs::is_regular_file(path, code)) throw Error(place, "not a regular file");
  OpenFile file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY), {});
  if (file.descriptor() < 0) throw Error(place, "cannot be read; check its permissions");
  struct stat status {};
  if (::fstat(file.descriptor(), &status) != 0 || !S_ISREG(status.st_mode)) throw Error(place, "not a regular file");
  return {std::move(file), static_cast<std::uint64_t>(status.st_size)};
}

}  // namespace

OpenedFile read_opened_file(const fs::path& path) {
  const SourceLocation place{path.string()};
  const RegularFile opened = open_regular_file(path);
  require_memory(static_cast<double>(opened.size), place, "the file");
  OpenedFile result{std::string(opened.size, '\0'), real_path_of(opened.file.descriptor(), path)};
  if (opened.file.read(result.bytes) != opened.size) throw Error(place, "cannot be read to its end");
  // Kernel files (/proc, /sys) report size 0.
  if (!opened.file.is_at_end()) throw Error(place, "not an ordinary file, or one that grows while it is read");
  return result;
}

OpenedStream open_stream(const fs::path& path) {
  RegularFile opened = open_regular_file(path);
  fs::path real = real_path_of(opened.file.descriptor(), path);
  std::FILE* const stream = ::fdopen(opened.file.descriptor(), "rb");
  if (stream == nullptr) throw Error({path.string()}, "cannot be read");
  opened.file.release();
  return {{stream, [](std::FILE* file) { std::fclose(file); }}, std::move(real)};
}

PartlyReadFile::PartlyReadFile(const fs::path& path) : path_(path) {
  RegularFile opened = open_regular_file(path);
  descriptor_ = opened.file.release();
  size_ = opened.size;
}

PartlyReadFile::~PartlyReadFile() { ::close(descriptor_); }

void PartlyReadFile::read(std::uint64_t offset, std::span<std::byte> out) const {
  while (!out.empty()) {
    const ssize_t count = ::pread(descriptor_, out.data(), out.size(), static_cast<off_t>(offset));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) throw Error({path_.string()}, "cannot be read to its end");
    out = out.subspan(static_cast<std::size_t>(count));
    offset += static_cast<std::uint64_t>(count);
  }
}

std::string read_file(const fs::path& path) { return read_opened_file(path).bytes; }

}  // namespace lanthorn
