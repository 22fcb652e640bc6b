// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "math/frame.h"
#include "surface/closure.h"

namespace lanthorn {

/// A hair or a strand of fur: a dielectric cylinder with absorption inside (Chiang, Bitterli, Tappan, Burley 2016, "A
/// Practical and Controllable Hair and Fur Model for Production Path Tracing"; Marschner et al. 2003). The frame's x
/// axis runs along the hair. Light is scattered in all directions. The hair is a line whose width faces every
/// direction, so f must be multiplied by the cosine of the inclination to the plane across the hair, not the
/// cosine to z (Marschner et al. 2003, eq. 1).
///
/// f depends on the offset at which the eye's ray meets the hair; light arrives over the whole width alike. Each ray
/// has its own offset, measured along (direction away from the hair) x (x axis). So a walk from the eye uses the offset
/// of the ray that has arrived, and a walk from a light the offset of the ray that leaves.
struct Hair {
  static constexpr ClosureTraits traits{.is_fibre = true, .transmits = false};

  Spectrum sigma_a{};                  ///< absorption coefficient inside, per radius of the hair
  float h = 0;                         ///< offset of the ray wi across the width, in [-1, 1]
  float eta = 1.55f;                   ///< index of refraction, above 1
  float beta_m = 0.3f, beta_n = 0.3f;  ///< roughness along and around the hair, in [0,1]
  float alpha = 2;                     ///< tilt of the cuticle's scales, degrees
  float h_out = 0;                     ///< offset of the ray wo across the width
  /// The hair is painted on a surface that does not face every ray, such as a ribbon: h and h_out hold for rays above
  /// the surface, and have the opposite sign for rays below it.
  bool is_on_surface = false;
};

/// Absorption coefficient for which a mass of such hair has about this colour seen from outside (Chiang et al. 2016,
/// eq. 9).
float hair_absorption(float reflectance, float beta_n);

// Functions of every closure: meanings, units and conventions as for `Bsdf` (bsdf.h).

BsdfValue evaluate(const Hair& hair, const Vec3& wi, const Vec3& wo, Transport transport, BsdfParts parts);
std::optional<BsdfSample> sample(const Hair& hair, const Vec3& wi, float u_lobe, const Vec2& u, Transport transport);
Spectrum albedo(const Hair& hair, const Vec3& wi);
/// Glossy and narrow, so that no cache gathers over a surface neighbourhood on a hair.
inline LobeWeights lobe_weights(const Hair& /*any*/, const Vec3& /*any*/) { return {.glossy = 1, .alpha = 0}; }
inline bool has_non_delta(const Hair& /*any*/) { return true; }
inline bool is_dispersive(const Hair& /*any*/) { return false; }
inline SplitTerms split_terms(const Hair& /*any*/, const Vec3& /*any*/) { return {.missing = "hair"}; }

/// |cos| of a direction to the plane perpendicular to the hair.
inline float cosine_across_fibre(const Vec3& w) { return safe_sqrt(1 - sqr(w.x)); }

}  // namespace lanthorn
