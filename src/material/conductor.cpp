// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "surface/conductor.h"

#include "material/kind.h"
#include "material/parts.h"

namespace lanthorn {

static ClosureAt closure_of(const description::ConductorMaterial& m, MaterialCompiler& c) {
  return [metal = MetalAt(m, m.roughness, c)](const TexturePoint& at, const Wavelengths& w) -> Bsdf {
    return metal(at, w);
  };
}
template ClosureAt compile(const description::ConductorMaterial& m, MaterialCompiler& c);

}  // namespace lanthorn
