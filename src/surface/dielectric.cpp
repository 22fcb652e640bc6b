// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Walter, Marschner, Li, Torrance 2007: Microfacet Models for Refraction through Rough Surfaces [W07].
#include "surface/dielectric.h"

#include <algorithm>

#include "surface/fresnel.h"

namespace lanthorn {
namespace {

/// The interface seen from the side of wi: computations take place above it, with wi.z > 0.
struct View {
  float side;  ///< +1 or -1: factor that brings directions above the interface
  float eta;   ///< index ratio (far side) / (near side)

  View(const Dielectric& d, const Vec3& wi) : side(wi.z > 0 ? 1.0f : -1.0f), eta(wi.z > 0 ? d.eta : 1.0f / d.eta) {}
};

/// Refraction scales radiance by the change of solid angle, eta^2, but not flux (Veach 1997, §5.2).
float transport_factor(float eta, Transport transport) {
  return transport == Transport::radiance ? 1.0f / (eta * eta) : 1.0f;
}

/// Reflectance of a microfacet with these Fresnel terms; `cos_i`: cosine on the side of `view`.
Spectrum reflectance(const Dielectric& d, const View& view, float cos_i, const DielectricFresnel& fresnel) {
  if (!d.film) return Spectrum(fresnel.reflectance);
  return film_reflectance(d.film, view.side > 0 ? cos_i : fresnel.cos_t, Spectrum(d.eta));
}

/// The microfacet that refracts between two directions on opposite sides. All directions as seen from above.
struct Refraction {
  Normal m;        ///< refracting normal, m.z > 0
  float dot_i;     ///< dot(wi, m) > 0
  float jacobian;  ///< solid angle of m per solid angle of wo [W07 eq. 17]
};

/// Returns nullopt if no microfacet, seen from its front, refracts i to o.
std::optional<Refraction> refraction_between(const Vec3& i, const Vec3& o, float eta) {
  const Vec3 h = -(i + eta * o);  // [W07 eq. 16]
  const float length2 = length_squared(h);
  if (length2 == 0) return std::nullopt;
  const Normal m = h * (std::copysign(1.0f, h.z) / std::sqrt(length2));
  const float dot_i = dot(i, m);
  const float dot_o = dot(o, m);
  if (dot_i <= 0 || dot_o >= 0) return std::nullopt;
  return Refraction{m, dot_i, eta * eta * -dot_o / sqr(dot_i + eta * dot_o)};
}

struct Transmitted {
  Vec3 wo;
  float weight_over_t;  ///< sample weight without the Fresnel factor and the transport factor
  float pdf;
};

/// Refraction of i at the microfacet m; nullopt if it leaves above the surface.
std::optional<Transmitted> transmit(const TrowbridgeReitz& microfacets, const Vec3& i, const Normal& m, float cos_m,
                                    float cos_t, float eta) {
  const Vec3 o = refract(i, m, cos_m, cos_t, eta);
  if (o.z >= 0) return std::nullopt;
  // dot(o, m) = -cos_t.
  const float jacobian = eta * eta * cos_t / sqr(cos_m - eta * cos_t);
  return Transmitted{o, microfacets.g_over_g1(i, -o), microfacets.visible_d_over_dot(i, m) * cos_m * jacobian};
}

/// wi and wo are on the same side.
BsdfValue evaluate_reflection(const Dielectric& d, const Vec3& wi, const Vec3& wo, BsdfParts parts) {
  const View view(d, wi);
  const HalfwayReflection reflection({d.alpha_x, d.alpha_y}, view.side * wi, view.side * wo);
  const auto reflected = [&](float cos) { return reflectance(d, view, cos, fresnel_dielectric(cos, view.eta)); };
  BsdfValue value;
  if (parts.f || parts.pdf) {
    const Spectrum r = reflected(reflection.cos_i());
    value.f = r * reflection.f();
    value.pdf = mean_component(r) * reflection.pdf();
  }
  if (parts.pdf_reverse) value.pdf_reverse = mean_component(reflected(reflection.cos_o())) * reflection.pdf_reverse();
  return value;
}

/// Without `pdf_reverse`. wi and wo are on opposite sides.
BsdfValue evaluate_refraction(const Dielectric& d, const Vec3& wi, const Vec3& wo, Transport transport) {
  const View view(d, wi);
  const Vec3 i = view.side * wi;
  const Vec3 o = view.side * wo;
  const auto refraction = refraction_between(i, o, view.eta);
  if (!refraction) return {};
  const auto [m, dot_i, jacobian] = *refraction;
  const TrowbridgeReitz microfacets(d.alpha_x, d.alpha_y);
  const Spectrum r = reflectance(d, view, dot_i, fresnel_dielectric(dot_i, view.eta));
  // [W07 eq. 21], for flux.
  const float f = microfacets.d(m) * dot_i * jacobian * microfacets.g_over_cosines(i, -o);
  return {.f = f * transport_factor(view.eta, transport) * (Spectrum(1) - r) * d.tint,
          .pdf = (1 - mean_component(r)) * microfacets.visible_d_over_dot(i, m) * dot_i * jacobian};
}

}  // namespace

BsdfValue evaluate(const Dielectric& d, const Vec3& wi, const Vec3& wo, Transport transport, BsdfParts parts) {
  if (is_smooth(d) || wi.z == 0 || wo.z == 0) return {};
  if ((wi.z > 0) == (wo.z > 0)) return evaluate_reflection(d, wi, wo, parts);
  BsdfValue value;
  if (parts.f || parts.pdf) value = evaluate_refraction(d, wi, wo, transport);
  if (parts.pdf_reverse) value.pdf_reverse = evaluate_refraction(d, wo, wi, transport).pdf;
  return value;
}

std::optional<BsdfSample> sample(const Dielectric& d, const Vec3& wi, float u_lobe, const Vec2& u,
                                 Transport transport) {
  if (wi.z == 0) return std::nullopt;
  const View view(d, wi);
  const Vec3 i = view.side * wi;
  const bool smooth = is_smooth(d);
  const TrowbridgeReitz microfacets(d.alpha_x, d.alpha_y);
  const Normal m = smooth ? Normal(0, 0, 1) : microfacets.sample(i, u);
  const float cos_m = smooth ? i.z : dot(i, m);
  if (cos_m <= 0) return std::nullopt;
  if (d.eta == 1.0f && !d.film) {
    return BsdfSample{.wo = -wi, .weight = d.tint, .pdf = 1, .delta = true, .transmission = true};
  }
  const DielectricFresnel fresnel = fresnel_dielectric(cos_m, view.eta);
  const float cos_t = fresnel.cos_t;
  const Spectrum reflected = reflectance(d, view, cos_m, fresnel);
  const float r = mean_component(reflected);
  if (u_lobe < r) {
    const Vec3 o = 2 * cos_m * m - i;
    if (o.z <= 0) return std::nullopt;
    return BsdfSample{.wo = view.side * o,
                      .weight = reflected / Spectrum(r) * (smooth ? 1.0f : microfacets.g_over_g1(i, o)),
                      .pdf = smooth ? r : 0.25f * r * microfacets.visible_d_over_dot(i, m),
                      .delta = smooth};
  }
  const Spectrum factor = (Spectrum(1) - reflected) / Spectrum(1 - r) * transport_factor(view.eta, transport) * d.tint;
  if (smooth) {
    return BsdfSample{.wo = view.side * refract(i, m, cos_m, cos_t, view.eta),
                      .weight = factor,
                      .pdf = 1.0f - r,
                      .eta = view.eta,
                      .delta = true,
                      .transmission = true};
  }
  const auto through = transmit(microfacets, i, m, cos_m, cos_t, view.eta);
  if (!through) return std::nullopt;
  return BsdfSample{.wo = view.side * through->wo,
                    .weight = through->weight_over_t * factor,
                    .pdf = (1.0f - r) * through->pdf,
                    .eta = view.eta,
                    .transmission = true};
}

Spectrum albedo(const Dielectric& d, const Vec3& wi) {
  if (d.eta == 1.0f && !d.film) return d.tint;
  const View view(d, wi);
  const float cos_i = abs_cos_theta(wi);
  const Spectrum passed = Spectrum(1) - reflectance(d, view, cos_i, fresnel_dielectric(cos_i, view.eta));
  return Spectrum(1) - passed * (Spectrum(1) - d.tint);
}

std::optional<InterfaceSample> sample_reflection(const Dielectric& d, const Vec3& wi, const Vec2& u) {
  if (wi.z == 0) return std::nullopt;
  const View view(d, wi);
  const Vec3 i = view.side * wi;
  if (is_smooth(d)) {
    const float r = d.eta == 1.0f ? 0.0f : fresnel_dielectric(i.z, view.eta).reflectance;
    return InterfaceSample{{-wi.x, -wi.y, wi.z}, r, 1};
  }
  const TrowbridgeReitz microfacets(d.alpha_x, d.alpha_y);
  const Normal m = microfacets.sample(i, u);
  const float cos_m = dot(i, m);
  const Vec3 o = 2 * cos_m * m - i;
  if (cos_m <= 0 || o.z <= 0) return std::nullopt;
  return InterfaceSample{view.side * o, fresnel_dielectric(cos_m, view.eta).reflectance * microfacets.g_over_g1(i, o),
                         0.25f * microfacets.visible_d_over_dot(i, m)};
}

std::optional<InterfaceSample> sample_transmission(const Dielectric& d, const Vec3& wi, const Vec2& u,
                                                   Transport transport) {
  if (wi.z == 0) return std::nullopt;
  if (d.eta == 1.0f) return InterfaceSample{-wi, 1, 1};
  const View view(d, wi);
  const Vec3 i = view.side * wi;
  const bool smooth = is_smooth(d);
  const TrowbridgeReitz microfacets(d.alpha_x, d.alpha_y);
  const Normal m = smooth ? Normal(0, 0, 1) : microfacets.sample(i, u);
  const float cos_m = smooth ? i.z : dot(i, m);
  if (cos_m <= 0) return std::nullopt;
  const auto [r, cos_t] = fresnel_dielectric(cos_m, view.eta);
  if (r >= 1) return std::nullopt;
  const float weight = (1.0f - r) * transport_factor(view.eta, transport);
  if (smooth) return InterfaceSample{view.side * refract(i, m, cos_m, cos_t, view.eta), weight, 1};
  const auto through = transmit(microfacets, i, m, cos_m, cos_t, view.eta);
  if (!through) return std::nullopt;
  return InterfaceSample{view.side * through->wo, weight * through->weight_over_t, through->pdf};
}

float pdf_transmission(const Dielectric& d, const Vec3& wi, const Vec3& wo) {
  if (is_smooth(d) || wi.z == 0 || wo.z == 0 || same_hemisphere(wi, wo)) return 0;
  const View view(d, wi);
  const Vec3 i = view.side * wi;
  const auto refraction = refraction_between(i, view.side * wo, view.eta);
  if (!refraction) return 0;
  const TrowbridgeReitz microfacets(d.alpha_x, d.alpha_y);
  return microfacets.visible_d_over_dot(i, refraction->m) * refraction->dot_i * refraction->jacobian;
}

namespace {

float interface_f0(float eta) { return sqr((eta - 1) / (eta + 1)); }

Spectrum without(const Spectrum& all, const Spectrum& part) {
  Spectrum rest;
  for (int i = 0; i < 4; ++i) rest[i] = std::max(0.0f, all[i] - part[i]);
  return rest;
}

}  // namespace

SplitTerms split_terms(const Dielectric& d, const Vec3& wi) {
  const bool inside = wi.z < 0;
  return {.f0 = Spectrum(interface_f0(inside ? 1 / d.eta : d.eta)),
          .f90 = Spectrum(1),
          .alpha = geometric_alpha(d.alpha_x, d.alpha_y),
          .missing = "light through glass"};
}

SplitTerms split_terms_of_coat(const Dielectric& coat, const Spectrum& albedo, const Vec3& wi) {
  const Spectrum reflected(fresnel_dielectric(abs_cos_theta(wi), coat.eta).reflectance);
  return {.diffuse = without(albedo, reflected),
          .f0 = Spectrum(interface_f0(coat.eta)),
          .f90 = Spectrum(1),
          .alpha = geometric_alpha(coat.alpha_x, coat.alpha_y)};
}

}  // namespace lanthorn
