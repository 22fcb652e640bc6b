// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "surface/hair.h"

#include <algorithm>
#include <cmath>

#include "material/kind.h"
#include "material/parts.h"

namespace lanthorn {

namespace {

/// Absorption per radius.
struct AbsorptionAt {
  std::optional<SpectrumAt> sigma_a, color;
  FloatAt eumelanin, pheomelanin;
  SpectrumCurve eumelanin_absorption, pheomelanin_absorption;

  AbsorptionAt(const description::HairMaterial& m, MaterialCompiler& c) {
    if (m.sigma_a) sigma_a = c.spectrum(*m.sigma_a, description::SpectrumRole::unbounded);
    if (m.color) color = c.albedo(*m.color);
    eumelanin = c.number(m.eumelanin);
    pheomelanin = c.number(m.pheomelanin);
    // Values of d'Eon et al. 2011, §6.1.
    eumelanin_absorption = SpectrumCurve::unbounded({0.419f, 0.697f, 1.37f});
    pheomelanin_absorption = SpectrumCurve::unbounded({0.187f, 0.4f, 1.05f});
  }

  Spectrum operator()(float beta_n, const TexturePoint& at, const Wavelengths& w) const {
    if (sigma_a) return (*sigma_a)(at, w);
    if (color) {
      Spectrum sigma =
          map(clamped_albedo((*color)(at, w)), [&](float reflectance) { return hair_absorption(reflectance, beta_n); });
      if (w.mode == ColorMode::rgb) sigma[3] = 0;
      return sigma;
    }
    return eumelanin(at) * eumelanin_absorption.evaluate(w) + pheomelanin(at) * pheomelanin_absorption.evaluate(w);
  }
};

}  // namespace

static ClosureAt closure_of(const description::HairMaterial& m, MaterialCompiler& c) {
  const AbsorptionAt absorption(m, c);
  const FloatAt eta = c.number(m.eta), beta_m = c.number(m.beta_m), beta_n = c.number(m.beta_n),
                alpha = c.number(m.alpha);
  c.traits.is_anisotropic = true;
  c.traits.is_hair = true;
  c.is_constant = false;  // depends on the offset across the hair
  return [=](const TexturePoint& at, const Wavelengths& w) -> Bsdf {
    const float azimuthal = std::clamp(beta_n(at), 0.0f, 1.0f);
    const float h = 2 * at.uv.y - 1;
    return Hair{absorption(azimuthal, at, w),
                h,
                std::fmax(eta(at), 1.0001f),
                std::clamp(beta_m(at), 0.0f, 1.0f),
                azimuthal,
                alpha(at),
                h,
                true};
  };
}
template ClosureAt compile(const description::HairMaterial& m, MaterialCompiler& c);

}  // namespace lanthorn
