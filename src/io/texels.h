// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Encodes texels for texture files.
#pragma once

#include <cstdint>
#include <string>

#include "base/bytes.h"
#include "lanthorn/ibl.h"
#include "lanthorn/image.h"
#include "math/packed_float.h"

namespace lanthorn {

/// Appends the texels of a rectangle with channels R, G, B; half floats get an alpha of 1.
inline void append_texels(std::string& out, const Image& image, int left, int width, TexelFormat format) {
  for (int y = 0; y < image.height; ++y)
    for (int x = left; x < left + width; ++x) {
      const float* const p = image.pixels.data() + image.index(x, y);
      if (format == TexelFormat::rgb9e5) {
        append_number(out, encode_rgb9e5(p[0], p[1], p[2]));
        continue;
      }
      for (int c = 0; c < 3; ++c) append_number(out, encode_finite_half(p[c]));
      append_number(out, encode_finite_half(1));
    }
}

inline std::uint32_t bytes_per_texel(TexelFormat format) { return format == TexelFormat::half ? 8 : 4; }

}  // namespace lanthorn
