// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string>

namespace lanthorn {

/// The extension of `path` with its dot, in lower case; empty if it has none.
std::string lower_extension(const std::filesystem::path& path);

/// The file that `path` leads to by symbolic links, which need not be there. Throws Error for links in a circle.
std::filesystem::path follow_links(const std::filesystem::path& path);

/// Writes a file whole or not at all: to a temporary name in the same folder, synced, then renamed over `path`. What is
/// replaced keeps its mode, and its owner and group where permitted; a link stays a link to its file, also if there is
/// none yet. Devices and pipes, which cannot be renamed over, are written directly. `lanthorn::Error` says what failed
/// and what to do; nothing is left behind. What processes that were killed left behind for this file is removed.
void write_file(const std::filesystem::path& path, std::span<const std::byte> bytes);

/// Writes a new file in `folder` that the user alone may read, and returns its path: `prefix`, 16 random digits,
/// `suffix`. Nobody can have put a file or link there before. `lanthorn::Error` if it cannot; nothing is left behind.
std::filesystem::path write_private_file(const std::filesystem::path& folder, const std::string& prefix,
                                         const std::string& suffix, std::span<const std::byte> bytes);

/// The whole file; `lanthorn::Error` naming it if it cannot be read, is larger than memory, or is no regular file (a
/// pipe or device would never end). Never waits for anybody.
std::string read_file(const std::filesystem::path& path);

struct OpenedFile {
  std::string bytes;
  std::filesystem::path real_path;  ///< of what was opened, links followed
};
/// As `read_file`, with what the name led to at the moment of opening.
OpenedFile read_opened_file(const std::filesystem::path& path);

/// Bytes of a file that a scene names. Throws Error if it cannot be read.
using FileReader = std::function<std::string(const std::filesystem::path&)>;

}  // namespace lanthorn
