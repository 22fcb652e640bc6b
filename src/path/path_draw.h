// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

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

/// Draws from the sampler's next two numbers.
inline Wavelengths draw_wavelengths(ColorMode mode, Sampler& sampler) {
  const float offset = sampler.next();
  if (mode == ColorMode::rgb) return Wavelengths::rgb(offset);
  // The four wavelengths are an offset within a quarter of the range and its three shifts: the offset decides the tint
  // and must itself be stratified over paths or passes; which of the four is the hero is drawn apart.
  const float hero = std::floor(4 * sampler.next());
  return Wavelengths::spectral(0.25f * (offset + hero));
}

/// Draws both from the sampler's group 1.
inline PathDraw draw_time_and_wavelengths(const Camera& camera, ColorMode mode, Sampler& sampler) {
  sampler.seek(1);
  const float time = camera.time(sampler.next());
  return {time, draw_wavelengths(mode, sampler)};
}

/// Time and wavelengths of all paths of a pass, for methods that cache light paths.
inline PathDraw draw_for_pass(const RenderJob& job, std::uint32_t pass) {
  Sampler sampler = Sampler::for_pass(job.settings.seed, pass);
  return draw_time_and_wavelengths(job.view.camera, job.settings.color, sampler);
}

/// The wavelengths of `draw_for_pass`, which depend on nothing else.
inline Wavelengths wavelengths_of_pass(std::uint64_t seed, ColorMode mode, std::uint32_t pass) {
  Sampler sampler = Sampler::for_pass(seed, pass);
  sampler.seek(1);
  sampler.next();  // the time
  return draw_wavelengths(mode, sampler);
}

}  // namespace lanthorn
