// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "math/sampler.h"
#include "path/render_job.h"
#include "spectrum/wavelengths.h"

namespace lanthorn {

/// Time and wavelengths, shared by all vertices of a path. Methods that cache light paths draw them once per pass, the
/// others once per path.
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
  // The four wavelengths are an offset within a quarter of the range and its three shifts. The offset decides the tint,
  // so it takes a stratified dimension of its own; the hero is chosen among the four by another.
  const float hero = std::floor(4 * sampler.next());
  return {time, Wavelengths::spectral(0.25f * (offset + hero))};
}

/// Time and wavelengths of all paths of a pass, for methods that cache light paths.
inline PathDraw draw_for_pass(const RenderJob& job, std::uint32_t pass) {
  Sampler sampler = Sampler::for_pass(job.settings.seed, pass);
  return draw_time_and_wavelengths(job.view.camera, job.settings.color, sampler);
}

}  // namespace lanthorn
