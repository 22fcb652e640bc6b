// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "surface/metal_rgb.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "spectrum/cie.h"
#include "spectrum/wavelengths.h"
#include "surface/fresnel.h"

namespace lanthorn {

namespace {

constexpr float grazing_cosine = 1.0f / 7;  // 82 degrees

float reflectance(float cosine, float n, float k) { return fresnel_conductor(cosine, Spectrum(n), Spectrum(k))[0]; }

// Reflectance of the spectrum under D65, by channel.
std::array<float, 3> reflectance_under_white(float cosine, const SpectrumCurve& eta, const SpectrumCurve& k) {
  constexpr int steps = 1024;
  std::array<double, 3> sum{};
  for (int i = 0; i < steps; ++i) {
    const Wavelengths w = Wavelengths::spectral((static_cast<float>(i) + 0.5f) / steps);
    Spectrum light = fresnel_conductor(cosine, eta.evaluate(w), k.evaluate(w));
    for (int c = 0; c < 4; ++c) light[c] *= illuminant_d65.at(w.lambda[static_cast<unsigned>(c)]);
    const Rgb rgb = w.to_rgb(light);
    sum[0] += static_cast<double>(rgb.r);
    sum[1] += static_cast<double>(rgb.g);
    sum[2] += static_cast<double>(rgb.b);
  }
  std::array<float, 3> result{};
  for (std::size_t c = 0; c < 3; ++c) result[c] = std::clamp(static_cast<float>(sum[c] / steps), 1e-3f, 0.9999f);
  return result;
}

// Absorption that gives the reflectance `r` at normal incidence.
float absorption(float n, float r) {
  return std::sqrt(std::fmax(0.0f, (r * (n + 1) * (n + 1) - (n - 1) * (n - 1)) / (1 - r)));
}

// The index whose reflectance at the grazing angle is nearest to `grazing`, among those with `normal` at normal
// incidence.
float index_for(float normal, float grazing) {
  const float root = std::sqrt(normal);
  float low = std::log((1 - root) / (1 + root)), high = -low;
  const auto error = [&](float log_n) {
    const float n = std::exp(log_n);
    return std::fabs(reflectance(grazing_cosine, n, absorption(n, normal)) - grazing);
  };
  // The nearest of equal steps, then ten times finer around it.
  for (int round = 0; round < 5; ++round) {
    constexpr int steps = 40;
    const float step = (high - low) / steps;
    float best = low;
    for (int i = 1; i <= steps; ++i)
      if (const float x = low + step * static_cast<float>(i); error(x) < error(best)) best = x;
    low = best - 2 * step;
    high = best + 2 * step;
  }
  return std::exp(0.5f * (low + high));
}

}  // namespace

void fit_metal_rgb(SpectrumCurve& eta, SpectrumCurve& k) {
  const std::array<float, 3> normal = reflectance_under_white(1, eta, k);
  const std::array<float, 3> grazing = reflectance_under_white(grazing_cosine, eta, k);
  std::array<float, 3> n{}, absorbed{};
  for (std::size_t c = 0; c < 3; ++c) {
    n[c] = index_for(normal[c], grazing[c]);
    absorbed[c] = absorption(n[c], normal[c]);
  }
  eta.rgb = {n[0], n[1], n[2]};
  k.rgb = {absorbed[0], absorbed[1], absorbed[2]};
}

}  // namespace lanthorn
