// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "spectrum/curve.h"
#include "spectrum/spectrum.h"

namespace lanthorn {

/// A linear map of colours, stored by rows.
struct RgbMatrix {
  std::array<Rgb, 3> rows{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

  friend Rgb operator*(const RgbMatrix& m, const Rgb& c) {
    const auto dot = [&](const Rgb& row) { return row.r * c.r + row.g * c.g + row.b * c.b; };
    return {dot(m.rows[0]), dot(m.rows[1]), dot(m.rows[2])};
  }
  friend bool operator==(const RgbMatrix&, const RgbMatrix&) = default;
};

/// Maps linear Rec.709 to linear Rec.709 such that light of `kelvin` (daylight; below 4000 K a black body) becomes the
/// white of `space`: von Kries adaptation in Bradford's cone space, as pbrt-v4's "whitebalance". `kelvin` > 0.
RgbMatrix white_balance(float kelvin, ColorSpace space);
/// Maps linear Rec.709 to CIE XYZ.
RgbMatrix rec709_to_xyz();

}  // namespace lanthorn
