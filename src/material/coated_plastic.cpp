// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "material/kind.h"
#include "material/parts.h"
#include "surface/coated.h"

namespace lanthorn {

static ClosureAt closure_of(const description::CoatedPlasticMaterial& m, MaterialCompiler& c) {
  const PlasticAt base(m.base, c);
  const CoatAt coat(m.coat, c);
  return [=](const TexturePoint& at, const Wavelengths& w) -> Bsdf { return coat.over(base(at, w), at, w); };
}
template ClosureAt compile(const description::CoatedPlasticMaterial& m, MaterialCompiler& c);

}  // namespace lanthorn
