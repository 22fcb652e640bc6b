// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "surface/bsdf.h"

#include <algorithm>

#include "surface/fresnel.h"

namespace lanthorn {
namespace {

/// Lambertian light below a plane interface of index ratio `eta` >= 1 that is reflected back (Jensen et al.
/// 2001, A Practical Model for Subsurface Light Transport, §2.1); nothing for eta < 1.
float internal_diffuse_reflectance(float eta) {
  if (eta <= 1) return 0;
  return std::clamp(-1.4399f / (eta * eta) + 0.7099f / eta + 0.6681f + 0.0636f * eta, 0.0f, 1.0f);
}

float coat_reflectance(const Dielectric& coat, const Vec3& wi) {
  return coat.eta == 1.0f ? 0.0f : fresnel_dielectric(abs_cos_theta(wi), coat.eta).reflectance;
}
/// Fraction that survives a passage through the layer and back, the light scattered in it counted as surviving.
template <class Base>
Spectrum round_trip(const Coated<Base>& c) {
  return exp(-2.0f * c.thickness * (Spectrum(1) - c.albedo));
}

Spectrum albedo_of(const Diffuse& d, const Vec3&) { return d.reflectance; }
Spectrum albedo_of(const DiffuseTransmission& d, const Vec3&) { return d.reflectance + d.transmittance; }
Spectrum albedo_of(const Conductor& c, const Vec3& wi) { return fresnel_conductor(abs_cos_theta(wi), c.eta, c.k); }
Spectrum albedo_of(const Dielectric&, const Vec3&) { return Spectrum(1); }
Spectrum albedo_of(const ThinDielectric&, const Vec3&) { return Spectrum(1); }
Spectrum albedo_of(const Hair& h, const Vec3& wi) { return hair_albedo(h, wi); }
Spectrum albedo_of(const Measured& m, const Vec3& wi) { return measured_albedo(m, wi); }

Spectrum albedo_of(const Plastic& p, const Vec3& wi) {
  const Spectrum reflected = specular_albedo(p, abs_cos_theta(wi));
  return reflected + (Spectrum(1) - reflected) * p.reflectance;
}

/// Share of the light that passed the coat and comes back, after any number of reflections between base and coat
/// (Kubelka's series), of which the fraction `back` is turned back each time.
Spectrum base_and_back(const Spectrum& base, const Spectrum& round, float back) {
  const Spectrum once = base * round;
  return once * (1 - back) / (Spectrum(1) - once * back);
}
Spectrum albedo_below(const CoatedDiffuse& c, const Vec3&) {
  return base_and_back(c.base.reflectance, round_trip(c), internal_diffuse_reflectance(c.coat.eta));
}
Spectrum albedo_below(const CoatedConductor& c, const Vec3& wi) {
  const float cos_t = fresnel_dielectric(abs_cos_theta(wi), c.coat.eta).cos_t;
  return base_and_back(fresnel_conductor(cos_t, c.base.eta, c.base.k), round_trip(c), coat_reflectance(c.coat, wi));
}
template <class Base>
Spectrum albedo_of(const Coated<Base>& c, const Vec3& wi) {
  const float r = coat_reflectance(c.coat, wi);
  return Spectrum(r) + albedo_below(c, wi) * (1 - r);
}

float geometric_alpha(float alpha_x, float alpha_y) { return std::sqrt(alpha_x * alpha_y); }
LobeWeights delta_or_glossy(bool smooth, float alpha_x, float alpha_y) {
  if (smooth) return {.delta = 1};
  return {.glossy = 1, .alpha = geometric_alpha(alpha_x, alpha_y)};
}

LobeWeights lobes_of(const Diffuse& d, const Vec3&) { return {.diffuse = d.reflectance.is_black() ? 0.0f : 1.0f}; }
LobeWeights lobes_of(const DiffuseTransmission& d, const Vec3&) {
  return {.diffuse = d.reflectance.is_black() && d.transmittance.is_black() ? 0.0f : 1.0f};
}
LobeWeights lobes_of(const Conductor& c, const Vec3&) { return delta_or_glossy(is_smooth(c), c.alpha_x, c.alpha_y); }
LobeWeights lobes_of(const Dielectric& d, const Vec3&) { return delta_or_glossy(is_smooth(d), d.alpha_x, d.alpha_y); }
LobeWeights lobes_of(const ThinDielectric&, const Vec3&) { return {.delta = 1}; }
// Narrow, so that no cache looks for a surface's neighbourhood on a hair.
LobeWeights lobes_of(const Hair&, const Vec3&) { return {.glossy = 1, .alpha = 0}; }
LobeWeights lobes_of(const Measured& m, const Vec3&) { return {.glossy = 1, .alpha = m.brdf->alpha()}; }
LobeWeights lobes_of(const Plastic& p, const Vec3& wi) {
  const Spectrum e = specular_albedo(p, abs_cos_theta(wi));
  const float reflected = max_component(e), below = max_component((Spectrum(1) - e) * p.reflectance);
  if (reflected + below <= 0) return {};
  const float share = reflected / (reflected + below);
  const LobeWeights surface = delta_or_glossy(is_smooth(p), p.alpha, p.alpha);
  return {
      .diffuse = 1 - share, .glossy = share * surface.glossy, .delta = share * surface.delta, .alpha = surface.alpha};
}

/// The base's lobes as they are seen through the coat, which makes mirrors glossy if it is rough.
LobeWeights lobes_below(const CoatedDiffuse&) { return {.diffuse = 1}; }
LobeWeights lobes_below(const CoatedConductor& c) {
  const Dielectric& coat = c.coat;
  if (is_smooth(coat)) return delta_or_glossy(is_smooth(c.base), c.base.alpha_x, c.base.alpha_y);
  return {
      .glossy = 1,
      .alpha = std::max(geometric_alpha(c.base.alpha_x, c.base.alpha_y), geometric_alpha(coat.alpha_x, coat.alpha_y))};
}
template <class Base>
LobeWeights lobes_of(const Coated<Base>& c, const Vec3& wi) {
  const float r = coat_reflectance(c.coat, wi);
  const float below = (1 - r) * max_component(albedo_below(c, wi));
  if (r + below <= 0) return {};
  const LobeWeights coat = delta_or_glossy(is_smooth(c.coat), c.coat.alpha_x, c.coat.alpha_y);
  const LobeWeights base = lobes_below(c);
  const float share = r / (r + below);
  const float scattered = max_component(c.albedo) * (1 - std::exp(-2 * c.thickness));
  const float from_base = (1 - share) * (1 - scattered);
  LobeWeights sum{.diffuse = (1 - share) * scattered + from_base * base.diffuse,
                  .glossy = share * coat.glossy + from_base * base.glossy,
                  .delta = share * coat.delta + from_base * base.delta};
  if (coat.glossy > 0 && base.glossy > 0) {
    sum.alpha = std::min(coat.alpha, base.alpha);
  } else {
    sum.alpha = coat.glossy > 0 ? coat.alpha : base.alpha;
  }
  return sum;
}

bool scatters(const Diffuse& d) { return !d.reflectance.is_black(); }
bool scatters(const DiffuseTransmission& d) { return !d.reflectance.is_black() || !d.transmittance.is_black(); }
bool scatters(const Conductor& c) { return !is_smooth(c); }
bool scatters(const Dielectric& d) { return !is_smooth(d); }
bool scatters(const ThinDielectric&) { return false; }
bool scatters(const Hair&) { return true; }
bool scatters(const Measured&) { return true; }
bool scatters(const Plastic& p) { return !is_smooth(p) || !p.reflectance.is_black(); }
template <class Base>
bool scatters(const Coated<Base>& c) {
  return has_non_delta(c);
}

template <class Closure>
bool disperses(const Closure&) {
  return false;
}
bool disperses(const Dielectric& d) { return d.dispersive; }
template <class Base>
bool disperses(const Coated<Base>& c) {
  return c.coat.dispersive;
}

}  // namespace

Spectrum eval(const Bsdf& bsdf, const Vec3& wi, const Vec3& wo, Transport transport) {
  return std::visit([&](const auto& closure) { return eval(closure, wi, wo, transport); }, bsdf);
}

float pdf(const Bsdf& bsdf, const Vec3& wi, const Vec3& wo) {
  return std::visit([&](const auto& closure) { return pdf(closure, wi, wo); }, bsdf);
}

float pdf_reverse(const Bsdf& bsdf, const Vec3& wi, const Vec3& wo) {
  if (const auto* hair = std::get_if<Hair>(&bsdf)) return pdf_reverse(*hair, wi, wo);
  return pdf(bsdf, wo, wi);
}

std::optional<BsdfSample> sample(const Bsdf& bsdf, const Vec3& wi, float u_lobe, const Vec2& u, Transport transport) {
  return std::visit([&](const auto& closure) { return sample(closure, wi, u_lobe, u, transport); }, bsdf);
}

Spectrum albedo(const Bsdf& bsdf, const Vec3& wi) {
  return std::visit([&](const auto& closure) { return albedo_of(closure, wi); }, bsdf);
}

LobeWeights lobe_weights(const Bsdf& bsdf, const Vec3& wi) {
  return std::visit([&](const auto& closure) { return lobes_of(closure, wi); }, bsdf);
}

bool has_non_delta(const Bsdf& bsdf) {
  return std::visit([](const auto& closure) { return scatters(closure); }, bsdf);
}

bool is_dispersive(const Bsdf& bsdf) {
  return std::visit([](const auto& closure) { return disperses(closure); }, bsdf);
}

}  // namespace lanthorn
