// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/sampler.h"
#include "scene/scene.h"
#include "spectrum/wavelengths.h"

namespace lanthorn {

/// What all vertices of a path share; methods that cache light paths draw it once per pass, the others once per path.
struct PathDraw {
  float time = 0;
  Wavelengths w;
};

/// Draws both from the sampler's group 1.
inline PathDraw draw_time_and_wavelengths(const Scene& scene, ColorMode mode, Sampler& sampler) {
  sampler.seek(1);
  const float time = scene.camera().time(sampler.next());
  const float u = sampler.next();
  return {time, mode == ColorMode::rgb ? Wavelengths::rgb(u) : Wavelengths::spectral(u)};
}

}  // namespace lanthorn
