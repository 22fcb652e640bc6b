// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "surface/diffuse.h"

#include "material/kind.h"
#include "material/parts.h"
#include "surface/clear_coated.h"
#include "surface/coated.h"

namespace lanthorn {

static ClosureAt closure_of(const description::DiffuseMaterial& m, MaterialCompiler& c) {
  return [reflectance = c.filtered_albedo(m.reflectance)](const TexturePoint& at, const Wavelengths& w) -> Bsdf {
    return Diffuse{clamped_albedo(reflectance(at, w))};
  };
}
template ClosureAt compile(const description::DiffuseMaterial& m, MaterialCompiler& c);

static ClosureAt closure_of(const description::DiffuseTransmissionMaterial& m, MaterialCompiler& c) {
  return [reflectance = c.albedo(m.reflectance), transmittance = c.albedo(m.transmittance), scale = m.scale](
             const TexturePoint& at, const Wavelengths& w) -> Bsdf {
    return DiffuseTransmission{clamped_albedo(scale * reflectance(at, w)),
                               clamped_albedo(scale * transmittance(at, w))};
  };
}
template ClosureAt compile(const description::DiffuseTransmissionMaterial& m, MaterialCompiler& c);

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
