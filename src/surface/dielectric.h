// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "surface/closure.h"
#include "surface/microfacet.h"
#include "surface/thin_film.h"

namespace lanthorn {

/// The interface of glass, water etc.: Fresnel reflection and refraction, smooth or with Trowbridge-Reitz microfacets
/// (Walter et al. 2007). +z points to the outside.
struct Dielectric {
  static constexpr ClosureTraits traits{.is_fibre = false, .transmits = true};

  float eta = 1.5f;         ///< index ratio (inside, -z) / (outside, +z); 1 transmits everything undeflected
  float alpha_x = 0;        ///< GGX width along local x; smooth if both are below `smooth_alpha_limit`
  float alpha_y = 0;        ///< GGX width along local y
  bool dispersive = false;  ///< eta holds for the hero wavelength only
  Spectrum tint{1};         ///< factor of the light that is transmitted, in [0,1]
  ThinFilm film{};          ///< on the outside
};

inline bool is_smooth(const Dielectric& d) { return d.eta == 1.0f || effectively_smooth(d.alpha_x, d.alpha_y); }

// Functions of every closure: meanings, units and conventions as for `Bsdf` (bsdf.h).

BsdfValue evaluate(const Dielectric& d, const Vec3& wi, const Vec3& wo, Transport transport, BsdfParts parts);
std::optional<BsdfSample> sample(const Dielectric& d, const Vec3& wi, float u_lobe, const Vec2& u, Transport transport);
Spectrum albedo(const Dielectric& d, const Vec3& wi);
inline LobeWeights lobe_weights(const Dielectric& d, const Vec3& /*any*/) {
  return is_smooth(d) ? LobeWeights{.delta = 1} : microfacet_lobe(d.alpha_x, d.alpha_y);
}
inline bool has_non_delta(const Dielectric& d) { return !is_smooth(d); }
inline bool is_dispersive(const Dielectric& d) { return d.dispersive; }
SplitTerms split_terms(const Dielectric& d, const Vec3& wi);
/// Split terms of a coat over a base. `albedo`: of both together; light that the coat does not reflect counts as
/// diffuse.
SplitTerms split_terms_of_coat(const Dielectric& coat, const Spectrum& albedo, const Vec3& wi);

/// A direction sampled from one of the two lobes; used by walks between layers, whose interfaces have no tint and no
/// film.
struct InterfaceSample {
  Vec3 wo{0, 0, 1};  ///< local, unit
  float weight = 0;  ///< f * |cos(wo)| / pdf, the lobe's Fresnel factor included
  float pdf = 0;     ///< per solid angle of wo, given this lobe; 1 for a delta lobe
};
/// Returns nullopt if wo would be on the other side.
std::optional<InterfaceSample> sample_reflection(const Dielectric& d, const Vec3& wi, const Vec2& u);
/// Returns nullopt at total internal reflection.
std::optional<InterfaceSample> sample_transmission(const Dielectric& d, const Vec3& wi, const Vec2& u,
                                                   Transport transport);
/// Density of `sample_transmission`; 0 if the interface is smooth or wo lies on the side of wi.
float pdf_transmission(const Dielectric& d, const Vec3& wi, const Vec3& wo);

}  // namespace lanthorn
