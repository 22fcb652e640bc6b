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

/// The whole file; `lanthorn::Error` naming it if it cannot be read, or is no regular file (a pipe or device would
/// never end).
std::string read_file(const std::filesystem::path& path);

/// Bytes of a file that a scene names. Throws Error if it cannot be read.
using FileReader = std::function<std::string(const std::filesystem::path&)>;

}  // namespace lanthorn
