// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "math/sampler.h"
#include "path/render_job.h"
#include "spectrum/wavelengths.h"

namespace lanthorn {

/// What all vertices of a path share; methods that cache light paths draw it once per pass, the others once per path.
struct PathDraw {
  float time = 0;
  Wavelengths w;
};

/// Draws both from the sampler's group 1.
inline PathDraw draw_time_and_wavelengths(const Camera& camera, ColorMode mode, Sampler& sampler) {
  sampler.seek(1);
  const float time = camera.time(sampler.next());
  const float offset = sampler.next();
  if (mode == ColorMode::rgb) return {time, Wavelengths::rgb(offset)};
  // The four wavelengths are an offset within a quarter of the range and its three shifts: the offset decides the tint
  // and must itself be stratified over paths or passes; which of the four is the hero is drawn apart.
  const float hero = std::floor(4 * sampler.next());
  return {time, Wavelengths::spectral(0.25f * (offset + hero))};
}

/// What all paths of a pass share, in methods that cache light paths.
inline PathDraw draw_for_pass(const RenderJob& job, std::uint32_t pass) {
  Sampler sampler = Sampler::for_pass(job.settings.seed, pass);
  return draw_time_and_wavelengths(job.view.camera, job.settings.color, sampler);
}

}  // namespace lanthorn
