// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// A diffuse base under a rough dielectric surface in closed form, without random walks in between:
//   Kelemen & Szirmay-Kalos 2001: A Microfacet Based Coupled Specular-Matte BRDF Model [K01]
//   Schlick 1994: An Inexpensive BRDF Model for Physically-based Rendering [S94]
#pragma once

#include <optional>

#include "surface/closure.h"
#include "surface/microfacet.h"
#include "surface/thin_film.h"

namespace lanthorn {

/// GGX reflection with Schlick's Fresnel term, f0 + (f90 - f0)(1 - cos)^5 [S94 eq. 15], over a diffuse base that
/// receives the light that is not reflected [K01 eq. 5]: with E the albedo of the reflection, the base has f =
/// reflectance / pi (1 - E(wi)) (1 - E(wo)) / (1 - mean E). Symmetric. The albedo is E + (1 - E) reflectance. The same
/// on both sides. With a film, the Fresnel term of the film on a dielectric of reflectance f0 / f90, times f90,
/// replaces Schlick's.
struct Plastic {
  static constexpr ClosureTraits traits{.is_fibre = false, .transmits = false};

  Spectrum reflectance{};  ///< of the base, in [0,1]
  Spectrum f0{0.04f};      ///< Fresnel reflectance at normal incidence, in [0, f90]
  float f90 = 1;           ///< Fresnel reflectance at grazing angles, in [0,1]
  float alpha = 0;         ///< GGX width, in [0,1]; a mirror below `smooth_alpha_limit`
  ThinFilm film{};
};

inline bool is_smooth(const Plastic& p) { return effectively_smooth(p.alpha, p.alpha); }

/// Albedo of the specular reflection alone, at a cosine in [0,1].
Spectrum specular_albedo(const Plastic& p, float cos);

// Functions of every closure: meanings, units and conventions as for `Bsdf` (bsdf.h).

BsdfValue evaluate(const Plastic& p, const Vec3& wi, const Vec3& wo, Transport transport, BsdfParts parts);
std::optional<BsdfSample> sample(const Plastic& p, const Vec3& wi, float u_lobe, const Vec2& u, Transport transport);
Spectrum albedo(const Plastic& p, const Vec3& wi);
LobeWeights lobe_weights(const Plastic& p, const Vec3& wi);
inline bool has_non_delta(const Plastic& p) { return !is_smooth(p) || !p.reflectance.is_black(); }
inline bool is_dispersive(const Plastic& /*any*/) { return false; }
SplitTerms split_terms(const Plastic& p, const Vec3& wi);

}  // namespace lanthorn
