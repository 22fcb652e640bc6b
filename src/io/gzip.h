// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace lanthorn {

/// Largest decompressed file, bytes. The size is further limited to half of the machine's memory.
inline constexpr std::size_t max_decompressed_size = std::size_t{4} << 30;

/// True if the bytes begin with the header of a gzip stream.
bool is_gzip(std::string_view bytes);
/// Decompresses a gzip stream (RFC 1952; several members are concatenated) from the file `name`. Throws Error with that
/// name if it is damaged, truncated or grows beyond `limit` bytes.
std::string gunzip(std::string_view bytes, const std::string& name, std::size_t limit = max_decompressed_size);
/// The bytes of the file `name`, decompressed if they are a gzip stream (by content, not by name). Throws Error as
/// `gunzip` does.
std::string decompressed(std::string bytes, const std::string& name);

}  // namespace lanthorn
