// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// What methods that find scattered light by splats leave to eye paths.
#pragma once

#include "film/film.h"
#include "integrators/settings.h"
#include "path/ray_counts.h"
#include "scene/scene.h"

namespace lanthorn {

/// Adds one sample to each pixel by a walk that ends where light would scatter at more than a mirror or clear glass:
/// emission after at most `max_scatterings` of those, and albedo, normal and depth.
RayCounts see_emission(const Scene& scene, const RenderSettings& settings, int max_scatterings, std::uint32_t pass,
                       Film& film);

}  // namespace lanthorn
