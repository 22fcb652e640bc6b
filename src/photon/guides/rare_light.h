// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "path/render_job.h"

namespace lanthorn {

/// Whether there are mirrors or clear glass.
bool has_specular_surfaces(const Scene& scene);

/// Share of the light on visible surfaces and in visible media that path tracing finds by rare chance or never: light
/// that comes through clear glass or by mirrors, where next-event estimation does not see it, from lights that have no
/// extent or are so small there that fewer than one in 1000 diffuse directions meets them, or so few that the relative
/// variance of a pass is more than 50. What such light illuminates in turn counts, too. Measured by a pilot pass of
/// photons. 0 in scenes without mirrors and clear glass.
double rare_light_share(const RenderJob& job);

}  // namespace lanthorn
