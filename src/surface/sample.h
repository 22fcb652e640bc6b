// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "math/vec.h"
#include "spectrum/spectrum.h"

namespace lanthorn {

/// What a walk carries: `radiance` (backwards, from the eye) or `importance`'s adjoint, flux from a light.
enum class Transport : std::uint8_t { radiance, importance };

/// What kind of thing a closure is. Every closure has one as its static member `traits`.
struct ClosureTraits {
  bool is_fibre;   ///< scatters all around a line: cosines are those to the plane across it, and there is no area
  bool transmits;  ///< light may go on behind the surface, in the medium there
};

/// A direction drawn from a closure.
struct BsdfSample {
  Vec3 wo{0, 0, 1};           ///< local, unit
  Spectrum weight{};          ///< f * cosine(wo) / pdf, the factor of the walk's throughput; delta lobes included
  float pdf = 0;              ///< per solid angle; for a delta lobe the probability of having chosen it
  float eta = 1;              ///< index ratio (side of wo) / (side of wi); 1 for reflection and thin interfaces
  bool delta = false;         ///< from a delta lobe: pdf and weight have no density counterpart in `pdf`/`eval`
  bool transmission = false;  ///< wo lies on the other side
  bool pdf_is_exact = true;   ///< false where `pdf` is not the density of wo but the approximation that `pdf()` returns
};

/// Share of the albedo (sums to 1, unless the surface is black: all 0) by kind of lobe, for a given wi.
struct LobeWeights {
  float diffuse = 0;  ///< lambertian
  float glossy = 0;   ///< rough microfacet lobes
  float delta = 0;    ///< mirror and clear refraction
  float alpha = 0;    ///< GGX width of the glossy part: geometric mean of alpha_x and alpha_y; the smallest of several
};

}  // namespace lanthorn
