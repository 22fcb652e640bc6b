// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace lanthorn {

/// True if the file is a Git LFS pointer: the few lines of text that a clone without Git LFS has instead of the file.
bool is_lfs_pointer(const std::filesystem::path& path);

/// Reads all files that a scene names; decides which files may be read and how large images may be.
struct FileAccess {
  static constexpr std::uint64_t default_max_pixels = std::uint64_t{1} << 30;

  /// If not empty, only files below this folder may be read; names, ".." and links that lead outside are rejected. A
  /// canonical path.
  std::filesystem::path sandbox;
  std::uint64_t max_pixels = default_max_pixels;  ///< per image
  bool skip_missing = false;                      ///< see ReadOptions
  std::optional<std::uint64_t> texture_memory{};  ///< see ReadOptions

  bool is_sandboxed() const { return !sandbox.empty(); }
  /// The path to pass to libraries that open files themselves. Throws Error, naming `path`, unless it is a regular file
  /// that may be read and not a Git LFS pointer. In a sandbox the message is the same for every reason, so that a scene
  /// cannot learn which files exist outside.
  std::filesystem::path checked(const std::filesystem::path& path) const;
  /// True if `checked` would throw.
  bool is_missing(const std::filesystem::path& path) const;
  /// Resolves `name` as used by a scene in `folder`. Returns the first of these files that exists: the file itself; a
  /// file whose name differs only in letter case or in the kind of slashes; if `name` leads out of the folder, as paths
  /// of other machines do, the file in `folder` that matches the longest tail of `name`; the file of that base name in
  /// a folder "textures" beside the scene or beside `folder`. Returns `folder / name` if none exists.
  std::filesystem::path find(const std::filesystem::path& folder, const std::filesystem::path& name) const;
  /// Reads the whole file. Throws Error as `checked` does.
  std::string read(const std::filesystem::path& path) const;
  /// Opens the file for reading. Throws Error as `checked` does.
  std::shared_ptr<std::FILE> open(const std::filesystem::path& path) const;
};

}  // namespace lanthorn
