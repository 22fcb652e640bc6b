// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// User-defined rendering methods: a function from rays to radiance.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "lanthorn/color.h"
#include "lanthorn/rays.h"
#include "lanthorn/scene.h"

namespace lanthorn {

/// The eye rays of a tile of the picture in one pass, one for each pixel, in the coordinates of the scene's file.
struct EyeRays {
  std::span<const SceneRay> rays;
  /// Seed for all random numbers of the function; the same for the same tile, pass and render seed.
  std::uint64_t random_key = 0;
};
/// Fills in one radiance for each ray, in linear Rec.709. Called on the rendering thread for one tile at a time. An
/// exception ends the render; the pass leaves no trace.
using OwnRadiance = std::function<void(const SharedScene& scene, const EyeRays& eye, std::span<Rgb> radiance)>;

/// Adds a method that calls `radiance` once for each tile of a pass; film, filter, states and merging work as for all
/// methods. Renders in RGB only. Throws Error if a method of this name exists. Not thread-safe: call it before any
/// render.
void add_method(const std::string& name, const std::string& summary, OwnRadiance radiance);

}  // namespace lanthorn
