// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lanthorn/render_options.h"
#include "lanthorn/scene_description.h"

namespace lanthorn {

/// The options for a picture of the same part of the scene with `share` times the width and the height.
ViewOptions scaled(ViewOptions options, const description::Film& film, double share);

/// The options for a pass of such a picture. `photons`: light paths of a pass of the whole picture.
RenderOptions coarse_options(RenderOptions options, const description::Film& film, double share, double photons);

}  // namespace lanthorn
