// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Reflection where the shading normal n_s differs from the geometric normal n. With n_s alone, lobes lead below the
// surface, into the solid, and metals of few facets get black rims. Here the surface's plane reflects such light once
// more. The idea is from
//   Schüssler, Heitz, Hanika, Dachsbacher 2017: Microfacet-based Normal Mapping for Robust Monte Carlo Path Tracing
// but the plane stands in for their facets. Let P be the mirror image in the plane. If both the light's direction l and
// the eye's direction e are above the plane, the eye sees the fraction
//   f(e, l) |cos l| + f(e, P l) |cos P l|,    cosines to n_s.
// Integrated over all l, this is all light that f(e, .) reflects: the albedo is that of the closure alone.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <type_traits>

#include "surface/closure.h"
#include "surface/conductor.h"
#include "surface/sample.h"
#include "surface/split_terms.h"

namespace lanthorn {

/// A closure that does not transmit. Its delta lobes, and all lobes of closures that are `mirrored`, scatter above the
/// surface's plane only. Other lobes, such as the base below a smooth coat, scatter below the plane as they do above
/// it, as matte surfaces do; mirroring them would make the facets visible.
template <Closure C>
struct Bent {
  static constexpr ClosureTraits traits{.is_fibre = false, .transmits = false};

  C closure{};
  Normal plane{0, 0, 1};  ///< the geometric normal, in the shading frame
};

namespace bent_detail {

/// True if all lobes of the closure are mirrored; otherwise only its delta lobes are.
template <class C>
inline constexpr bool mirrored = std::is_same_v<C, Conductor>;

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
/// rough lobes send to eyes behind the shading normal; these see too little.
template <class C>
bool has_image(const Bent<C>& b, const Vec3& l) {
  const Vec3 image_of_l = image(b, l);
  return is_above(b, l, {-image_of_l.x, -image_of_l.y, image_of_l.z});
}
/// |cos P l| / |cos l|.
inline float cosine_ratio(const Vec3& image_of_l, const Vec3& l) {
  return std::fabs(image_of_l.z) / std::max(1e-6f, std::fabs(l.z));
}

}  // namespace bent_detail

// Functions of every closure: meanings, units and conventions as for `Bsdf` (bsdf.h).

template <class C>
Spectrum eval(const Bent<C>& b, const Vec3& wi, const Vec3& wo, Transport transport) {
  if (bent_detail::mirrored<C> && !bent_detail::is_above(b, wi, wo)) return {};
  Spectrum f = eval(b.closure, wi, wo, transport);
  if constexpr (bent_detail::mirrored<C>) {
    const bool from_eye = transport == Transport::radiance;
    const Vec3 &e = from_eye ? wi : wo, &l = from_eye ? wo : wi;
    const Vec3 image = bent_detail::image(b, l);
    if (same_hemisphere(e, image) && bent_detail::has_image(b, l))
      f += eval(b.closure, e, image, Transport::radiance) * bent_detail::cosine_ratio(image, l);
  }
  return f;
}

/// Density with which a walk of this kind chooses `wo`.
template <class C>
float pdf_of(const Bent<C>& b, const Vec3& wi, const Vec3& wo, Transport transport) {
  constexpr bool mirrored = bent_detail::mirrored<C>;
  if (mirrored && !bent_detail::is_above(b, wi, wo)) return 0;
  const float own = pdf(b.closure, wi, wo);
  if (transport == Transport::radiance) return mirrored ? own + pdf(b.closure, wi, bent_detail::image(b, wo)) : own;
  if (!bent_detail::has_image(b, wi)) return own;
  return 0.5f * (mirrored ? own + pdf(b.closure, bent_detail::image(b, wi), wo) : own);
}
template <class C>
float pdf(const Bent<C>& b, const Vec3& wi, const Vec3& wo) {
  return pdf_of(b, wi, wo, Transport::radiance);
}
template <class C>
float pdf_reverse(const Bent<C>& b, const Vec3& wi, const Vec3& wo) {
  return pdf_of(b, wo, wi, Transport::importance);
}

namespace bent_detail {

/// The sample with the weight of all ways in which its direction can be chosen.
template <class C>
std::optional<BsdfSample> weighted(const Bent<C>& b, const Vec3& wi, BsdfSample s, Transport transport) {
  s.pdf = pdf_of(b, wi, s.wo, transport);
  if (!(s.pdf > 0)) return {};
  s.weight = eval(b, wi, s.wo, transport) * (std::fabs(s.wo.z) / s.pdf);
  return s;
}

template <class C>
std::optional<BsdfSample> sample_light(const Bent<C>& b, const Vec3& e, float u_lobe, const Vec2& u) {
  std::optional<BsdfSample> s = sample(b.closure, e, u_lobe, u, Transport::radiance);
  if (!s || !(s->delta || mirrored<C>)) return s;
  const bool is_below = !is_above(b, e, s->wo);
  if (is_below) s->wo = image(b, s->wo);
  if (!s->delta && (is_below || same_hemisphere(e, image(b, s->wo)))) return weighted(b, e, *s, Transport::radiance);
  return s;
}

template <class C>
std::optional<BsdfSample> sample_eye(const Bent<C>& b, const Vec3& l, float u_lobe, const Vec2& u) {
  const bool has_choice = has_image(b, l), takes_image = has_choice && u_lobe < 0.5f;
  if (has_choice) u_lobe = takes_image ? 2 * u_lobe : 2 * u_lobe - 1;
  const Vec3 from = takes_image ? image(b, l) : l;
  std::optional<BsdfSample> s = sample(b.closure, from, u_lobe, u, Transport::importance);
  if (!s) return s;
  const bool is_mirrored = s->delta || mirrored<C>;
  if (is_mirrored ? !is_above(b, l, s->wo) : takes_image) return {};
  if (!has_choice) return s;
  if (mirrored<C> && !s->delta) return weighted(b, l, *s, Transport::importance);
  s->weight *= 2 * (takes_image ? cosine_ratio(from, l) : 1.0f);
  s->pdf *= 0.5f;
  return s;
}

}  // namespace bent_detail

template <class C>
std::optional<BsdfSample> sample(const Bent<C>& b, const Vec3& wi, float u_lobe, const Vec2& u, Transport transport) {
  return transport == Transport::radiance ? bent_detail::sample_light(b, wi, u_lobe, u)
                                          : bent_detail::sample_eye(b, wi, u_lobe, u);
}

template <class C>
Spectrum albedo(const Bent<C>& b, const Vec3& wi) {
  return albedo(b.closure, wi);
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

}  // namespace lanthorn
