// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lanthorn {

/// The extension of `path` with its dot, in lower case; empty if it has none.
std::string lower_extension(const std::filesystem::path& path);

/// Sorted names of the files in the folder of `path`, each prefixed with that folder as `path` spells it; for
/// suggestions when `path` does not exist. Considers only the first 1000 entries.
std::vector<std::string> file_names_beside(const std::filesystem::path& path);

/// Resolves the symbolic links of `path`; the final file need not exist. Throws Error for cyclic links.
std::filesystem::path follow_links(const std::filesystem::path& path);

/// Writes a file whole or not at all: under a temporary name in the same folder, synced, then renamed over `path`. A
/// replaced file's mode is kept, and its owner and group where permitted. A symbolic link stays a link: its target is
/// written, even if it does not exist yet. Devices and pipes cannot be renamed over and are written directly, a pipe
/// only if a process reads from it. Throws `lanthorn::Error` that says what failed and what to do; a failed write
/// leaves no file behind. Also removes temporary files for `path` that killed processes left behind.
void write_file(const std::filesystem::path& path, std::span<const std::byte> bytes);
inline void write_file(const std::filesystem::path& path, std::string_view text) {
  write_file(path, std::as_bytes(std::span(text)));
}

/// Writes several files, all or none. Without `commit`, no file is left behind; if the process is killed, the next
/// write to the same names removes the temporary files.
class FileSet {
 public:
  FileSet();
  FileSet(const FileSet&) = delete;
  FileSet& operator=(const FileSet&) = delete;
  ~FileSet();

  /// Writes and syncs the bytes under a temporary name, as `write_file` does. Devices and pipes are written
  /// immediately.
  void add(const std::filesystem::path& path, std::span<const std::byte> bytes);
  /// Renames all files to their final names. Throws `lanthorn::Error` if a rename fails; files renamed before it
  /// remain.
  void commit();

 private:
  struct Pending;
  std::vector<Pending> pending_;
};

/// Writes a new file in `folder` that only the user may read, and returns its path: `prefix`, 16 random digits,
/// `suffix`. Never replaces an existing file or link. Throws `lanthorn::Error` on failure and leaves no file behind.
std::filesystem::path write_private_file(const std::filesystem::path& folder, const std::string& prefix,
                                         const std::string& suffix, std::span<const std::byte> bytes);

/// Reads the whole file. Throws `lanthorn::Error` naming it if it cannot be read, is larger than memory, or is not a
/// regular file (a pipe or device would never end). Never blocks on another process.
std::string read_file(const std::filesystem::path& path);

struct OpenedFile {
  std::string bytes;
  std::filesystem::path real_path;  ///< canonical path of the opened file (links resolved)
};
/// Like `read_file`, and also returns the real path at the moment of opening.
OpenedFile read_opened_file(const std::filesystem::path& path);

struct OpenedStream {
  std::shared_ptr<std::FILE> file;
  std::filesystem::path real_path;  ///< canonical path of the opened file (links resolved)
};
/// Opens a file that is too large to be read as a whole. Throws `lanthorn::Error` as `read_file` does.
OpenedStream open_stream(const std::filesystem::path& path);

/// A regular file that any number of threads may read in parts at the same time.
class PartlyReadFile {
 public:
  /// Throws Error as `read_file` does.
  explicit PartlyReadFile(const std::filesystem::path& path);
  PartlyReadFile(const PartlyReadFile&) = delete;
  PartlyReadFile& operator=(const PartlyReadFile&) = delete;
  ~PartlyReadFile();

  std::uint64_t size() const { return size_; }
  /// Fills `out` with the bytes that start at `offset`. Throws Error if the file ends before that.
  void read(std::uint64_t offset, std::span<std::byte> out) const;

 private:
  std::filesystem::path path_;
  int descriptor_;
  std::uint64_t size_;
};

/// Returns the bytes of a file that a scene names. Throws Error if it cannot be read.
using FileReader = std::function<std::string(const std::filesystem::path&)>;

}  // namespace lanthorn
