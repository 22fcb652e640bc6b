// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Scattering at a surface: a closed set of closures, each in its own file, joined into the variant `Bsdf`.
//
// All directions are local to the shading frame (z is the shading normal), have unit length and point away from the
// surface. `wi` points to the previous vertex of the walk, `wo` to the next. f never includes a cosine. Pdfs are per
// solid angle. Delta lobes are excluded from `evaluate`, which gives 0 for them; only `sample` returns them.
#pragma once

#include <array>
#include <concepts>
#include <memory>
#include <optional>
#include <type_traits>
#include <variant>

#include "math/frame.h"
#include "spectrum/spectrum.h"
#include "surface/bent.h"
#include "surface/clear_coated.h"
#include "surface/closure.h"
#include "surface/cloth.h"
#include "surface/coated.h"
#include "surface/conductor.h"
#include "surface/dielectric.h"
#include "surface/diffuse.h"
#include "surface/hair.h"
#include "surface/measured.h"
#include "surface/plastic.h"
#include "surface/thin_dielectric.h"

namespace lanthorn {

namespace bsdf_detail {
template <class...>
struct List {};
template <class... A, class... B>
List<A..., B...> operator+(List<A...>, List<B...>);
template <class... All>
ClosureVariant<All...> variant_of(List<All...>);

template <Closure C>
using Forms = std::conditional_t<C::traits.is_opaque(), List<C, Bent<C>>, List<C>>;
/// All closures. Opaque ones come in two forms: as they are, and bent (bent.h).
template <Closure... Closures>
using WithBentForms = decltype(variant_of((Forms<Closures>() + ...)));
}  // namespace bsdf_detail

using Bsdf =
    bsdf_detail::WithBentForms<Diffuse, DiffuseTransmission, Conductor, Dielectric, ThinDielectric, ClearCoated,
                               CoatedDiffuse, CoatedConductor, CoatedPlastic, Hair, Plastic, Cloth, Measured>;

/// How the surface scatters between wi and wo: f and the densities of both walks along the path, which share most of
/// their work. Gives the parts that are asked for. `transport` is the quantity that the walk from wi to wo carries:
/// `radiance` from the eye, `importance` from a light.
///
/// f(wi, wo), 1/sr, is without the cosine (`cosine`) and without delta lobes. Refraction scales the f of radiance by
/// the squared index ratio, not that of importance. Reflection is the same for both and symmetric, except for hair and
/// bent closures: their f depends on which end of the path is the light and which the eye, not on the walk that asks.
///
/// `pdf` is the density with which `sample` chooses the non-delta direction wo from wi, per solid angle, including the
/// probability of the lobe. For layered closures it may be an approximation: normalised, and positive wherever f is
/// (see `pdf_is_exact`). `pdf_reverse` is the density with which a walk of the other kind, which arrives from wo along
/// the same path, chooses wi.
BsdfValue evaluate(const Bsdf& bsdf, const Vec3& wi, const Vec3& wo, Transport transport, BsdfParts parts = all_parts);

namespace bsdf_detail {
template <class... Closures>
constexpr std::array<ClosureTraits, sizeof...(Closures)> traits_of(const std::variant<Closures...>*) {
  return {Closures::traits...};
}
inline constexpr auto all_traits = traits_of(static_cast<const Bsdf*>(nullptr));
}  // namespace bsdf_detail

/// True for hairs and other fibres (see ClosureTraits).
inline bool is_fibre(const Bsdf& bsdf) { return bsdf_detail::all_traits[bsdf.index()].is_fibre; }
/// True if light may continue behind the surface.
inline bool transmits(const Bsdf& bsdf) { return bsdf_detail::all_traits[bsdf.index()].transmits; }
/// True if all light leaves a surface on the side on which it arrives.
inline bool is_opaque(const Bsdf& bsdf) { return bsdf_detail::all_traits[bsdf.index()].is_opaque(); }

/// The cosine factor of f for light along `w`: |cos| to the normal; on a fibre |cos| to the plane perpendicular to it.
inline float cosine(const Bsdf& bsdf, const Vec3& w) {
  return is_fibre(bsdf) ? cosine_across_fibre(w) : abs_cos_theta(w);
}

/// The reflectance of a closure that is purely Lambertian reflection, of light from above the facet on a bent one; null
/// for all others. Used by irradiance caches.
inline const Spectrum* lambertian_reflectance(const Bsdf& bsdf) {
  if (const auto* diffuse = std::get_if<Diffuse>(&bsdf)) return &diffuse->reflectance;
  const auto* facet = std::get_if<Bent<Diffuse>>(&bsdf);
  return facet ? &facet->closure.reflectance : nullptr;
}

/// Samples wo. `u_lobe` and `u` are uniform in [0,1). Returns nullopt if the walk is absorbed or wo is below the
/// horizon.
std::optional<BsdfSample> sample(const Bsdf& bsdf, const Vec3& wi, float u_lobe, const Vec2& u, Transport transport);

/// Fraction of light from wi that is scattered (reflected or transmitted); approximate for rough and layered closures.
/// Use it for the albedo layer and Russian roulette only, never in estimators.
Spectrum albedo(const Bsdf& bsdf, const Vec3& wi);

/// Shares of the closure's albedo by kind of lobe, for caches.
LobeWeights lobe_weights(const Bsdf& bsdf, const Vec3& wi);

/// The closure as split-sum shading represents it. For layered closures, light that the coat's surface does not reflect
/// counts as diffuse or, over metal, as the metal's lobe.
SplitTerms split_terms(const Bsdf& bsdf, const Vec3& wi);

/// True if some lobe is not a delta function, so that f can be positive.
inline bool has_non_delta(const Bsdf& bsdf) {
  return std::visit([](const auto& closure) { return has_non_delta(closure); }, bsdf);
}
/// True if the index of refraction holds for the hero wavelength only.
inline bool is_dispersive(const Bsdf& bsdf) {
  return std::visit([](const auto& closure) { return is_dispersive(closure); }, bsdf);
}

namespace detail {
inline constexpr Bsdf no_closure{};
}

/// The closure at a point: the material's own closure if that is the same everywhere, as in most materials, otherwise
/// one made for the point. Converts to `Bsdf`. The scene must outlive it.
class PointBsdf {
 public:
  /// Any closure, to be replaced. It is not made in place, because points are default-constructed often.
  PointBsdf() : of_material_(&detail::no_closure) {}
  /// A closure made for the point.
  template <class Closure>
  requires std::constructible_from<Bsdf, const Closure&> PointBsdf(const Closure& closure) : own_(closure) {}
  /// The material's own closure.
  explicit PointBsdf(const Bsdf* of_material) : of_material_(of_material) {}
  PointBsdf(const PointBsdf& other) : of_material_(other.of_material_) { copy_own(other); }
  PointBsdf& operator=(const PointBsdf& other) {
    if (this == &other) return *this;
    of_material_ = other.of_material_;
    copy_own(other);
    return *this;
  }

