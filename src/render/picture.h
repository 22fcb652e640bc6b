// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The picture of a state, its colour balance, and how far it is from the truth.
#pragma once

#include <span>
#include <vector>

#include "film/film.h"
#include "lanthorn/color.h"
#include "lanthorn/render_options.h"
#include "render/state.h"

namespace lanthorn {

/// The picture of a film with the sums of these passes, by the settings of `state`, and its error. With all layers:
/// those of `Film::resolve`, then error.R .. B (one standard error of color, where both halves of the passes have
/// some), and bias.R .. B (the estimated bias) if the method has one.
MeasuredPicture measured_picture_of(const RenderState& state, const Film& film, const std::vector<PassRange>& passes);

/// Factors of R, G and B that make white light white again after these passes.
///
/// If all light of a pass, or of a part of it, has the same four wavelengths, white light is tinted: blue may be off by
/// a fifth. That tint is a function of the wavelengths alone, so that the sums can be divided by its mean over the
/// passes: a ratio estimator with the illuminant D65 as its control. It is exact for light of D65's spectrum after any
/// number of passes, and for all spectra in the limit, where the factors tend to 1. (A full matrix, fitted to smooth
/// reflectances, did not improve other colours, and mixes the channels' noise.)
///
/// (1, 1, 1) for methods whose paths have wavelengths of their own, and for RGB colour.
Rgb colour_balance(const RenderState& state);
/// The same for `passes` instead of the state's.
Rgb colour_balance(const RenderState& state, std::span<const PassRange> passes);

}  // namespace lanthorn
