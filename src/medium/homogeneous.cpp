// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "medium/homogeneous.h"

#include <algorithm>
#include <cmath>

namespace lanthorn {

namespace {

constexpr int channels = 4;

// exp(-sigma_t length). Handles infinite lengths, for which a product with zero extinction would be undefined.
Spectrum attenuation(const Spectrum& sigma_t, float length) {
  return map(sigma_t, [length](float s) { return s > 0 ? std::exp(-s * length) : 1.0f; });
}

}  // namespace

Spectrum HomogeneousMedium::transmittance(float length, const Wavelengths& w) const {
  return attenuation(sigma_a.evaluate(w) + sigma_s.evaluate(w), length);
}

// ∫ sigma_a L_e T(t) dt over the segment, in closed form.
Glow HomogeneousMedium::glow(float length, const Wavelengths& w) const {
  const Spectrum absorbed = sigma_a.evaluate(w), extinction = absorbed + sigma_s.evaluate(w);
  Glow glow{emission.evaluate(w), attenuation(extinction, length)};
  for (int i = 0; i < channels; ++i)
    glow.emitted[i] *= extinction[i] > 0 ? absorbed[i] / extinction[i] * (1 - glow.transmittance[i]) : 0.0f;
  return glow;
}

Flight HomogeneousMedium::fly(float length, const Spectrum& beta, const Wavelengths& w, HashRng& rng) const {
  const Spectrum absorbed = sigma_a.evaluate(w), scattered = sigma_s.evaluate(w);
  const Spectrum extinction = absorbed + scattered;
  const Spectrum through = attenuation(extinction, length);
  Flight flight;
  if (scattered.is_black()) {
    flight.weight = through;
    return flight;
  }
  float total = 0;
  for (int i = 0; i < channels; ++i) total += beta[i];
  float pick = rng.next() * total;
  int chosen = channels - 1;
  while (chosen > 0 && !(beta[chosen] > 0)) --chosen;  // in case rounding leaves none
  for (int i = 0; i < chosen; ++i) {
    pick -= beta[i];
    if (pick < 0) chosen = i;
  }
  const float distance = extinction[chosen] > 0 ? -std::log1p(-rng.next()) / extinction[chosen] : infinity;
  const bool scatters = distance < length;
  const Spectrum arrived = scatters ? attenuation(extinction, distance) : through;
  const Spectrum event = scatters ? arrived * extinction : arrived;
  float density = 0;
  for (int i = 0; i < channels; ++i) density += beta[i] / total * event[i];
  if (scatters) flight.distance = distance;
  flight.pdf = density;
  flight.weight = (scatters ? arrived * scattered : arrived) / density;
  return flight;
}

}  // namespace lanthorn
