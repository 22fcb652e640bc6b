// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Fresnel's equations for unpolarised light at a plane interface (Born & Wolf, Principles of Optics, §1.5 and §14.2).
#pragma once

#include <algorithm>

#include "math/vec.h"
#include "spectrum/spectrum.h"

namespace lanthorn {

/// Reflection and refraction of a ray at a plane interface between two dielectrics.
struct DielectricFresnel {
  float reflectance = 1;  ///< fraction of the flux reflected; 1 at total internal reflection
  float cos_t = 0;        ///< cosine of the refracted ray with the normal, >= 0; 0 at total internal reflection
};

/// `cos_i` >= 0: cosine of the incident ray with the normal on its side. `eta`: index ratio (far side) / (near side).
inline DielectricFresnel fresnel_dielectric(float cos_i, float eta) {
  const float sin2_t = (1.0f - cos_i * cos_i) / (eta * eta);
  if (sin2_t >= 1.0f) return {};
  const float cos_t = safe_sqrt(1.0f - sin2_t);
  const float parallel = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
  const float perpendicular = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
  return {0.5f * (parallel * parallel + perpendicular * perpendicular), cos_t};
}

/// Direction of the refracted ray, pointing away from the interface (Snell's law in vector form). `wi` lies on the side
/// of the normal `n`; `cos_t` is the refracted cosine of `fresnel_dielectric`.
inline Vec3 refract(const Vec3& wi, const Normal& n, float cos_i, float cos_t, float eta) {
  const float inv_eta = 1.0f / eta;
  return (cos_i * inv_eta - cos_t) * n - inv_eta * wi;
}

/// Reflectance of a conductor of complex index eta + i k relative to the near side, for `cos_i` in [0,1]. 0 for a
/// component with eta = k = 0 (the unused fourth component in RGB mode).
inline Spectrum fresnel_conductor(float cos_i, const Spectrum& eta, const Spectrum& k) {
  constexpr float tiny = std::numeric_limits<float>::min();
  constexpr float most = 1e9f;  // reflects all light; fourth powers stay finite
  const float cos2 = cos_i * cos_i;
  const float sin2 = std::max(0.0f, 1.0f - cos2);
  Spectrum reflectance;
  for (unsigned i = 0; i < 4; ++i) {
    const float n2 = sqr(std::min(eta.v[i], most));
    const float k2 = sqr(std::min(k.v[i], most));
    // a + i b is the complex index times the cosine of the refracted ray: (a + i b)^2 = (eta + i k)^2 - sin^2.
    const float difference = n2 - k2 - sin2;
    const float a2_plus_b2 = std::sqrt(difference * difference + 4 * n2 * k2);
    const float sum = a2_plus_b2 + difference;
    const float a = std::sqrt(0.5f * (sum > 0 ? sum : 0.0f));
    const float s = a2_plus_b2 + cos2;
    const float s_cross = 2 * a * cos_i;
    const float perpendicular = (s - s_cross) / (s + s_cross + tiny);
    const float p = cos2 * a2_plus_b2 + sin2 * sin2;
    const float p_cross = s_cross * sin2;
    const float parallel = perpendicular * (p - p_cross) / (p + p_cross + tiny);
    reflectance.v[i] = n2 + k2 > 0 ? 0.5f * (perpendicular + parallel) : 0.0f;
  }
  return reflectance;
}

}  // namespace lanthorn
