// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// OpenEXR files of other programs, whose colours have other primaries and another white than ours.
#pragma once

#include <array>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>

#include "lanthorn/image_file.h"

namespace lanthorn::test {

/// CIE x and y of red, green, blue and white of ACEScg (Academy S-2014-004).
inline constexpr std::array<float, 8> acescg{0.713f, 0.293f, 0.165f, 0.830f, 0.128f, 0.044f, 0.32168f, 0.33767f};

namespace exr_colours {
inline constexpr std::string_view attribute("chromaticities\0chromaticities\0\x20\0\0\0", 34);

inline std::string encode(const Image& image) {
  const std::vector<unsigned char> bytes = encode_exr(image);
  return {bytes.begin(), bytes.end()};
}
inline std::size_t place_in(const std::string& bytes) {
  const std::size_t place = bytes.find(attribute);
  if (place == std::string::npos) throw std::logic_error("an EXR file of ours without chromaticities");
  return place;
}
}  // namespace exr_colours

/// An EXR file of these values, whose attribute `chromaticities` is replaced.
inline std::string exr_of(const Image& image, const std::array<float, 8>& chromaticities) {
  std::string bytes = exr_colours::encode(image);
  std::memcpy(bytes.data() + exr_colours::place_in(bytes) + exr_colours::attribute.size(), chromaticities.data(),
              sizeof chromaticities);
  return bytes;
}

/// The same without the attribute: another one of the same size replaces it.
inline std::string exr_without_chromaticities(const Image& image) {
  std::string bytes = exr_colours::encode(image);
  bytes[exr_colours::place_in(bytes)] = 'k';
  return bytes;
}

/// One pixel.
inline Image colour_of_one_pixel(float r, float g, float b) {
  Image image(1, 1, {"R", "G", "B"});
  image.pixels = {r, g, b};
  return image;
}

}  // namespace lanthorn::test
