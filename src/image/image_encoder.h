// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Writes image files without the libraries that read them, which take longer to load than small pictures to render.
#pragma once

#include <cstdint>
#include <span>
#include <string>
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

}  // namespace lanthorn
