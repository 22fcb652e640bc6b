// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// A toy material: everything that src/material must provide for a kind of material.
#include <gtest/gtest.h>

#include "material/kind.h"
#include "material/parts.h"
#include "surface/diffuse.h"

namespace lanthorn {

namespace description {
namespace {

/// Paper that transmits light where it is thin.
struct ToyMaterial {
  SpectrumParameter colour{0.5f, {}};
  FloatParameter thickness{1, {}};  ///< in [0,1]
};

}  // namespace
}  // namespace description

static ClosureAt closure_of(const description::ToyMaterial& m, MaterialCompiler& c) {
  return [colour = c.albedo(m.colour), thickness = c.number(m.thickness)](const TexturePoint& at,
                                                                          const Wavelengths& w) -> Bsdf {
    const Spectrum all = clamped_albedo(colour(at, w));
    const float share = thickness(at);
    return DiffuseTransmission{share * all, (1 - share) * all};
  };
}
template ClosureAt compile(const description::ToyMaterial& m, MaterialCompiler& c);

namespace toy_material_test {
namespace {

// A separate scene, for textures.
struct Workshop {
  SceneDescription scene;
  SpectrumStore spectra;
  MaterialStore store;
  TextureGraph textures{scene, spectra};
  SourceLocation nowhere;
  MaterialCompiler compiler{scene, textures, spectra, store, nowhere};
};

DiffuseTransmission at_u(const ClosureAt& closure, float u) {
  TexturePoint at;
  at.uv = {u, 0};
  return std::get<DiffuseTransmission>(closure(at, Wavelengths::rgb(0.5f)));
}

TEST(ToyMaterial, OfNumbersIsConstant) {
  Workshop shop;
  const ClosureAt closure = compile(description::ToyMaterial{{0.8f, {}}, {0.25f, {}}}, shop.compiler);
  EXPECT_TRUE(shop.compiler.is_constant);
  EXPECT_FLOAT_EQ(at_u(closure, 0.1f).reflectance[0], 0.2f);
  EXPECT_FLOAT_EQ(at_u(closure, 0.9f).transmittance[1], 0.6f);
}

TEST(ToyMaterial, OfATextureVaries) {
  Workshop shop;
  // 0 at u = 0, 1 at u = 1.
  description::BilerpTexture<description::FloatParameter> ramp;
  ramp.v00 = ramp.v01 = {0, {}};
  ramp.v10 = ramp.v11 = {1, {}};
  shop.scene.float_textures.push_back({ramp, {}});
  const ClosureAt closure = compile(description::ToyMaterial{{1.0f, {}}, {0, 0}}, shop.compiler);
  EXPECT_FALSE(shop.compiler.is_constant);
  EXPECT_FLOAT_EQ(at_u(closure, 0.25f).reflectance[2], 0.25f);
  EXPECT_FLOAT_EQ(at_u(closure, 0.25f).transmittance[2], 0.75f);
}

}  // namespace
}  // namespace toy_material_test
}  // namespace lanthorn
