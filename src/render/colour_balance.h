// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "lanthorn/render_options.h"
#include "render/state.h"
#include "spectrum/white_balance.h"

namespace lanthorn {

/// The map of colours that makes the colours of smooth spectra right after these passes.
///
/// If all light of a pass, or of its part, has the same four wavelengths, every spectrum has a colour of its own in it:
/// that of white light may have a quarter of its blue. How the wavelengths drawn so far show a known spectrum follows
/// from the seed and the passes alone. Of the linear maps that show D65 as (1, 1, 1), this is the one that is nearest
/// to the true colours of smooth reflectances under D65 (least squares, relative to their luminance): a regression
/// estimator with these spectra as its controls. It is exact for D65 after any number of passes, and tends to the
/// identity, so that all spectra are right in the limit.
///
/// The identity for methods whose paths have wavelengths of their own, and for RGB colour.
RgbMatrix colour_balance(const RenderState& state);
/// With other passes than the state's.
RgbMatrix colour_balance(const RenderState& state, std::span<const PassRange> passes);

}  // namespace lanthorn
