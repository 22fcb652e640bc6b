// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "surface/measured.h"

#include "material/kind.h"

namespace lanthorn {

static ClosureAt closure_of(const description::MeasuredMaterial& m, MaterialCompiler& c) {
  return [brdf = &c.measured(m.brdf)](const TexturePoint&, const Wavelengths& w) {
    return Bsdf(std::in_place_type<Measured>, Measured{brdf, w});
  };
}
template ClosureAt compile(const description::MeasuredMaterial& m, MaterialCompiler& c);

}  // namespace lanthorn
