// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

namespace lanthorn {

/// The folder for large temporary files: TMPDIR, or else /var/tmp, because /tmp may be in memory.
std::filesystem::path scratch_folder();

/// An unnamed file on disk, for data that does not fit into memory. It disappears when the process ends, for whatever
/// reason. Several threads may use it.
class ScratchFile {
 public:
  /// Throws Error, naming the folder, if the file cannot be created.
  explicit ScratchFile(std::filesystem::path folder = scratch_folder());
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;
  ~ScratchFile();

  /// Throws Error, naming the folder and the reason (such as a full disk).
  void write(std::uint64_t offset, std::span<const std::byte> bytes);
  /// Returns false if the bytes cannot be read.
  bool read(std::uint64_t offset, std::span<std::byte> bytes) const;

  const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path folder_;
  int descriptor_ = -1;
};

/// Bytes that may still be written to the folder's file system; the largest number if unknown.
std::uint64_t free_space(const std::filesystem::path& folder);

}  // namespace lanthorn
