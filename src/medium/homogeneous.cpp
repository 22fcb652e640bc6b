// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "medium/homogeneous.h"

#include <cmath>

namespace lanthorn {

namespace {

constexpr int channels = 4;

// exp(-extinction length). Handles infinite lengths, for which a product with zero extinction would be undefined.
// Reuses the exponential of equal components, as in grey fog.
Spectrum attenuated(const Spectrum& extinction, float length) {
  Spectrum result;
  for (int i = 0; i < channels; ++i) {
    if (i > 0 && extinction[i] == extinction[i - 1])
      result[i] = result[i - 1];
    else
      result[i] = extinction[i] > 0 ? std::exp(-extinction[i] * length) : 1.0f;
  }
  return result;
}

float depth_of(const Spectrum& extinction, float length, const Wavelengths& w) {
  const float mean = w.mean_of(extinction);
  return mean > 0 ? mean * length : 0.0f;
}

}  // namespace

Attenuation HomogeneousMedium::attenuation(float length, const Wavelengths& w) const {
  const Spectrum sigma_t = extinction(w);
  return {attenuated(sigma_t, length), depth_of(sigma_t, length, w)};
}

// ∫ sigma_a L_e T(t) dt over the segment, in closed form.
VolumeEmission HomogeneousMedium::emission_along(float length, const Wavelengths& w) const {
  const Spectrum absorbed = sigma_a.evaluate(w), sigma_t = absorbed + sigma_s.evaluate(w);
  VolumeEmission result{emission.evaluate(w), attenuated(sigma_t, length)};
  for (int i = 0; i < channels; ++i)
    result.emitted[i] *= sigma_t[i] > 0 ? absorbed[i] / sigma_t[i] * (1 - result.transmittance[i]) : 0.0f;
  return result;
}

Flight HomogeneousMedium::fly(float length, const Spectrum& beta, const Wavelengths& w, HashRng& rng) const {
  const Spectrum scattered = sigma_s.evaluate(w), sigma_t = sigma_a.evaluate(w) + scattered;
  Flight flight;
  if (scattered.is_black()) {
    flight.weight = attenuated(sigma_t, length);
    flight.optical_depth = depth_of(sigma_t, length, w);
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
  const float distance = sigma_t[chosen] > 0 ? -std::log1p(-rng.next()) / sigma_t[chosen] : infinity;
  const bool scatters = distance < length;
  const float flown = scatters ? distance : length;
  const Spectrum arrived = attenuated(sigma_t, flown);
  const Spectrum event = scatters ? arrived * sigma_t : arrived;
  float density = 0;
  for (int i = 0; i < channels; ++i) density += beta[i] / total * event[i];
  if (scatters) flight.distance = distance;
  flight.optical_depth = depth_of(sigma_t, flown, w);
  flight.pdf = density;
  flight.weight = (scatters ? arrived * scattered : arrived) / density;
  return flight;
}

}  // namespace lanthorn