  /// Replaces the closure by one made for the point.
  template <class Closure>
  requires std::constructible_from<Bsdf, const Closure&>
  void emplace(const Closure& closure) {
    std::construct_at(&own_, closure);
    of_material_ = nullptr;
  }

  const Bsdf& get() const { return of_material_ != nullptr ? *of_material_ : own_; }
  operator const Bsdf&() const { return get(); }

 private:
  static_assert(std::is_trivially_copyable_v<Bsdf>);
  void copy_own(const PointBsdf& other) {
    if (of_material_ == nullptr) std::construct_at(&own_, other.own_);
  }

  const Bsdf* of_material_ = nullptr;
  union {
    // Constructed only if of_material_ is null, because points are copied often.
    Bsdf own_;  // NOLINT(readability-identifier-naming): private, which clang-tidy does not see of a union's member
  };
};

/// True if the closure is another one on facets whose shading normal is not the geometric one (`Bent`): if no light
/// passes through the surface.
bool is_bendable(const Bsdf& bsdf);
/// Replaces such a closure by that of a facet with the normals `plane` and `horizon`, unit, in the shading frame.
/// Returns false if it stays, because `plane` is the shading normal up to rounding.
bool bend(PointBsdf& bsdf, const Normal& plane, const Normal& horizon);

}  // namespace lanthorn
