// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

#include "math/vec.h"
#include "spectrum/spectrum.h"

namespace lanthorn {

/// Quantity that a walk carries: `radiance`, traced backwards from the eye, or (`importance`) flux from a light.
enum class Transport : std::uint8_t { radiance, importance };

/// Kind of a closure. Every closure has a static member `traits` of this type.
struct ClosureTraits {
  bool is_fibre;   ///< scatters all around a line: cosines are to the plane across it, and it has no area
  bool transmits;  ///< light may continue behind the surface, in the medium there
};

/// A direction sampled from a closure.
struct BsdfSample {
  Vec3 wo{0, 0, 1};           ///< local, unit
  Spectrum weight{};          ///< f * cosine(wo) / pdf, to be multiplied into the throughput; delta lobes included
  float pdf = 0;              ///< per solid angle; for a delta lobe the probability of choosing the lobe
  float eta = 1;              ///< index ratio (side of wo) / (side of wi); 1 for reflection and thin interfaces
  bool delta = false;         ///< from a delta lobe: `pdf` and `eval` do not include this pdf and weight
  bool transmission = false;  ///< wo lies on the other side
  bool pdf_is_exact = true;   ///< false if `pdf` is not the density of wo but the approximation that `pdf()` returns
};

/// f(wi, wo) and the density of sampling wo.
struct BsdfValue {
  Spectrum f{};   ///< as from `eval`
  float pdf = 0;  ///< as from `pdf`
};

/// The same, and the density in the reverse direction.
struct BsdfValues : BsdfValue {
  float pdf_reverse = 0;  ///< as from `pdf_reverse`
};

/// Probability of sampling the first of two lobes with these albedos, of which the second is wider. By their roots:
/// next-event estimation finds what lights wide lobes, but the narrower a lobe is, the more of its light only samples
/// find. 0 if both are black.
inline float narrow_lobe_probability(float narrow, float wide) {
  return narrow > 0 ? 1 / (1 + std::sqrt(wide / narrow)) : 0.0f;
}

/// Share of the albedo by kind of lobe, for a given wi. Sums to 1, or to 0 if the surface is black.
struct LobeWeights {
  float diffuse = 0;  ///< lambertian
  float glossy = 0;   ///< rough microfacet lobes
  float delta = 0;    ///< mirror and clear refraction
  float alpha = 0;    ///< GGX width of the glossy lobes, sqrt(alpha_x alpha_y); the smallest if there are several
};

}  // namespace lanthorn
