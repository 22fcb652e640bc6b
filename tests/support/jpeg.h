// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Small JPEG files, with colour profiles.
#pragma once

#include <OpenImageIO/imageio.h>

#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include "lanthorn/file.h"
#include "support/temporary_dir.h"

namespace lanthorn::test {

/// A JPEG file of 8 x 8 pixels.
inline std::string grey_jpeg() {
  const TemporaryDir dir;
  const std::string name = (dir.path() / "a.jpg").string();
  const std::vector<unsigned char> grey(std::size_t{8} * 8 * 3, 100);
  const auto output = OIIO::ImageOutput::create(name);
  if (!output || !output->open(name, {8, 8, 3, OIIO::TypeUInt8}) ||
      !output->write_image(OIIO::TypeUInt8, grey.data()) || !output->close())
    throw std::runtime_error("OpenImageIO cannot write a JPEG file");
  return read_file(name);
}

inline std::string big_endian(std::size_t number) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(number >> shift);
  return bytes;
}

/// An ICC profile (ICC.1:2004, 7.2 and 7.3) with 50 tags whose names no standard defines, different for each number.
/// The header serves as their data.
inline std::string profile_of_unknown_tags(std::size_t number) {
  constexpr std::size_t tags = 50, header_bytes = 128;
  std::string table = big_endian(tags);
  for (std::size_t i = 0; i < tags; ++i)
    table += big_endian(0x61616161 + number * tags + i) + big_endian(0) + big_endian(8);
  std::string header(header_bytes, '\0');
  header.replace(0, 4, big_endian(header_bytes + table.size()));
  header.replace(36, 4, "acsp");
  return header + table;
}

/// The JPEG file with the profile in its second segment (ICC.1:2004, B.4).
inline std::string with_profile(const std::string& jpeg, const std::string& profile) {
  const std::string data = std::string("ICC_PROFILE\0\x01\x01", 14) + profile;
  return jpeg.substr(0, 2) + "\xff\xe2" + big_endian(data.size() + 2).substr(2) + data + jpeg.substr(2);
}

}  // namespace lanthorn::test
