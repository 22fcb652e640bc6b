// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "surface/conductor.h"

#include <algorithm>

#include "surface/fresnel.h"

namespace lanthorn {

Conductor conductor_from_reflectance(const Spectrum& reflectance, float alpha_x, float alpha_y) {
  // At normal incidence and eta = 1, R = k^2 / (4 + k^2).
  const auto k = [](float r) {
    const float clamped = std::min(std::max(r, 0.0f), 0.9999f);
    return 2 * std::sqrt(clamped / (1.0f - clamped));
  };
  return {.eta = Spectrum(1), .k = map(reflectance, k), .alpha_x = alpha_x, .alpha_y = alpha_y};
}

BsdfValue evaluate(const Conductor& c, const Vec3& wi, const Vec3& wo, Transport /*symmetric*/, BsdfParts parts) {
  if (is_smooth(c) || !same_hemisphere(wi, wo)) return {};
  const float side = std::copysign(1.0f, wi.z);
  const HalfwayReflection reflection({c.alpha_x, c.alpha_y}, side * wi, side * wo);
  BsdfValue value{.pdf = reflection.pdf(), .pdf_reverse = reflection.pdf_reverse()};
  if (parts.f) value.f = fresnel_conductor(reflection.cos_i(), c.eta, c.k) * reflection.f();
  return value;
}

std::optional<BsdfSample> sample(const Conductor& c, const Vec3& wi, float /*u_lobe: one lobe*/, const Vec2& u,
                                 Transport /*symmetric*/) {
  std::optional<BsdfSample> result;
  if (wi.z == 0) return result;
  if (is_smooth(c)) {
    BsdfSample& s = result.emplace();
    s.wo = {-wi.x, -wi.y, wi.z};
    s.weight = fresnel_conductor(abs_cos_theta(wi), c.eta, c.k);
    s.pdf = 1;
    s.delta = true;
    return result;
  }
  const float side = std::copysign(1.0f, wi.z);
  const Vec3 i = side * wi;
  const TrowbridgeReitz microfacets(c.alpha_x, c.alpha_y);
  const Normal m = microfacets.sample(i, u);
  const float cos_m = dot(i, m);
  const Vec3 o = 2 * cos_m * m - i;
  if (cos_m <= 0 || o.z <= 0) return result;
  BsdfSample& s = result.emplace();
  s.wo = side * o;
  s.weight = fresnel_conductor(cos_m, c.eta, c.k) * microfacets.g_over_g1(i, o);
  s.pdf = 0.25f * microfacets.visible_d_over_dot(i, m);
  return result;
}

Spectrum albedo(const Conductor& c, const Vec3& wi) { return fresnel_conductor(abs_cos_theta(wi), c.eta, c.k); }

LobeWeights lobe_weights(const Conductor& c, const Vec3& /*any*/) { return microfacet_lobe(c.alpha_x, c.alpha_y); }

SplitTerms split_terms(const Conductor& c, const Vec3& /*all alike*/) {
  const Spectrum f0 = fresnel_conductor(1, c.eta, c.k);
  return {.f0 = f0,
          .f90 = map(f0, [](float x) { return x > 0 ? 1.0f : 0.0f; }),
          .alpha = geometric_alpha(c.alpha_x, c.alpha_y)};
}

}  // namespace lanthorn
