// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Fibres that stand out of a surface, as in velvet:
//   Estevez & Kulla 2017: Production Friendly Microfacet Sheen BRDF [E17]
//   Neubelt & Pettineo 2013: Crafting a Next-Gen Material Pipeline for The Order: 1886 [N13]
#pragma once

#include <optional>

#include "surface/closure.h"
#include "surface/plastic.h"

namespace lanthorn {

/// glTF's KHR_materials_sheen: f = sheen D V + base (1 - m max(E(wi), E(wo))), with the distribution D of [E17 eq. 2],
/// the visibility V of [N13], the albedo E of D V, and the largest component m of the sheen's colour. Symmetric. Narrow
/// fibres have an E above 1 at grazing angles: there D V is divided by the larger E of the two directions.
struct Cloth {
  static constexpr ClosureTraits traits{.is_fibre = false, .transmits = false};
  static constexpr float least_alpha = 0.02f;

  Plastic base;
  Spectrum sheen{};     ///< colour of the fibres, in [0,1]
  float alpha = 0.25f;  ///< their width, in [least_alpha, 1]: the wider, the less confined to grazing angles
};

/// Albedo of white fibres, at a cosine in [0,1]; somewhat less at grazing angles, see above.
float sheen_albedo(float alpha, float cos);

// Functions of every closure: meanings, units and conventions as for `Bsdf` (bsdf.h).

BsdfValue evaluate(const Cloth& c, const Vec3& wi, const Vec3& wo, Transport transport, BsdfParts parts);
std::optional<BsdfSample> sample(const Cloth& c, const Vec3& wi, float u_lobe, const Vec2& u, Transport transport);
Spectrum albedo(const Cloth& c, const Vec3& wi);
LobeWeights lobe_weights(const Cloth& c, const Vec3& wi);
inline bool has_non_delta(const Cloth& /*fibres*/) { return true; }
inline bool is_dispersive(const Cloth& /*any*/) { return false; }
SplitTerms split_terms(const Cloth& c, const Vec3& wi);

}  // namespace lanthorn
