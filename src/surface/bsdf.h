// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Scattering at a surface: a closed set of closures, each in a file of its own, joined into the variant `Bsdf`.
//
// All directions are local to the shading frame (z is the shading normal), unit length and point away from the surface.
// `wi` points to the previous vertex of the walk, `wo` to the next. `eval` never contains a cosine; pdfs are per solid
// angle of `wo`. Delta lobes are invisible to `eval` and `pdf` (both 0 for them) and come out of `sample` alone.
#pragma once

#include <array>
#include <optional>
#include <variant>

#include "math/frame.h"
#include "spectrum/spectrum.h"
#include "surface/coated.h"
#include "surface/conductor.h"
#include "surface/dielectric.h"
#include "surface/diffuse.h"
#include "surface/hair.h"
#include "surface/measured.h"
#include "surface/plastic.h"
#include "surface/sample.h"
#include "surface/thin_dielectric.h"

namespace lanthorn {

using Bsdf = std::variant<Diffuse, DiffuseTransmission, Conductor, Dielectric, ThinDielectric, CoatedDiffuse,
                          CoatedConductor, Hair, Plastic, Measured>;

/// f(wi, wo), 1/sr, without cosine (`cosine`) and without delta lobes. `transport` says what the walk carries:
/// `radiance` from the eye (f is scaled by the squared index ratio at refraction), `importance` from a light (not
/// scaled). For reflection both are equal and symmetric, but on hair.
Spectrum eval(const Bsdf& bsdf, const Vec3& wi, const Vec3& wo, Transport transport);

/// Density of `sample` choosing the non-delta direction `wo` from `wi`, including the probability of choosing among
/// lobes; per solid angle. Need not be exact for layered closures (then it is a normalised approximation that is
/// positive wherever `eval` is): see `pdf_is_exact`.
float pdf(const Bsdf& bsdf, const Vec3& wi, const Vec3& wo);

/// `pdf` on the way back: the density with which a walk that comes from `wo` along the same path chooses `wi`.
float pdf_reverse(const Bsdf& bsdf, const Vec3& wi, const Vec3& wo);

namespace bsdf_detail {
template <class... Closures>
constexpr std::array<ClosureTraits, sizeof...(Closures)> traits_of(const std::variant<Closures...>*) {
  return {Closures::traits...};
}
inline constexpr auto all_traits = traits_of(static_cast<const Bsdf*>(nullptr));
}  // namespace bsdf_detail

/// True for hairs and other fibres (see ClosureTraits).
inline bool is_fibre(const Bsdf& bsdf) { return bsdf_detail::all_traits[bsdf.index()].is_fibre; }
/// True if light may go on behind the surface.
inline bool transmits(const Bsdf& bsdf) { return bsdf_detail::all_traits[bsdf.index()].transmits; }

/// What f is multiplied by for light along `w`: |cos| to the normal, on a fibre to the plane across it.
inline float cosine(const Bsdf& bsdf, const Vec3& w) {
  return is_fibre(bsdf) ? cosine_across_fibre(w) : abs_cos_theta(w);
}

/// The reflectance of a closure that is Lambertian reflection and nothing else; null of all others. For caches of
/// irradiance.
inline const Spectrum* lambertian_reflectance(const Bsdf& bsdf) {
  const auto* diffuse = std::get_if<Diffuse>(&bsdf);
  return diffuse ? &diffuse->reflectance : nullptr;
}

/// Draws wo. `u_lobe` and `u` are uniform in [0,1). Empty if absorbed or below the horizon.
std::optional<BsdfSample> sample(const Bsdf& bsdf, const Vec3& wi, float u_lobe, const Vec2& u, Transport transport);

/// Fraction of light from wi that is scattered (reflected or transmitted), approximate for rough and layered closures.
/// For the albedo layer and for roulette, never for estimates.
Spectrum albedo(const Bsdf& bsdf, const Vec3& wi);

/// How the closure's albedo divides among kinds of lobes; what caches decide by.
LobeWeights lobe_weights(const Bsdf& bsdf, const Vec3& wi);

/// True if some lobe is not a delta function, so that `eval` can be positive.
bool has_non_delta(const Bsdf& bsdf);
/// True if the index of refraction in use holds for the hero wavelength alone.
bool is_dispersive(const Bsdf& bsdf);

}  // namespace lanthorn
