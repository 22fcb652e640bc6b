// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "math/frame.h"
#include "surface/fresnel.h"
#include "surface/sample.h"

namespace lanthorn {

/// A pane too thin to displace rays: a mirror and a window, both delta lobes, with the reflections between its two
/// faces summed.
struct ThinDielectric {
  static constexpr ClosureTraits traits{.is_fibre = false, .transmits = true};

  float eta = 1.5f;  ///< index ratio of the pane to its surroundings
};

/// Reflectance of the whole pane for the cosine `cos_i` in [0,1]: R + T^2 R / (1 - R^2) = 2R / (1 + R), with the
/// reflectance R and transmittance T = 1 - R of one face. The rest is transmitted.
inline float thin_reflectance(const ThinDielectric& d, float cos_i) {
  const float r = fresnel_dielectric(cos_i, d.eta).reflectance;
  return 2 * r / (1 + r);
}

// The functions of every closure have the meanings, units and conventions of those of `Bsdf` in bsdf.h.

inline Spectrum eval(const ThinDielectric& /*delta*/, const Vec3& /*wi*/, const Vec3& /*wo*/, Transport /*any*/) {
  return Spectrum();
}
inline float pdf(const ThinDielectric& /*delta*/, const Vec3& /*wi*/, const Vec3& /*wo*/) { return 0; }

inline std::optional<BsdfSample> sample(const ThinDielectric& d, const Vec3& wi, float u_lobe, const Vec2& /*delta*/,
                                        Transport /*no refraction*/) {
  if (wi.z == 0) return std::nullopt;
  const float r = thin_reflectance(d, abs_cos_theta(wi));
  const bool reflected = u_lobe < r;
  return BsdfSample{.wo = reflected ? Vec3(-wi.x, -wi.y, wi.z) : -wi,
                    .weight = Spectrum(1),
                    .pdf = reflected ? r : 1.0f - r,
                    .delta = true,
                    .transmission = !reflected};
}

inline float pdf_reverse(const ThinDielectric& /*delta*/, const Vec3& /*wi*/, const Vec3& /*wo*/) { return 0; }
inline Spectrum albedo(const ThinDielectric& /*any*/, const Vec3& /*any*/) { return Spectrum(1); }
inline LobeWeights lobe_weights(const ThinDielectric& /*any*/, const Vec3& /*any*/) { return {.delta = 1}; }
inline bool has_non_delta(const ThinDielectric& /*any*/) { return false; }
inline bool is_dispersive(const ThinDielectric& /*any*/) { return false; }

}  // namespace lanthorn
