// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "surface/closure.h"
#include "surface/microfacet.h"

namespace lanthorn {

/// A metal: Fresnel reflection on both sides, from a mirror or from Trowbridge-Reitz microfacets.
struct Conductor {
  static constexpr ClosureTraits traits{.is_fibre = false, .transmits = false};

  Spectrum eta{};     ///< real part of the index, relative to the medium outside
  Spectrum k{};       ///< imaginary part (absorption), relative likewise
  float alpha_x = 0;  ///< GGX width along local x; a mirror if both are below `smooth_alpha_limit`
  float alpha_y = 0;  ///< GGX width along local y
};

/// The conductor with reflectance `reflectance` (clamped to [0, 0.9999]) at normal incidence: eta = 1, k = 2 sqrt(r /
/// (1 - r)).
Conductor conductor_from_reflectance(const Spectrum& reflectance, float alpha_x, float alpha_y);

inline bool is_smooth(const Conductor& c) { return effectively_smooth(c.alpha_x, c.alpha_y); }

// Functions of every closure: meanings, units and conventions as for `Bsdf` (bsdf.h).

BsdfValue evaluate(const Conductor& c, const Vec3& wi, const Vec3& wo, Transport transport, BsdfParts parts);
std::optional<BsdfSample> sample(const Conductor& c, const Vec3& wi, float u_lobe, const Vec2& u, Transport transport);
Spectrum albedo(const Conductor& c, const Vec3& wi);
LobeWeights lobe_weights(const Conductor& c, const Vec3& wi);
inline bool has_non_delta(const Conductor& c) { return !is_smooth(c); }
inline bool is_dispersive(const Conductor& /*any*/) { return false; }
SplitTerms split_terms(const Conductor& c, const Vec3& wi);

}  // namespace lanthorn
