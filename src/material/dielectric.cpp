// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "surface/dielectric.h"

#include <cmath>

#include "material/kind.h"
#include "material/parts.h"
#include "surface/thin_dielectric.h"

namespace lanthorn {

static ClosureAt closure_of(const description::DielectricMaterial& m, MaterialCompiler& c) {
  const SpectrumCurve eta = c.index(m.eta);
  const RoughnessAt roughness(m.roughness, c);
  const SpectrumAt tint = c.albedo(m.tint);
  const FilmAt film(m.film, c);
  // With an index of 1, rough surfaces do not refract and are specular, too.
  c.traits.may_be_specular =
      c.traits.may_be_specular || eta.varies() || index_at_hero(eta, Wavelengths::rgb(0.5f)) == 1;
  return [=](const TexturePoint& at, const Wavelengths& w) -> Bsdf {
    const Vec2 a = roughness.alpha(at);
    const Spectrum both = clamped_albedo(tint(at, w));
    const Spectrum each = map(both, [](float x) { return std::sqrt(x); });
    return Dielectric{index_at_hero(eta, w), a.x, a.y, eta.varies(), each, film(at, w)};
  };
}
template ClosureAt compile(const description::DielectricMaterial& m, MaterialCompiler& c);

static ClosureAt closure_of(const description::ThinDielectricMaterial& m, MaterialCompiler& c) {
  const SpectrumCurve eta = c.index(m.eta);
  const RoughnessAt roughness(m.roughness, c);
  const SpectrumAt tint = c.albedo(m.tint);
  const FilmAt film(m.film, c);
  return [=](const TexturePoint& at, const Wavelengths& w) -> Bsdf {
    const Vec2 a = roughness.alpha(at);
    return ThinDielectric{index_at_hero(eta, w), a.x, a.y, clamped_albedo(tint(at, w)), film(at, w)};
  };
}
template ClosureAt compile(const description::ThinDielectricMaterial& m, MaterialCompiler& c);

}  // namespace lanthorn
