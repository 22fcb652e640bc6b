// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Beginnings of image files that announce more data than they contain.
#pragma once

#include <zlib.h>

#include <cstdint>
#include <string>
#include <string_view>

namespace lanthorn::test {

/// A PNG file (8-bit RGB) without any rows of pixels.
inline std::string png_header(std::uint32_t width, std::uint32_t height) {
  const auto number = [](std::uint32_t n) {
    return std::string{static_cast<char>(n >> 24), static_cast<char>(n >> 16), static_cast<char>(n >> 8),
                       static_cast<char>(n)};
  };
  const auto chunk = [&](const std::string& type, const std::string& data) {
    const std::string body = type + data;
    const uLong checksum = crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size()));
    return number(static_cast<std::uint32_t>(data.size())) + body + number(static_cast<std::uint32_t>(checksum));
  };
  const std::string no_data("\x78\x9c\x03\0\0\0\0\x01", 8);
  return "\x89PNG\r\n\x1a\n" + chunk("IHDR", number(width) + number(height) + std::string("\x08\x02\0\0\0", 5)) +
         chunk("IDAT", no_data) + chunk("IEND", "");
}

/// A GIF file whose only picture has a colour map and no pixels.
inline std::string gif_header(unsigned width, unsigned height) {
  const std::string size{static_cast<char>(width), static_cast<char>(width >> 8), static_cast<char>(height),
                         static_cast<char>(height >> 8)};
  return "GIF89a" + size + std::string("\xf7\0\0", 3) + std::string(768, '\0') + std::string(",\0\0\0\0", 5) + size +
         std::string("\0\x08\x02\xff\xff\0;", 7);
}

}  // namespace lanthorn::test
