// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "spectrum/white_balance.h"

namespace lanthorn {

/// CIE 1931 x and y of red, green, blue and white, in OpenEXR's order.
using Chromaticities = std::array<float, 8>;
inline constexpr Chromaticities rec709_chromaticities{0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f};

/// Maps linear colours of these chromaticities to linear Rec.709 such that white stays white: von Kries adaptation in
/// Bradford's cone space, as OpenEXR's reader of ACES files and the configurations of OpenColorIO do it. The identity
/// for chromaticities that round to those of Rec.709. nullopt if no colours can have them: a number that is not finite,
/// primaries on one line, or a white without light for one of the cones.
std::optional<RgbMatrix> rec709_from(const Chromaticities& chromaticities);

}  // namespace lanthorn
