// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "surface/conductor.h"

#include "material/kind.h"
#include "material/parts.h"
#include "surface/coated.h"

namespace lanthorn {

static ClosureAt closure_of(const description::ConductorMaterial& m, MaterialCompiler& c) {
  return [metal = MetalAt(m, m.roughness, c)](const TexturePoint& at, const Wavelengths& w) -> Bsdf {
    return metal(at, w);
  };
}
template ClosureAt compile(const description::ConductorMaterial& m, MaterialCompiler& c);

static ClosureAt closure_of(const description::CoatedConductorMaterial& m, MaterialCompiler& c) {
  const MetalAt metal(m, m.conductor_roughness, c);
  const CoatAt coat(m.coat, c);
  return [=](const TexturePoint& at, const Wavelengths& w) -> Bsdf {
    return coat.over(under_coat(metal(at, w), index_at_hero(coat.eta, w)), at, w);
  };
}
template ClosureAt compile(const description::CoatedConductorMaterial& m, MaterialCompiler& c);

}  // namespace lanthorn
