// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "surface/thin_dielectric.h"

namespace lanthorn {

BsdfValue evaluate(const ThinDielectric& d, const Vec3& wi, const Vec3& wo, Transport /*no refraction*/,
                   BsdfParts parts) {
  if (is_smooth(d) || wi.z == 0 || wo.z == 0) return {};
  // Above the pane, to which transmitted light is mirrored.
  const float side = std::copysign(1.0f, wi.z);
  const bool through = side * wo.z < 0;
  const HalfwayReflection facet({d.alpha_x, d.alpha_y}, side * wi, {side * wo.x, side * wo.y, std::fabs(wo.z)});
  BsdfValue value;
  if (parts.f || parts.pdf) {
    const Spectrum r = thin_reflectance(d, facet.cos_i());
    const float mean = mean_component(r);
    value.f = through ? d.tint * (Spectrum(1) - r) * facet.f() : r * facet.f();
    value.pdf = (through ? 1 - mean : mean) * facet.pdf();
  }
  if (parts.pdf_reverse) {
    const float mean = mean_component(thin_reflectance(d, facet.cos_o()));
    value.pdf_reverse = (through ? 1 - mean : mean) * facet.pdf_reverse();
  }
  return value;
}

std::optional<BsdfSample> sample(const ThinDielectric& d, const Vec3& wi, float u_lobe, const Vec2& u,
                                 Transport /*no refraction*/) {
  if (wi.z == 0) return std::nullopt;
  const bool smooth = is_smooth(d);
  const float side = std::copysign(1.0f, wi.z);
  const Vec3 i = side * wi;
  const TrowbridgeReitz microfacets(d.alpha_x, d.alpha_y);
  const Normal m = smooth ? Normal(0, 0, 1) : microfacets.sample(i, u);
  const float cos_m = smooth ? i.z : dot(i, m);
  if (cos_m <= 0) return std::nullopt;
  const Vec3 o = smooth ? Vec3(-i.x, -i.y, i.z) : 2 * cos_m * m - i;
  if (o.z <= 0) return std::nullopt;
  const Spectrum r = thin_reflectance(d, cos_m);
  const float mean = mean_component(r);
  const bool reflected = u_lobe < mean;
  const float share = reflected ? mean : 1 - mean;
  const Spectrum weight =
      (reflected ? r : Spectrum(1) - r) / Spectrum(share) * (smooth ? 1.0f : microfacets.g_over_g1(i, o));
  return BsdfSample{.wo = side * (reflected ? o : Vec3(o.x, o.y, -o.z)),
                    .weight = reflected ? weight : weight * d.tint,
                    .pdf = smooth ? share : 0.25f * share * microfacets.visible_d_over_dot(i, m),
                    .delta = smooth,
                    .transmission = !reflected};
}

Spectrum albedo(const ThinDielectric& d, const Vec3& wi) {
  const Spectrum passed = Spectrum(1) - thin_reflectance(d, abs_cos_theta(wi));
  return Spectrum(1) - passed * (Spectrum(1) - d.tint);
}

}  // namespace lanthorn
