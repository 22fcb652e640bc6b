// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

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

/// CIE 1931 x and y of red, green, blue and white, in OpenEXR's order.
using Chromaticities = std::array<float, 8>;
inline constexpr Chromaticities rec709_chromaticities{0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f};

/// Maps linear colours of these chromaticities to linear Rec.709 such that white stays white: von Kries adaptation in
/// Bradford's cone space, as OpenEXR's reader of ACES files and the configurations of OpenColorIO do it. The identity
/// for chromaticities that round to those of Rec.709. nullopt if no colours can have them: a number that is not finite,
/// primaries on one line, or a white without light for one of the cones.
std::optional<RgbMatrix> rec709_from(const Chromaticities& chromaticities);

}  // namespace lanthorn
