// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The picture of a state, and how far it is from the truth.
#pragma once

#include <vector>

#include "film/film.h"
#include "render/state.h"

namespace lanthorn {

/// The picture of a film with the sums of these passes, by the settings of `state`, and its error. With all layers:
/// those of `Film::resolve`, then error.R .. B (one standard error of color, where both halves of the passes have
/// some), and bias.R .. B (the estimated bias) if the method has one.
MeasuredPicture measured_picture_of(const RenderState& state, const Film& film, const std::vector<PassRange>& passes);

}  // namespace lanthorn
