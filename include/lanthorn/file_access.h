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

/// True if the file is what a clone without Git LFS has in its place: a few lines that name the file.
bool is_lfs_pointer(const std::filesystem::path& path);

/// Reads every file that a scene names; says which files may be read and how large images may be.
struct FileAccess {
  static constexpr std::uint64_t default_max_pixels = std::uint64_t{1} << 30;

  /// If not empty, only files below this folder are read; names, ".." and links that lead outside are rejected. A
  /// canonical path.
  std::filesystem::path sandbox;
  std::uint64_t max_pixels = default_max_pixels;  ///< per image
  bool skip_missing = false;                      ///< see ReadOptions
  std::optional<std::uint64_t> texture_memory{};  ///< see ReadOptions

  bool is_sandboxed() const { return !sandbox.empty(); }
  /// The name by which to open the file, for libraries that open files themselves. Throws Error, naming `path`, unless
  /// it is a regular file that may be read, and no pointer of Git LFS. In a sandbox the message is the same for every
  /// reason, so that a scene cannot learn which files exist outside.
  std::filesystem::path checked(const std::filesystem::path& path) const;
  /// True if `checked` would throw.
  bool is_missing(const std::filesystem::path& path) const;
  /// The file that a scene in `folder` calls `name`. If it is missing, one whose name differs in the case of letters
  /// or the kind of slashes alone; for a name that leads out of the folder, as names of other machines do, also the
  /// file of its last parts in `folder`, of as many as possible; then the file of its last part in the folders
  /// "textures" beside the scene or beside `folder`. `folder / name` if these are missing, too.
  std::filesystem::path find(const std::filesystem::path& folder, const std::filesystem::path& name) const;
  /// Reads the whole file. Throws Error as `checked` does.
  std::string read(const std::filesystem::path& path) const;
  /// Opens the file for reading. Throws Error as `checked` does.
  std::shared_ptr<std::FILE> open(const std::filesystem::path& path) const;
};

}  // namespace lanthorn
