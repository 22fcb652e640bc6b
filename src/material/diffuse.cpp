// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "surface/diffuse.h"

#include "material/kind.h"
#include "material/parts.h"

namespace lanthorn {

static ClosureAt closure_of(const description::DiffuseMaterial& m, MaterialCompiler& c) {
  return [reflectance = c.filtered_albedo(m.reflectance)](const TexturePoint& at, const Wavelengths& w) -> Bsdf {
    return Diffuse{clamped_albedo(reflectance(at, w))};
  };
}
template ClosureAt compile(const description::DiffuseMaterial& m, MaterialCompiler& c);

}  // namespace lanthorn
