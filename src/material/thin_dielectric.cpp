// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "surface/thin_dielectric.h"

#include "material/kind.h"
#include "material/parts.h"

namespace lanthorn {

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
