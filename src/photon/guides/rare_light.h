// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "path/render_job.h"

namespace lanthorn {

/// True if the scene has mirrors or clear glass.
bool has_specular_surfaces(const Scene& scene);

/// Share of the light on visible surfaces and in visible media that path tracing finds rarely or never. Only light that
/// arrives through clear glass or by mirrors is considered, because next-event estimation does not find it there. It is
/// rare if its source has no extent, or if fewer than one in 1000 diffuse directions meets the source there; all of it
/// is rare if the relative variance of a pass would exceed 50. Indirect light from such light counts, too.
/// Measured by a pilot pass of photons. 0 in scenes without mirrors and clear glass.
double rare_light_share(const RenderJob& job);

}  // namespace lanthorn
