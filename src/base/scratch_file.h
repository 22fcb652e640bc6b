// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

namespace lanthorn {

/// The folder for large temporary files: that of TMPDIR, else /var/tmp, because /tmp may lie in memory.
std::filesystem::path scratch_folder();

/// A file without a name on disk, for data that does not fit into memory. It is gone when the process ends, however
/// that happens. May be used by several threads.
class ScratchFile {
 public:
  /// Throws Error, naming the folder, if it cannot be made.
  explicit ScratchFile(std::filesystem::path folder = scratch_folder());
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;
  ~ScratchFile();

  /// Throws Error, naming the folder and the reason (such as a full disk).
  void write(std::uint64_t offset, std::span<const std::byte> bytes);
  /// False if the bytes cannot be read.
  bool read(std::uint64_t offset, std::span<std::byte> bytes) const;

  const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path folder_;
  int descriptor_ = -1;
};

/// Bytes that may still be written to the folder's file system; the largest number if that is not known.
std::uint64_t free_space(const std::filesystem::path& folder);

}  // namespace lanthorn
