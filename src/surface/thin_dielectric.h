// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "surface/closure.h"
#include "surface/fresnel.h"
#include "surface/microfacet.h"
#include "surface/thin_film.h"

namespace lanthorn {

/// A pane too thin to displace rays, with the reflections between its two faces summed. Smooth: a mirror and a window,
/// both delta lobes. Rough: each microfacet is such a pane, so that transmitted light leaves like reflected light,
/// mirrored to the other side (glTF's KHR_materials_transmission).
struct ThinDielectric {
  static constexpr ClosureTraits traits{.is_fibre = false, .transmits = true};

  float eta = 1.5f;   ///< index ratio of the pane to its surroundings
  float alpha_x = 0;  ///< GGX width along local x; smooth if both are below `smooth_alpha_limit`
  float alpha_y = 0;  ///< GGX width along local y
  Spectrum tint{1};   ///< factor of the transmitted light, in [0,1]
  ThinFilm film{};    ///< on both faces
};

inline bool is_smooth(const ThinDielectric& d) { return effectively_smooth(d.alpha_x, d.alpha_y); }

/// Reflectance of the whole pane for the cosine `cos_i` in [0,1]: R + T^2 R / (1 - R^2) = 2R / (1 + R), with the
/// reflectance R and transmittance T = 1 - R of one face. The rest is transmitted.
inline Spectrum thin_reflectance(const ThinDielectric& d, float cos_i) {
  const Spectrum r = d.film ? film_reflectance(d.film, cos_i, Spectrum(d.eta))
                            : Spectrum(fresnel_dielectric(cos_i, d.eta).reflectance);
  return 2 * r / (Spectrum(1) + r);
}

// Functions of every closure: meanings, units and conventions as for `Bsdf` (bsdf.h).

BsdfValue evaluate(const ThinDielectric& d, const Vec3& wi, const Vec3& wo, Transport transport, BsdfParts parts);
std::optional<BsdfSample> sample(const ThinDielectric& d, const Vec3& wi, float u_lobe, const Vec2& u,
                                 Transport transport);

Spectrum albedo(const ThinDielectric& d, const Vec3& wi);
inline LobeWeights lobe_weights(const ThinDielectric& d, const Vec3& /*any*/) {
  return microfacet_lobe(d.alpha_x, d.alpha_y);
}
inline bool has_non_delta(const ThinDielectric& d) { return !is_smooth(d); }
inline bool is_dispersive(const ThinDielectric& /*any*/) { return false; }
inline SplitTerms split_terms(const ThinDielectric& d, const Vec3& /*any*/) {
  return {.f0 = thin_reflectance(d, 1),
          .f90 = Spectrum(1),
          .alpha = geometric_alpha(d.alpha_x, d.alpha_y),
          .missing = "light through glass"};
}

}  // namespace lanthorn
