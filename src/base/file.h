// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string>

namespace lanthorn {

/// Writes a file whole or not at all: to a temporary name in the same folder, synced, then renamed over `path`. Devices
/// and pipes, which cannot be renamed over, are written directly. `lanthorn::Error` says what failed and what to do;
/// nothing is left behind.
void write_file(const std::filesystem::path& path, std::span<const std::byte> bytes);

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
