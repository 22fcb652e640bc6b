// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Writes image files, and reads Radiance pictures (.hdr), the most common environments, without the libraries that read
// all other image files: these take longer to load than a Radiance picture to read, or a small picture to render.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "image/image_codec.h"
#include "lanthorn/image.h"

namespace lanthorn {

/// An OpenEXR file of scanlines, 32-bit floats, ZIP compression; the image's window is its data and display window. The
/// bytes do not depend on the number of threads. Throws Error if the format cannot represent the image.
std::vector<unsigned char> encode_openexr(const Image& image, const std::vector<ImageAttribute>& attributes);

struct PngText {
  std::string keyword;  ///< 1 to 79 characters of Latin-1
  std::string text;     ///< UTF-8
};
/// A PNG file of `width` columns of 8-bit sRGB colours, rows from the top.
std::vector<unsigned char> encode_png_colors(int width, std::span<const std::uint8_t> colors,
                                             const std::vector<PngText>& texts);

/// Reads the header of a Radiance picture; `OpenImage::read` provides only float32. `bytes` must outlive the result.
/// Throws std::runtime_error that states the reason, here or when pixels are read.
OpenImage open_radiance_picture(std::string_view bytes);

}  // namespace lanthorn
