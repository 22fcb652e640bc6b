// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "surface/split_terms.h"

#include <variant>

#include "surface/fresnel.h"
#include "surface/microfacet.h"

namespace lanthorn {

namespace {

Spectrum without(const Spectrum& all, const Spectrum& part) {
  Spectrum rest;
  for (int i = 0; i < 4; ++i) rest[i] = std::max(0.0f, all[i] - part[i]);
  return rest;
}

float interface_f0(float eta) { return sqr((eta - 1) / (eta + 1)); }

SplitTerms terms_of(const Diffuse& d, const Vec3& /*all alike*/) { return {.diffuse = d.reflectance}; }

SplitTerms terms_of(const DiffuseTransmission& d, const Vec3& /*all alike*/) {
  return {.diffuse = d.reflectance, .diffuse_behind = d.transmittance};
}

SplitTerms terms_of(const Conductor& c, const Vec3& /*all alike*/) {
  const Spectrum f0 = fresnel_conductor(1, c.eta, c.k);
  return {.f0 = f0,
          .f90 = map(f0, [](float x) { return x > 0 ? 1.0f : 0.0f; }),
          .alpha = geometric_alpha(c.alpha_x, c.alpha_y)};
}

SplitTerms terms_of(const Dielectric& d, const Vec3& wi) {
  const bool inside = wi.z < 0;
  return {.f0 = Spectrum(interface_f0(inside ? 1 / d.eta : d.eta)),
          .f90 = Spectrum(1),
          .alpha = geometric_alpha(d.alpha_x, d.alpha_y),
          .missing = "light through glass"};
}

SplitTerms terms_of(const ThinDielectric& d, const Vec3& /*all alike*/) {
  return {.f0 = thin_reflectance(d, 1),
          .f90 = Spectrum(1),
          .alpha = geometric_alpha(d.alpha_x, d.alpha_y),
          .missing = "light through glass"};
}

// `albedo` is that of coat and base together; a reflection of the base counts as diffuse.
SplitTerms terms_of_coated(const Dielectric& coat, const Spectrum& albedo, const Vec3& wi) {
  const Spectrum reflected(fresnel_dielectric(abs_cos_theta(wi), coat.eta).reflectance);
  return {.diffuse = without(albedo, reflected),
          .f0 = Spectrum(interface_f0(coat.eta)),
          .f90 = Spectrum(1),
          .alpha = geometric_alpha(coat.alpha_x, coat.alpha_y)};
}

SplitTerms terms_of(const ClearCoated& c, const Vec3& wi) {
  return terms_of_coated(c.passage->coat(), albedo(c, wi), wi);
}

template <class Base>
SplitTerms terms_of(const Coated<Base>& c, const Vec3& wi) {
  return terms_of_coated(c.coat, albedo(c, wi), wi);
}

SplitTerms terms_of(const CoatedConductor& c, const Vec3& wi) {
  const Spectrum all = albedo(c, wi);
  return {.f0 = all,
          .f90 = all,
          .alpha = geometric_alpha(c.base.alpha_x, c.base.alpha_y),
          .missing = "the highlights of coats over metal"};
}

SplitTerms terms_of(const Plastic& p, const Vec3& wi) {
  const Spectrum reflected = specular_albedo(p, abs_cos_theta(wi));
  return {.diffuse = (Spectrum(1) - reflected) * p.reflectance, .f0 = p.f0, .f90 = Spectrum(p.f90), .alpha = p.alpha};
}

SplitTerms terms_of(const Cloth& c, const Vec3& wi) {
  SplitTerms terms = terms_of(c.base, wi);
  const float fibres = sheen_albedo(c.alpha, abs_cos_theta(wi)), base = 1 - fibres * max_component(c.sheen);
  terms.diffuse *= base;
  terms.f0 *= base;
  terms.f90 *= base;
  terms.sheen = c.sheen * fibres;
  return terms;
}

SplitTerms terms_of(const Hair& /*all*/, const Vec3& /*all alike*/) { return {.missing = "hair"}; }
SplitTerms terms_of(const Measured& /*all*/, const Vec3& /*all alike*/) { return {.missing = "measured materials"}; }

template <class C>
SplitTerms terms_of(const Bent<C>& b, const Vec3& wi) {
  return terms_of(b.closure, wi);
}

}  // namespace

SplitTerms split_terms(const Bsdf& bsdf, const Vec3& wi) {
  return std::visit([&](const auto& closure) { return terms_of(closure, wi); }, bsdf);
}

}  // namespace lanthorn
