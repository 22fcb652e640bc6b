// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <concepts>
#include <cstdint>
#include <optional>
#include <variant>

#include "math/vec.h"
#include "spectrum/spectrum.h"

namespace lanthorn {

/// Quantity that a walk carries: `radiance`, traced backwards from the eye, or (`importance`) flux from a light.
enum class Transport : std::uint8_t { radiance, importance };

/// Kind of a closure. Every closure has a static member `traits` of this type.
struct ClosureTraits {
  bool is_fibre;   ///< scatters all around a line: cosines are to the plane across it, and it has no area
  bool transmits;  ///< light may continue behind the surface, in the medium there

  /// True if all light leaves a surface on the side on which it arrives.
  constexpr bool is_opaque() const { return !is_fibre && !transmits; }
};

/// A direction sampled from a closure.
struct BsdfSample {
  Vec3 wo{0, 0, 1};           ///< local, unit
  Spectrum weight{};          ///< f * cosine(wo) / pdf, to be multiplied into the throughput; delta lobes included
  float pdf = 0;              ///< per solid angle; for a delta lobe the probability of choosing the lobe
  float eta = 1;              ///< index ratio (side of wo) / (side of wi); 1 for reflection and thin interfaces
  bool delta = false;         ///< from a delta lobe: `evaluate` does not include this pdf and weight
  bool transmission = false;  ///< wo lies on the other side
  bool pdf_is_exact = true;   ///< false if `pdf` is not the density of wo but the approximation of `evaluate`
};

/// How a closure scatters between wi and wo; for the meaning of each part see `evaluate` in bsdf.h.
struct BsdfValue {
  Spectrum f{};           ///< 1/sr, without the cosine
  float pdf = 0;          ///< of sampling wo from wi, per solid angle
  float pdf_reverse = 0;  ///< of sampling wi from wo
};

/// The parts of a BsdfValue that a caller asks for. The others have any value: closures leave out what costs time.
struct BsdfParts {
  bool f = false, pdf = false, pdf_reverse = false;
};
inline constexpr BsdfParts all_parts{.f = true, .pdf = true, .pdf_reverse = true};

/// A direction that some lobe has drawn, as a sample of all lobes: `value` has their f and pdf there. nullopt if the
/// pdf is 0. `cos`: the cosine factor of wo.
inline std::optional<BsdfSample> sample_of_all(const Vec3& wo, float cos, const BsdfValue& value) {
  if (!(value.pdf > 0)) return std::nullopt;
  return BsdfSample{.wo = wo, .weight = value.f * (cos / value.pdf), .pdf = value.pdf};
}

/// A value, and the question for it, as the walk sees them that follows the path the other way.
constexpr BsdfValue reversed(const BsdfValue& v) { return {v.f, v.pdf_reverse, v.pdf}; }
constexpr BsdfParts reversed(const BsdfParts& p) { return {p.f, p.pdf_reverse, p.pdf}; }

/// GGX width at which following a lobe and gathering photons have about equal noise.
inline constexpr float half_spread_alpha = 0.1f;

/// Share of the light of a GGX lobe of this width that spreads widely: alpha² / (alpha² + 0.1²).
inline float spread_of_lobe(float alpha) { return sqr(alpha) / (sqr(alpha) + sqr(half_spread_alpha)); }

/// Probability of sampling a GGX lobe of this albedo and width rather than a diffuse one. Proportional to the albedos
/// if the lobe is wide, and to their square roots if it is narrow: next-event estimation finds the light of wide lobes,
/// but the narrower a lobe is, the more of its light only its own samples find. 0 if both are black.
inline float lobe_probability(float albedo, float alpha, float diffuse) {
  if (!(albedo > 0)) return 0;
  const float ratio = diffuse / albedo, spread = spread_of_lobe(alpha);
  return spread / (1 + ratio) + (1 - spread) / (1 + std::sqrt(ratio));
}

/// Share of the albedo by kind of lobe, for a given wi. Sums to 1, or to 0 if the surface is black.
struct LobeWeights {
  float diffuse = 0;  ///< lambertian
  float glossy = 0;   ///< rough microfacet lobes
  float delta = 0;    ///< mirror and clear refraction
  float alpha = 0;    ///< GGX width of the glossy lobes, sqrt(alpha_x alpha_y); the smallest if there are several
};

/// A closure as split-sum shading represents it (Karis 2013): Lambertian reflection, one GGX lobe with Schlick's
/// Fresnel term, and sheen.
struct SplitTerms {
  Spectrum diffuse{};             ///< reflectance for light from the viewer's side
  Spectrum diffuse_behind{};      ///< transmittance for light from the other side
  Spectrum f0{}, f90{};           ///< Fresnel term of the lobe at normal incidence and at grazing angles
  float alpha = 0;                ///< its GGX width
  Spectrum sheen{};               ///< reflectance of fibres for light from the viewer's side
  const char* missing = nullptr;  ///< name of the part of the closure that is left out, for messages
};

/// Functions that every closure must have; for meanings, units and conventions see `Bsdf` in bsdf.h. A type that lacks
/// one cannot be an alternative of `Bsdf`. Without this check, a call would find the function of `Bsdf` itself, to
/// which closures convert, and never return.
template <class C>
concept Closure = requires(const C c, const Vec3 w, float u_lobe, const Vec2 u, Transport transport, BsdfParts parts) {
  { C::traits } -> std::convertible_to<ClosureTraits>;
  { evaluate(c, w, w, transport, parts) } -> std::same_as<BsdfValue>;
  { sample(c, w, u_lobe, u, transport) } -> std::same_as<std::optional<BsdfSample>>;
  { albedo(c, w) } -> std::same_as<Spectrum>;
  { lobe_weights(c, w) } -> std::same_as<LobeWeights>;
  { has_non_delta(c) } -> std::same_as<bool>;
  { is_dispersive(c) } -> std::same_as<bool>;
  { split_terms(c, w) } -> std::same_as<SplitTerms>;
};

template <Closure... Closures>
using ClosureVariant = std::variant<Closures...>;

}  // namespace lanthorn
