// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// A rendering method of a program's own: a function from rays to radiance.
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
  /// The same for the same tile of the same pass with the same seed: draw all random numbers from it.
  std::uint64_t random_key = 0;
};
/// One radiance for each ray, in linear Rec.709. Called on the thread that renders, for one tile after the other. What
/// it throws ends the render; the pass leaves no trace.
using OwnRadiance = std::function<void(const SharedScene& scene, const EyeRays& eye, std::span<Rgb> radiance)>;

/// Adds a method whose pass is one call for each tile; film, filter, states and merging are those of every method.
/// Renders in RGB only. Throws Error if there is a method of this name. Call it before any render: not thread-safe.
void add_method(const std::string& name, const std::string& summary, OwnRadiance radiance);

}  // namespace lanthorn
