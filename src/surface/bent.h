// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Reflection where the shading normal n_s differs from the geometric normal n. With n_s alone, lobes lead below the
// surface: light would come through a wall, and metals of few facets would get black rims. Nothing passes here.
//
// Mirrors and metals. The surface's plane reflects light from below once more. The idea is from
//   Schüssler, Heitz, Hanika, Dachsbacher 2017: Microfacet-based Normal Mapping for Robust Monte Carlo Path Tracing
// but the plane stands in for their facets. Let P be the mirror image in the plane. If both the light's direction l and
// the eye's direction e are above the plane, the eye sees the fraction
//   f(e, l) |cos l| + f(e, P l) |cos P l|,    cosines to n_s.
// Integrated over all l, this is all light that f(e, .) reflects: the albedo is that of the closure alone.
//
// Other lobes. Mirroring them would make the facets visible. They receive light from above the horizon alone: the plane
// of the smooth surface, if the facet stands in for one that bulges out (`SurfacePoint::rise`), otherwise the facet's.
// A cosine lobe tilted by the angle θ has (1 + cos θ) / 2 of its light above the horizon; `bend` divides the
// reflectance of diffuse surfaces by that share, so that their albedo stays. An eye below the plane of n_s, at a
// silhouette, sees what its mirror image in that plane sees.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <type_traits>

#include "math/frame.h"
#include "math/sampling.h"
#include "surface/closure.h"
#include "surface/conductor.h"
#include "surface/diffuse.h"

namespace lanthorn {

/// An opaque closure on a facet. The directions of eye and light are on the same side of the facet. On the side from
/// which the ray came that found the facet, an eye walk may also go to light between horizon and facet.
template <Closure C>
struct Bent {
  static constexpr ClosureTraits traits{.is_fibre = false, .transmits = false};

