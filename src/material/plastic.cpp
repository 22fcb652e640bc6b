// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "surface/plastic.h"

#include <algorithm>
#include <variant>

#include "material/kind.h"
#include "material/parts.h"
#include "surface/cloth.h"
#include "surface/coated.h"

namespace lanthorn {

namespace {

bool has_sheen(const description::PlasticMaterial& m) {
  const auto* number = std::get_if<float>(&m.sheen_color.value);
  return m.sheen_color.texture || number == nullptr || *number != 0;
}

}  // namespace

static ClosureAt closure_of(const description::PlasticMaterial& m, MaterialCompiler& c) {
  const PlasticAt plastic(m, c);
  if (!has_sheen(m)) return [=](const TexturePoint& at, const Wavelengths& w) -> Bsdf { return plastic(at, w); };
  const SpectrumAt color = c.albedo(m.sheen_color);
  const FloatAt roughness = c.number(m.sheen_roughness);
  return [=](const TexturePoint& at, const Wavelengths& w) -> Bsdf {
    return Cloth{plastic(at, w), clamped_albedo(color(at, w)),
                 std::clamp(sqr(roughness(at)), Cloth::least_alpha, 1.0f)};
  };
}
template ClosureAt compile(const description::PlasticMaterial& m, MaterialCompiler& c);

static ClosureAt closure_of(const description::CoatedPlasticMaterial& m, MaterialCompiler& c) {
  const PlasticAt base(m.base, c);
  const CoatAt coat(m.coat, c);
  return [=](const TexturePoint& at, const Wavelengths& w) -> Bsdf { return coat.over(base(at, w), at, w); };
}
template ClosureAt compile(const description::CoatedPlasticMaterial& m, MaterialCompiler& c);

}  // namespace lanthorn
