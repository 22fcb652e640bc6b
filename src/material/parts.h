// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Groups of parameters that several materials have.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "material/compiler.h"
#include "math/vec.h"
#include "surface/coated.h"
#include "surface/thin_film.h"

namespace lanthorn {

/// Fraunhofer's d line (nm), for which indices of refraction are specified.
inline constexpr float d_line = 587.6f;

Spectrum clamped_albedo(const Spectrum& s);
/// Index of refraction of the path: the value at the hero wavelength if it varies; 1 if it is within 1e-5 of 1.
float index_at_hero(const SpectrumCurve& eta, const Wavelengths& w);

struct RoughnessAt {
  FloatAt u, v;
  bool remap = true;

  RoughnessAt() = default;
  RoughnessAt(const description::Roughness& r, MaterialCompiler& c);
  /// GGX widths along the tangent and across it.
  Vec2 alpha(const TexturePoint& at) const;
};

struct FilmAt {
  std::optional<FloatAt> thickness;
  float eta = 1;

  FilmAt(const std::optional<description::ThinFilm>& film, MaterialCompiler& c);
  ThinFilm operator()(const TexturePoint& at, const Wavelengths& w) const;
};

/// A conductor given by its reflectance or by its complex index of refraction.
struct MetalAt {
  std::optional<SpectrumAt> reflectance;
  SpectrumAt eta, k;
  RoughnessAt roughness;

  /// `metal`: a ConductorMaterial or a CoatedConductorMaterial, whose `roughness` has another name.
  template <class Metal>
  MetalAt(const Metal& metal, const description::Roughness& r, MaterialCompiler& c)
      : MetalAt(metal.reflectance, metal.eta, metal.k, r, c) {}
  Conductor operator()(const TexturePoint& at, const Wavelengths& w) const;

 private:
  MetalAt(const std::optional<description::SpectrumParameter>& reflectance_, const description::SpectrumParameter& eta_,
          const description::SpectrumParameter& k_, const description::Roughness& r, MaterialCompiler& c);
};

struct CoatAt {
  RoughnessAt roughness;
  FloatAt thickness;
  SpectrumCurve eta;
  SpectrumAt albedo;
  FloatAt g;
  int max_depth = 10;
  int samples = 1;

  CoatAt(const description::Coat& coat, MaterialCompiler& c);
  /// Null unless the coat is clear and the same everywhere, in all directions and at all wavelengths.
  const CoatPassage* passage(MaterialCompiler& c) const;

  template <class Base>
  Coated<Base> over(const Base& base, const TexturePoint& at, const Wavelengths& w) const {
    Coated<Base> coated;
    const Vec2 a = roughness.alpha(at);
    coated.coat = {index_at_hero(eta, w), a.x, a.y, eta.varies()};
    coated.base = base;
    coated.thickness = optical_depth(thickness(at));
    coated.albedo = clamped_albedo(albedo(at, w));
    coated.g = std::clamp(g(at), -0.999f, 0.999f);
    coated.max_depth = max_depth;
    coated.n_samples = samples;
    return coated;
  }

 private:
  static float optical_depth(float thickness) { return std::fmax(thickness, std::numeric_limits<float>::min()); }
};

/// A diffuse base under a dielectric surface, without sheen.
struct PlasticAt {
  SpectrumAt reflectance;
  RoughnessAt roughness;
  float eta = 1.5f;
  FloatAt specular;
  SpectrumAt specular_color;
  FilmAt film;

  PlasticAt(const description::PlasticMaterial& m, MaterialCompiler& c);
  Plastic operator()(const TexturePoint& at, const Wavelengths& w) const;
};

}  // namespace lanthorn
