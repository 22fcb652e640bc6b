// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "material/kind.h"
#include "material/parts.h"
#include "surface/diffuse.h"

namespace lanthorn {

static ClosureAt closure_of(const description::DiffuseTransmissionMaterial& m, MaterialCompiler& c) {
  return [reflectance = c.albedo(m.reflectance), transmittance = c.albedo(m.transmittance), scale = m.scale](
             const TexturePoint& at, const Wavelengths& w) -> Bsdf {
    return DiffuseTransmission{clamped_albedo(scale * reflectance(at, w)),
                               clamped_albedo(scale * transmittance(at, w))};
  };
}
template ClosureAt compile(const description::DiffuseTransmissionMaterial& m, MaterialCompiler& c);

}  // namespace lanthorn
