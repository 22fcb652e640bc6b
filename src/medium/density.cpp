// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "medium/density.h"

#include <algorithm>

#include "math/noise.h"

namespace lanthorn {

namespace {

// Gradient of the noise by finite differences; accuracy does not matter, as it only distorts the cloud.
Vec3 noise_gradient(const Point& p) {
  constexpr float step = 0.01f;
  const float here = perlin_noise(p);
  return Vec3(perlin_noise(p + Vec3(step, 0, 0)) - here, perlin_noise(p + Vec3(0, step, 0)) - here,
              perlin_noise(p + Vec3(0, 0, step)) - here) /
         step;
}

}  // namespace

float GridDensity::bound(const Bounds& cell) const {
  float largest = 0;
  grid.for_each_in(cell, [&](float value) { largest = std::max(largest, value); });
  return largest;
}

float CloudDensity::at(const Point& p) const {
  if (glm::any(glm::lessThan(p, region.min)) || glm::any(glm::greaterThan(p, region.max))) return 0;
  Point q = frequency * p;
  if (wispiness > 0) {
    float amount = 0.05f * wispiness, scale = 10;
    for (int octave = 0; octave < 2; ++octave) {
      q += amount * noise_gradient(scale * q);
      amount *= 0.5f;
      scale *= 1.99f;
    }
  }
  const float thickness = std::clamp((1 - p.y) * 4.5f * density * fbm(q, 0.5f, 5), 0.0f, 1.0f);
  return std::clamp(thickness + 2 * std::max(0.0f, 0.5f - p.y), 0.0f, 1.0f);
}

}  // namespace lanthorn
