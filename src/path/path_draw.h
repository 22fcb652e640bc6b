// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

#include "math/hash.h"
#include "math/sampler.h"
#include "path/render_job.h"
#include "spectrum/wavelengths.h"

namespace lanthorn {

/// Time and wavelengths, shared by all vertices of a path. Methods that cache light paths draw the wavelengths once per
/// pass (`PassDraw`), the others once per path.
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

/// What the paths of a pass share in methods that cache light paths: their wavelengths, and a part of the shutter
/// interval. Every path has a time of its own in that part. A photon is seen by eye paths of other times, but of the
/// same part. Over 16 passes the parts cover the interval once, over the next 64 once more in quarters of these, and so
/// on: the time between photon and eye tends to 0, and any number of passes is spread over the whole interval.
struct PassDraw {
  float begin = 0, length = 0;  ///< times, s
  Wavelengths w;

  /// Draws the time from the sampler's group 1.
  PathDraw of_path(Sampler& sampler) const {
    sampler.seek(1);
    return {begin + length * sampler.next(), w};
  }
};

/// The part of the shutter interval of a pass, in [0,1): its begin and length.
struct ShutterPart {
  float begin = 0, length = 1;
};
inline ShutterPart shutter_part(std::uint64_t seed, std::uint32_t pass) {
  int bits = 4;
  std::uint64_t number = pass;
  for (; number >= std::uint64_t{1} << bits; bits += 2) number -= std::uint64_t{1} << bits;
  // Bit reversal spreads the first few of the parts over the interval, in an order that depends on the seed.
  const std::uint64_t scramble = hash_words({seed, static_cast<std::uint64_t>(bits)});
  std::uint64_t part = 0;
  for (int bit = 0; bit < bits; ++bit) part |= (number >> bit & 1) << (bits - 1 - bit);
  part ^= scramble & ((std::uint64_t{1} << bits) - 1);
  const float length = std::ldexp(1.0f, -bits);
  return {static_cast<float>(part) * length, length};
}

inline PassDraw draw_for_pass(const RenderJob& job, std::uint32_t pass) {
  Sampler sampler = Sampler::for_pass(job.settings.seed, pass);
  sampler.seek(1);
  sampler.next();  // wavelengths are the same whether or not anything moves
  const ShutterPart part = shutter_part(job.settings.seed, pass);
  const float open = job.view.camera.time(part.begin);
  return {open, job.view.camera.time(part.begin + part.length) - open, draw_wavelengths(job.settings.color, sampler)};
}

/// The wavelengths of `draw_for_pass`, which depend on nothing else.
inline Wavelengths wavelengths_of_pass(std::uint64_t seed, ColorMode mode, std::uint32_t pass) {
  Sampler sampler = Sampler::for_pass(seed, pass);
  sampler.seek(1);
  sampler.next();
  return draw_wavelengths(mode, sampler);
}

}  // namespace lanthorn
