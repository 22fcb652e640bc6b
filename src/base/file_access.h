// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace lanthorn {

/// The gate that every file which a scene names is read through, and how large its images may be.
struct FileAccess {
  static constexpr std::uint64_t default_max_pixels = std::uint64_t{1} << 30;

  /// If not empty, only files in the tree of this folder are read, whatever name, ".." or link leads out of it. A
  /// canonical path.
  std::filesystem::path sandbox;
  std::uint64_t max_pixels = default_max_pixels;  ///< of each image

  bool is_sandboxed() const { return !sandbox.empty(); }
  /// The name by which to open the file, for libraries that open files themselves. Throws Error, naming `path`, unless
  /// it is a regular file that may be read; in a sandbox with one message whatever the reason, so that nobody learns
  /// which files there are outside.
  std::filesystem::path checked(const std::filesystem::path& path) const;
  /// The whole file. Throws Error as `checked` does.
  std::string read(const std::filesystem::path& path) const;
};

}  // namespace lanthorn