  C closure{};
  Normal plane{0, 0, 1};    ///< the geometric normal, in the shading frame; plane.z >= 0
  Normal horizon{0, 0, 1};  ///< normal of the plane above which light comes from; on the same side as `plane`
};

namespace bent_detail {

/// True if all lobes of the closure are mirrored; otherwise only its delta lobes are.
template <class C>
inline constexpr bool mirrored = std::is_same_v<C, Conductor>;

/// True if the closure has delta lobes beside others, which are not mirrored; `is_smooth` says so. Rough coats cannot
/// tell which lobe light belongs to, and rough plastic as a whole scatters like a matte surface.
template <class C>
bool has_delta_lobes(const C& closure) {
  if constexpr (requires { is_smooth(closure); }) return is_smooth(closure);
  return false;
}

template <class C>
Vec3 image(const Bent<C>& b, const Vec3& w) {
  return w - 2 * dot(w, b.plane) * b.plane;
}
template <class C>
bool is_above(const Bent<C>& b, const Vec3& wi, const Vec3& wo) {
  return dot(wi, b.plane) * dot(wo, b.plane) > 0;
}
/// True if a light walk that arrives from `l` may treat its light as coming from P l, and so leave along S P l, where S
/// is the reflection by n_s. S l then is above the plane, too. True for all light that the eye needs, except light that
/// rough metals send to eyes behind the shading normal; these see too little.
template <class C>
bool has_image(const Bent<C>& b, const Vec3& l) {
  const Vec3 image_of_l = image(b, l);
  return is_above(b, l, {-image_of_l.x, -image_of_l.y, image_of_l.z});
}
/// |cos P l| / |cos l|.
inline float cosine_ratio(const Vec3& image_of_l, const Vec3& l) {
  return std::fabs(image_of_l.z) / std::max(1e-6f, std::fabs(l.z));
}

// # Lobes that are not mirrored

/// The mirror image in the plane of n_s.
inline Vec3 turned(const Vec3& w) { return {w.x, w.y, -w.z}; }
/// The eye's direction on the side of n_s on which it sees the facet.
template <class C>
Vec3 upright(const Bent<C>& b, const Vec3& e) {
  return e.z * dot(e, b.plane) < 0 ? turned(e) : e;
}
/// True if the eye at `e` sees light from `l`. The closure itself sees to it that l is above the plane of n_s.
template <class C>
bool is_lit(const Bent<C>& b, const Vec3& e, const Vec3& l) {
  return dot(e, b.plane) * dot(l, b.horizon) > 0;
}
/// True if two eyes above the facet see the same, at `e` and at its mirror image in the plane of n_s.
template <class C>
bool is_seen_twice(const Bent<C>& b, const Vec3& e) {
  return is_above(b, e, turned(e));
}
/// Density with which a light walk from `l` chooses the eye at `e`, above the facet; `own`: that of the closure itself.
template <class C>
float pdf_of_eye(const Bent<C>& b, const Vec3& l, const Vec3& e, float own) {
  if (is_seen_twice(b, e)) own *= 0.5f;
  return has_delta_lobes(b.closure) && has_image(b, l) ? 0.5f * own : own;
}
/// Diffuse surfaces send light to all eyes above the facet, by the geometric cosine.
inline float pdf_of_eye(const Bent<Diffuse>& b, const Vec3& l, const Vec3& e, float /*own*/) {
  return same_hemisphere(l, upright(b, e)) ? pdf_cosine_hemisphere(std::fabs(dot(e, b.plane))) : 0.0f;
}

/// The value for a walk from the eye: `pdf` is the density of the light, `pdf_reverse` of the eye. `own`: that of the
/// closure itself.
template <class C>
BsdfValue with_image(const Bent<C>& b, const Vec3& e, const Vec3& l, BsdfValue own, const BsdfParts& parts) {
  const Vec3 image_of_l = image(b, l);
  const bool is_seen = has_image(b, l);
  const BsdfValue mirrored_light = evaluate(b.closure, e, image_of_l, Transport::radiance,
                                            {parts.f && is_seen, parts.pdf, parts.pdf_reverse && is_seen});
  own.pdf += mirrored_light.pdf;
  if (!is_seen) return own;
  own.f += mirrored_light.f * cosine_ratio(image_of_l, l);
  own.pdf_reverse = 0.5f * (own.pdf_reverse + mirrored_light.pdf_reverse);
  return own;
}

}  // namespace bent_detail

// Functions of every closure: meanings, units and conventions as for `Bsdf` (bsdf.h).

template <class C>
BsdfValue evaluate(const Bent<C>& b, const Vec3& wi, const Vec3& wo, Transport transport, BsdfParts parts) {
  const bool from_eye = transport == Transport::radiance;
  const Vec3 &e = from_eye ? wi : wo, &l = from_eye ? wo : wi;
  const bool is_above = bent_detail::is_above(b, e, l);
  if constexpr (bent_detail::mirrored<C>) {
    if (!is_above) return {};
    const BsdfValue own = evaluate(b.closure, wi, wo, transport, parts);
    if (from_eye) return bent_detail::with_image(b, e, l, own, parts);
    return reversed(bent_detail::with_image(b, e, l, reversed(own), reversed(parts)));
  } else {
    if (!bent_detail::is_lit(b, e, l)) return {};
    const Vec3 eye = bent_detail::upright(b, e);
    BsdfValue value = evaluate(b.closure, from_eye ? eye : l, from_eye ? l : eye, transport, parts);
    if (!from_eye && !is_above) value.f = {};
    if (!(from_eye ? parts.pdf_reverse : parts.pdf)) return value;
    float& of_eye = from_eye ? value.pdf_reverse : value.pdf;
    of_eye = is_above ? bent_detail::pdf_of_eye(b, l, e, of_eye) : 0.0f;
    return value;
  }
}

namespace bent_detail {

/// The sample with the weight of all ways in which its direction can be chosen.
template <class C>
std::optional<BsdfSample> weighted(const Bent<C>& b, const Vec3& wi, BsdfSample s, Transport transport) {
  const BsdfValue value = evaluate(b, wi, s.wo, transport, {.f = true, .pdf = true});
  if (!(value.pdf > 0)) return {};
  s.pdf = value.pdf;
  s.weight = value.f * (std::fabs(s.wo.z) / s.pdf);
  return s;
}

template <class C>
std::optional<BsdfSample> sample_light(const Bent<C>& b, const Vec3& e, float u_lobe, const Vec2& u) {
  std::optional<BsdfSample> s = sample(b.closure, e, u_lobe, u, Transport::radiance);
  if (!s) return s;
  if (!s->delta && !mirrored<C>) {
    if (e.z * dot(e, b.plane) < 0) s->wo = turned(s->wo);
    return is_lit(b, e, s->wo) ? s : std::nullopt;
  }
  const bool is_below = !is_above(b, e, s->wo);
  if (is_below) s->wo = image(b, s->wo);
  if (!s->delta && (is_below || same_hemisphere(e, image(b, s->wo)))) return weighted(b, e, *s, Transport::radiance);
  return s;
}

/// Of two eyes that see the same, the light walk goes to one at random.
template <class C>
std::optional<BsdfSample> choose_eye(const Bent<C>& b, const Vec3& l, BsdfSample s, bool turns) {
  if (!is_above(b, l, s.wo) || !is_lit(b, s.wo, l) || l.z * dot(l, b.plane) < 0) return {};
  if (!is_seen_twice(b, s.wo)) return s;
  if (turns) s.wo = turned(s.wo);
  s.weight *= 2;
  s.pdf *= 0.5f;
  return s;
}

template <class C>
std::optional<BsdfSample> sample_eye(const Bent<C>& b, const Vec3& l, float u_lobe, const Vec2& u) {
  const auto toss = [&] {
    const bool first = u_lobe < 0.5f;
    u_lobe = first ? 2 * u_lobe : 2 * u_lobe - 1;
    return first;
  };
  const bool turns = !mirrored<C> && toss();
  const bool has_choice = (mirrored<C> || has_delta_lobes(b.closure)) && has_image(b, l);
  const bool takes_image = has_choice && toss();
  const Vec3 from = takes_image ? image(b, l) : l;
  std::optional<BsdfSample> s = sample(b.closure, from, u_lobe, u, Transport::importance);
  if (!s) return s;
  const bool is_mirrored = s->delta || mirrored<C>;
  if (is_mirrored ? !is_above(b, l, s->wo) : takes_image) return {};
  if (has_choice && is_mirrored && !s->delta) return weighted(b, l, *s, Transport::importance);
  if (has_choice) {
    s->weight *= 2 * (takes_image ? cosine_ratio(from, l) : 1.0f);
    s->pdf *= 0.5f;
  }
  return is_mirrored ? s : choose_eye(b, l, *s, turns);
}

inline std::optional<BsdfSample> sample_eye(const Bent<Diffuse>& b, const Vec3& l, float /*u_lobe: one lobe*/,
                                            const Vec2& u) {
  std::optional<BsdfSample> result;
  const float side = dot(l, b.plane) < 0 ? -1.0f : 1.0f;
  const Vec3 e = side * Frame(b.plane).to_world(sample_cosine_hemisphere(u));
  if (!is_lit(b, e, l) || !(side * l.z > 0)) return result;
  BsdfSample& s = result.emplace();
  s.wo = e;
  s.pdf = pdf_cosine_hemisphere(std::fabs(dot(e, b.plane)));
  s.weight = s.pdf > 0 ? b.closure.reflectance * (inv_pi * std::fabs(e.z) / s.pdf) : Spectrum();
  return result;
}

}  // namespace bent_detail

template <class C>
std::optional<BsdfSample> sample(const Bent<C>& b, const Vec3& wi, float u_lobe, const Vec2& u, Transport transport) {
  return transport == Transport::radiance ? bent_detail::sample_light(b, wi, u_lobe, u)
                                          : bent_detail::sample_eye(b, wi, u_lobe, u);
}

/// Share of the light of a cosine lobe around the shading normal that comes from above the horizon.
template <class C>
float share_above_horizon(const Bent<C>& b) {
  return 0.5f * (1 + b.horizon.z);
}

template <class C>
Spectrum albedo(const Bent<C>& b, const Vec3& wi) {
  return albedo(b.closure, wi);
}
inline Spectrum albedo(const Bent<Diffuse>& b, const Vec3& wi) {
  return albedo(b.closure, wi) * share_above_horizon(b);
}
template <class C>
LobeWeights lobe_weights(const Bent<C>& b, const Vec3& wi) {
  return lobe_weights(b.closure, wi);
}
template <class C>
bool has_non_delta(const Bent<C>& b) {
  return has_non_delta(b.closure);
}
template <class C>
bool is_dispersive(const Bent<C>& b) {
  return is_dispersive(b.closure);
}
template <class C>
SplitTerms split_terms(const Bent<C>& b, const Vec3& wi) {
  return split_terms(b.closure, wi);
}
// Split-sum shading takes light from the whole hemisphere of the shading normal.
inline SplitTerms split_terms(const Bent<Diffuse>& b, const Vec3& /*any*/) {
  return {.diffuse = b.closure.reflectance * share_above_horizon(b)};
}

}  // namespace lanthorn
