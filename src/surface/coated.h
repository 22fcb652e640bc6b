// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// A dielectric coat over an opaque base, evaluated by random walks between the two that track depth but not position:
//   Guo, Hasan, Zhao 2018: Position-Free Monte Carlo Simulation for Arbitrary Layered BSDFs.
#pragma once

#include <optional>
#include <type_traits>

#include "surface/closure.h"
#include "surface/conductor.h"
#include "surface/dielectric.h"
#include "surface/diffuse.h"
#include "surface/plastic.h"

namespace lanthorn {

/// A coat over `Base`, the same from both sides (light always meets the coat first). `evaluate` gives an unbiased
/// estimate of f by `n_samples` walks, seeded by the two directions: a pure function, exactly symmetric in wi and wo.
/// Its densities are deterministic approximations. `sample` follows one walk, and takes its pdf from `evaluate`
/// (`pdf_is_exact` is false for non-delta samples). The sample's weight is therefore not f * cos / pdf, but has the
/// same mean.
template <class Base>
struct Coated {
  static constexpr ClosureTraits traits{.is_fibre = false, .transmits = false};

  Dielectric coat{};  ///< upper interface; eta is (layer) / (outside)
  Base base{};        ///< the surface below; a conductor's index is relative to the layer, see `under_coat`. Plastic
                      ///< reflects under the coat as it does in air, as glTF's layers do
  float thickness = 0.01f;  ///< optical depth of the layer along the normal; light is attenuated by exp(-thickness/cos)
                            ///< between the interfaces, all of it absorbed if `albedo` is black
  Spectrum albedo{};        ///< scattering albedo of the medium in the layer
  float g = 0;              ///< its Henyey-Greenstein mean cosine, in (-1, 1)
  int max_depth = 10;       ///< walks of more segments than this inside the layer are cut off
  int n_samples = 1;        ///< walks for each f
};
using CoatedDiffuse = Coated<Diffuse>;
using CoatedConductor = Coated<Conductor>;
using CoatedPlastic = Coated<Plastic>;

template <class Base>
bool is_smooth(const Coated<Base>& c) {
  return is_smooth(c.coat);
}

/// Converts the index of `c` from relative to the outside to relative to a layer of index ratio `coat_eta`.
inline Conductor under_coat(Conductor c, float coat_eta) {
  c.eta /= coat_eta;
  c.k /= coat_eta;
  return c;
}

// Functions of every closure: meanings, units and conventions as for `Bsdf` (bsdf.h).

template <class Base>
BsdfValue evaluate(const Coated<Base>& c, const Vec3& wi, const Vec3& wo, Transport transport, BsdfParts parts);
template <class Base>
std::optional<BsdfSample> sample(const Coated<Base>& c, const Vec3& wi, float u_lobe, const Vec2& u,
                                 Transport transport);
template <class Base>
Spectrum albedo(const Coated<Base>& c, const Vec3& wi);
template <class Base>
LobeWeights lobe_weights(const Coated<Base>& c, const Vec3& wi);
template <class Base>
bool has_non_delta(const Coated<Base>& c) {
  return !is_smooth(c.coat) || has_non_delta(c.base) || !c.albedo.is_black();
}
template <class Base>
bool is_dispersive(const Coated<Base>& c) {
  return is_dispersive(c.coat);
}
/// Over metal, the split terms hold the metal's lobe.
template <class Base>
SplitTerms split_terms(const Coated<Base>& c, const Vec3& wi) {
  const Spectrum all = albedo(c, wi);
  if constexpr (std::is_same_v<Base, Conductor>)
    return {.f0 = all,
            .f90 = all,
            .alpha = geometric_alpha(c.base.alpha_x, c.base.alpha_y),
            .missing = "the highlights of coats over metal"};
  else
    return split_terms_of_coat(c.coat, all, wi);
}

}  // namespace lanthorn
