// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "material/kind.h"
#include "material/parts.h"
#include "surface/clear_coated.h"
#include "surface/coated.h"

namespace lanthorn {

static ClosureAt closure_of(const description::CoatedDiffuseMaterial& m, MaterialCompiler& c) {
  const SpectrumAt reflectance = c.albedo(m.reflectance);
  const CoatAt coat(m.coat, c);
  const CoatPassage* passage = coat.passage(c);
  return [=](const TexturePoint& at, const Wavelengths& w) -> Bsdf {
    const Diffuse base{clamped_albedo(reflectance(at, w))};
    if (passage != nullptr) return ClearCoated{passage, base.reflectance, coat.max_depth / 2};
    return coat.over(base, at, w);
  };
}
template ClosureAt compile(const description::CoatedDiffuseMaterial& m, MaterialCompiler& c);

}  // namespace lanthorn
