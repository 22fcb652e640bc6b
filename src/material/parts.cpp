// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "material/parts.h"

#include <cmath>

#include "lanthorn/error.h"
#include "surface/metal_rgb.h"
#include "surface/microfacet.h"

namespace lanthorn {

namespace {

float width_of(float roughness, bool remap) {
  return remap ? roughness_to_alpha(roughness) : std::max(0.0f, roughness);
}

}  // namespace

Spectrum clamped_albedo(const Spectrum& s) {
  return map(s, [](float x) { return std::clamp(x, 0.0f, 1.0f); });
}

float index_at_hero(const SpectrumCurve& eta, const Wavelengths& w) {
  // Closer to 1, rounding destroys the half vector of refraction, i + eta o, of light that goes nearly straight on.
  constexpr float nearest = 1e-5f;
  const float value = eta.at(w.lambda[w.hero]);
  return value > 0 && std::fabs(value - 1) >= nearest ? value : 1.0f;
}

RoughnessAt::RoughnessAt(const description::Roughness& r, MaterialCompiler& c)
    : u(c.number(r.u)), v(c.number(r.v)), remap(r.remap) {
  const bool is_isotropic = u.input.node == v.input.node && (!u.is_constant() || u.input.value == v.input.value);
  c.traits.is_anisotropic = c.traits.is_anisotropic || !is_isotropic;
  const auto may_be_smooth = [&](const FloatAt& x) {
    return !x.is_constant() || effectively_smooth(width_of(x.input.value, remap), 0);
  };
  c.traits.may_be_specular = c.traits.may_be_specular || (may_be_smooth(u) && may_be_smooth(v));
}

Vec2 RoughnessAt::alpha(const TexturePoint& at) const {
  const Vec2 r(u(at), v(at));
  return {width_of(r.x, remap), width_of(r.y, remap)};
}

FilmAt::FilmAt(const std::optional<description::ThinFilm>& film, MaterialCompiler& c) {
  if (!film) return;
  if (!(film->eta >= 1)) throw Error(c.location(), "a film's index of refraction must be at least 1");
  thickness = c.number(film->thickness);
  eta = film->eta;
}

ThinFilm FilmAt::operator()(const TexturePoint& at, const Wavelengths& w) const {
  if (!thickness) return {};
  return {eta, std::fmax((*thickness)(at), 0.0f), w};
}

MetalAt::MetalAt(const std::optional<description::SpectrumParameter>& reflectance_,
                 const description::SpectrumParameter& eta_, const description::SpectrumParameter& k_,
                 const description::Roughness& r, MaterialCompiler& c) {
  if (reflectance_) {
    reflectance = c.albedo(*reflectance_);
  } else {
    const bool had_tables = c.traits.has_tables;
    eta = c.spectrum(eta_, description::SpectrumRole::unbounded);
    k = c.spectrum(k_, description::SpectrumRole::unbounded);
    if (c.traits.has_tables != had_tables && eta.is_constant() && k.is_constant()) {
      fit_metal_rgb(eta.input.curve, k.input.curve);
      c.traits.has_tables = had_tables;  // its colour needs no spectral rendering
    }
  }
  roughness = RoughnessAt(r, c);
}

Conductor MetalAt::operator()(const TexturePoint& at, const Wavelengths& w) const {
  const Vec2 a = roughness.alpha(at);
  if (reflectance) return conductor_from_reflectance((*reflectance)(at, w), a.x, a.y);
  return {eta(at, w), k(at, w), a.x, a.y};
}

CoatAt::CoatAt(const description::Coat& coat, MaterialCompiler& c)
    : roughness(coat.roughness, c),
      thickness(c.number(coat.thickness)),
      eta(c.index(coat.eta)),
      albedo(c.albedo(coat.albedo)),
      g(c.number(coat.g)),
      max_depth(coat.max_depth),
      samples(coat.samples) {}

const CoatPassage* CoatAt::passage(MaterialCompiler& c) const {
  const FloatAt &u = roughness.u, &v = roughness.v;
  const bool is_uniform = u.is_constant() && v.is_constant() && thickness.is_constant() && albedo.is_constant();
  if (!is_uniform || u.input.value != v.input.value || eta.varies() || !albedo.input.curve.is_black()) return nullptr;
  return &c.coat_passage(index_at_hero(eta, Wavelengths::rgb(0.5f)), width_of(u.input.value, roughness.remap),
                         optical_depth(thickness.input.value));
}

PlasticAt::PlasticAt(const description::PlasticMaterial& m, MaterialCompiler& c)
    : reflectance(c.albedo(m.reflectance)),
      roughness(m.roughness, c),
      eta(c.curve(m.eta).at(d_line)),
      specular(c.number(m.specular)),
      specular_color(c.spectrum(m.specular_color, description::SpectrumRole::unbounded)),
      film(m.film, c) {}

Plastic PlasticAt::operator()(const TexturePoint& at, const Wavelengths& w) const {
  Plastic p;
  p.reflectance = clamped_albedo(reflectance(at, w));
  p.alpha = std::min(roughness.alpha(at).x, 1.0f);
  p.f90 = std::clamp(specular(at), 0.0f, 1.0f);
  p.f0 = p.f90 * clamped_albedo(sqr((eta - 1) / (eta + 1)) * specular_color(at, w));
  p.film = film(at, w);
  return p;
}

}  // namespace lanthorn
