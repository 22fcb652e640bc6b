// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Textures, alpha, and the closures that materials produce.
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <sstream>
#include <string>
#include <vector>

#include "support/child_process.h"
#include "support/error_text.h"
#include "support/scene_text.h"
#include "support/temporary_dir.h"

namespace lanthorn::material_test {
namespace {

using test::look;
using test::white;
using test::world;

// A patch in z = 0 whose uv are x and y in [0,1).
const char* const unit_quad = R"(Shape "bilinearmesh" "point3 P" [0 0 0  1 0 0  0 1 0  1 1 0]
)";

std::optional<SurfacePoint> at_uv(const Scene& scene, float u, float v) { return look(scene, {u, v, 1}, {0, 0, -1}); }

Rgb reflectance(const Scene& scene, float u, float v) {
  const auto at = at_uv(scene, u, v);
  if (!at) return {-1, -1, -1};
  const Spectrum& r = std::get<Diffuse>(at->bsdf.get()).reflectance;
  return {r[0], r[1], r[2]};
}

void expect_rgb(const Rgb& got, const Rgb& expected, float tolerance = 1e-5f) {
  EXPECT_NEAR(got.r, expected.r, tolerance);
  EXPECT_NEAR(got.g, expected.g, tolerance);
  EXPECT_NEAR(got.b, expected.b, tolerance);
}

template <class T>
std::string write_image(const test::TemporaryDir& folder, const std::string& name, int width, int height, int channels,
                        const std::vector<T>& pixels) {
  const std::string path = (folder.path() / name).string();
  const auto output = OIIO::ImageOutput::create(path);
  const auto type = sizeof(T) == 1   ? OIIO::TypeDesc::UINT8
                    : sizeof(T) == 2 ? OIIO::TypeDesc::UINT16
                                     : OIIO::TypeDesc::FLOAT;
  OIIO::ImageSpec spec(width, height, channels, type);
  spec["oiio:UnassociatedAlpha"] = 1;
  EXPECT_TRUE(output->open(path, spec));
  EXPECT_TRUE(output->write_image(type, pixels.data()));
  EXPECT_TRUE(output->close());
  return path;
}

float srgb(int byte) {
  const float x = static_cast<float>(byte) / 255;
  return x <= 0.04045f ? x / 12.92f : std::pow((x + 0.055f) / 1.055f, 2.4f);
}

Scene textured(const std::string& image, const std::string& parameters) {
  return world(R"(Texture "t" "spectrum" "imagemap" "string filename" ")" + image + "\" " + parameters +
               R"(
Material "diffuse" "texture reflectance" "t"
)" + unit_quad);
}

class SceneTexture : public ::testing::Test {
 protected:
  test::TemporaryDir folder;
  // 2 x 2: red green / blue grey, from the top left.
  std::string four =
      write_image<std::uint8_t>(folder, "four.png", 2, 2, 3, {255, 0, 0, 0, 255, 0, 0, 0, 255, 100, 100, 100});
};

TEST_F(SceneTexture, TexelsAreExactAndTheFirstRowIsTheTop) {
  const Scene scene = textured(four, R"("string filter" "point")");
  expect_rgb(reflectance(scene, 0.2f, 0.9f), {1, 0, 0});
  expect_rgb(reflectance(scene, 0.7f, 0.6f), {0, 1, 0});
  expect_rgb(reflectance(scene, 0.4f, 0.4f), {0, 0, 1});
  expect_rgb(reflectance(scene, 0.9f, 0.1f), {srgb(100), srgb(100), srgb(100)});
}

TEST_F(SceneTexture, BilinearWeightsTexelCentresAndWraps) {
  const Scene repeat = textured(four, R"("string filter" "bilinear")");
  expect_rgb(reflectance(repeat, 0.25f, 0.75f), {1, 0, 0});
  expect_rgb(reflectance(repeat, 0.5f, 0.75f), {0.5f, 0.5f, 0});
  expect_rgb(reflectance(repeat, 0.35f, 0.75f), {0.8f, 0.2f, 0});
  expect_rgb(reflectance(repeat, 0.05f, 0.75f), {0.6f, 0.4f, 0});  // with the texel that repeats at the left
  const Scene clamp = textured(four, R"("string wrap" "clamp")");
  expect_rgb(reflectance(clamp, 0.05f, 0.75f), {1, 0, 0});
  const Scene black = textured(four, R"("string wrap" "black")");
  expect_rgb(reflectance(black, 0.05f, 0.75f), {0.6f, 0, 0});
}

TEST_F(SceneTexture, MappingScaleAndInvert) {
  const Scene mapped = textured(
      four, R"("string filter" "point" "float uscale" 3 "float udelta" 0.5 "float vscale" -1 "float vdelta" 7)");
  expect_rgb(reflectance(mapped, 0.1f, 0.2f), {0, 1, 0});   // s = 0.8, t = 6.8
  expect_rgb(reflectance(mapped, 0.25f, 0.2f), {1, 0, 0});  // s = 1.25
  expect_rgb(reflectance(textured(four, R"("string filter" "point" "float scale" 0.5)"), 0.2f, 0.9f), {0.5f, 0, 0});
  expect_rgb(reflectance(textured(four, R"("string filter" "point" "bool invert" true)"), 0.2f, 0.9f), {0, 1, 1});
  expect_rgb(reflectance(textured(four, R"("string filter" "point" "float scale" 3)"), 0.2f, 0.9f), {1, 0, 0});
}

TEST_F(SceneTexture, EncodingsDecode) {
  const std::string nearest = R"("string filter" "point" )";
  const float grey = 100.0f / 255;
  expect_rgb(reflectance(textured(four, nearest + R"("string encoding" "linear")"), 0.9f, 0.1f), {grey, grey, grey});
  const float decoded = std::pow(grey, 1.8f);
  expect_rgb(reflectance(textured(four, nearest + R"("string encoding" "gamma 1.8")"), 0.9f, 0.1f),
             {decoded, decoded, decoded});
  const std::string deep = write_image<std::uint16_t>(folder, "deep.png", 1, 1, 3, {32768, 0, 65535});
  const float half = std::pow((32768.0f / 65535 + 0.055f) / 1.055f, 2.4f);
  expect_rgb(reflectance(textured(deep, nearest), 0.5f, 0.5f), {half, 0, 1});
  const std::string floats = write_image<float>(folder, "f.exr", 1, 1, 3, {0.25f, 0.5f, 0.75f});
  expect_rgb(reflectance(textured(floats, nearest), 0.5f, 0.5f), {0.25f, 0.5f, 0.75f});
}

// Features that scene descriptions have, but not pbrt files: `change` is applied to the image texture of a diffuse
// quad.
template <class Change>
Scene textured_with(const std::string& image, const Change& change) {
  SceneDescription scene =
      read_pbrt_string(R"(Film "rgb" WorldBegin Texture "t" "spectrum" "imagemap" "string filename" ")" + image +
                           R"(" "string filter" "point" Material "diffuse" "texture reflectance" "t"
)" + unit_quad,
                       ".", "t.pbrt");
  change(scene, std::get<description::ImageTexture>(scene.spectrum_textures.at(0).node));
  return Scene(std::move(scene));
}

TEST_F(SceneTexture, EmbeddedImagesNeedNoFile) {
  const auto embed = [](const std::string& bytes) {
    return [bytes](SceneDescription& scene, description::ImageTexture& texture) {
      scene.embedded_images.push_back({"model#/images/0", bytes});
      texture.filename.clear();
      texture.embedded = 0;
    };
  };
  const Scene scene = textured_with(four, embed(test::file_bytes(four)));
  expect_rgb(reflectance(scene, 0.2f, 0.9f), {1, 0, 0});
  expect_rgb(reflectance(scene, 0.4f, 0.4f), {0, 0, 1});
  EXPECT_THROW(textured_with(four, embed("no image")), Error);
}

TEST_F(SceneTexture, TintMirrorAndRotation) {
  const Scene tinted = textured_with(four, [](auto&, auto& texture) { texture.tint = {0.5f, 0.25f, 0.125f}; });
  expect_rgb(reflectance(tinted, 0.2f, 0.9f), {0.5f, 0, 0});
  expect_rgb(reflectance(tinted, 0.7f, 0.6f), {0, 0.25f, 0});
  const Scene mirrored = textured_with(four, [](auto&, auto& texture) {
    texture.wrap = description::Wrap::mirror;
    texture.mapping = description::UvMapping{Mat2(4, 0, 0, 1), {-1, 0}};
  });
  const float t = 0.75f;
  for (const auto& [u, expected] : std::vector<std::pair<float, Rgb>>{{0.05f, {0, 1, 0}},  // s = -0.8
                                                                      {0.2f, {1, 0, 0}},   // -0.2
                                                                      {0.3f, {1, 0, 0}},   // 0.2
                                                                      {0.45f, {0, 1, 0}},  // 0.8
                                                                      {0.55f, {0, 1, 0}},  // 1.2
                                                                      {0.7f, {1, 0, 0}},   // 1.8
                                                                      {0.8f, {1, 0, 0}}})  // 2.2
    expect_rgb(reflectance(mirrored, u, t), expected);
  // (s, t) = (v, 1 - u): a quarter turn.
  const Scene turned = textured_with(four, [](auto&, auto& texture) {
    texture.mapping = description::UvMapping{Mat2(0, -1, 1, 0), {0, 1}};
  });
  expect_rgb(reflectance(turned, 0.2f, 0.9f), {0, 1, 0});
  expect_rgb(reflectance(turned, 0.2f, 0.2f), {1, 0, 0});
}

TEST_F(SceneTexture, FloatTexturesReadTheirChannel) {
  const std::string rgba = write_image<std::uint8_t>(folder, "channels.png", 1, 1, 4, {51, 102, 153, 204});
  const std::string grey = write_image<std::uint8_t>(folder, "grey.png", 1, 1, 1, {51});
  const auto alpha = [](const std::string& image, int channel) {
    SceneDescription scene =
        read_pbrt_string(R"(Film "rgb" WorldBegin Texture "r" "float" "imagemap" "string filename" ")" + image +
                             R"(" "string encoding" "linear" Material "conductor" "texture roughness" "r" "bool )"
                             R"(remaproughness" false )" +
                             unit_quad,
                         ".", "t.pbrt");
    auto& texture = std::get<description::ImageTexture>(scene.float_textures.at(0).node);
    texture.channel = channel;
    return std::get<Conductor>(at_uv(Scene(std::move(scene)), 0.5f, 0.5f)->bsdf.get()).alpha_x;
  };
  for (int channel = 0; channel < 4; ++channel)
    EXPECT_NEAR(alpha(rgba, channel), 0.2f * static_cast<float>(channel + 1), 1e-6f);
  EXPECT_NEAR(alpha(grey, 1), 0.2f, 1e-6f);
  EXPECT_EQ(alpha(grey, 3), 1);
  const std::string grey_alpha = write_image<std::uint8_t>(folder, "grey-alpha.png", 1, 1, 2, {51, 204});
  for (int channel = 0; channel < 3; ++channel) EXPECT_NEAR(alpha(grey_alpha, channel), 0.2f, 1e-6f);
  EXPECT_NEAR(alpha(grey_alpha, 3), 0.8f, 1e-6f);
}

TEST_F(SceneTexture, FloatTexturesTakeAlphaWhereItVaries) {
  // Colour 200 everywhere, alpha 255 and 51: the colour must not be multiplied by alpha.
  const std::string rgba =
      write_image<std::uint8_t>(folder, "rgba.png", 2, 1, 4, {200, 200, 200, 255, 200, 200, 200, 51});
  expect_rgb(reflectance(textured(rgba, R"("string filter" "point")"), 0.75f, 0.5f), {srgb(200), srgb(200), srgb(200)},
             0.004f);
  const Scene rough = world(R"(Texture "r" "float" "imagemap" "string filename" ")" + rgba +
                            R"(" "string filter" "point"
Material "conductor" "texture roughness" "r" "bool remaproughness" false
)" + unit_quad);
  EXPECT_FLOAT_EQ(std::get<Conductor>(at_uv(rough, 0.25f, 0.5f)->bsdf.get()).alpha_x, 1);
  EXPECT_FLOAT_EQ(std::get<Conductor>(at_uv(rough, 0.75f, 0.5f)->bsdf.get()).alpha_x, 0.2f);
}

TEST(SceneTextures, CheckerboardScaleAndMixCombine) {
  const Scene scene = world(
      R"(Texture "c" "spectrum" "checkerboard" "rgb tex1" [0.8 0.6 0.4] "rgb tex2" [0.1 0.2 0.3] "float uscale" 4 "float vscale" 2
Texture "s" "spectrum" "scale" "texture tex" "c" "float scale" 0.5
Texture "m" "spectrum" "mix" "texture tex1" "s" "rgb tex2" [1 1 1] "float amount" 0.25
Material "diffuse" "texture reflectance" "m"
)" + std::string(unit_quad));
  const auto expected = [](float r, float g, float b) {
    return Rgb{0.75f * 0.5f * r + 0.25f, 0.75f * 0.5f * g + 0.25f, 0.75f * 0.5f * b + 0.25f};
  };
  expect_rgb(reflectance(scene, 0.1f, 0.1f), expected(0.8f, 0.6f, 0.4f));
  expect_rgb(reflectance(scene, 0.3f, 0.1f), expected(0.1f, 0.2f, 0.3f));
  expect_rgb(reflectance(scene, 0.3f, 0.9f), expected(0.8f, 0.6f, 0.4f));
}

TEST(SceneTextures, SolidCheckerboardLivesInTextureSpace) {
  const Scene scene = world(
      R"(AttributeBegin Scale 0.5 0.5 0.5 Translate 0.5 0 0 Texture "c" "spectrum" "checkerboard" "integer dimension" 3 "rgb tex1" [1 1 1] "rgb tex2" [0 0 0] AttributeEnd
Material "diffuse" "texture reflectance" "c"
Translate 0 0 0.1
)" + std::string(unit_quad));
  // Cells 0.5 m wide, starting at x = 0.25.
  expect_rgb(reflectance(scene, 0.1f, 0.1f), {0, 0, 0});
  expect_rgb(reflectance(scene, 0.3f, 0.1f), {1, 1, 1});
  expect_rgb(reflectance(scene, 0.3f, 0.6f), {0, 0, 0});
}

TEST(SceneTextures, TrianglesWithoutUvHavePbrtsDefaults) {
  const Scene scene = world(R"(Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 0 1 0] "integer indices" [0 1 2]
)");
  const auto at = at_uv(scene, 0.25f, 0.5f);
  ASSERT_TRUE(at);
  EXPECT_NEAR(at->uv.x, 0.75f, 1e-6f);
  EXPECT_NEAR(at->uv.y, 0.5f, 1e-6f);
}

// Constant alpha is a probability. False-alarm rate of each check below 1e-6 (five standard deviations).
TEST(SceneAlpha, IsAProbabilityThatBothQueriesAgreeOn) {
  for (const char* shape : {unit_quad, R"(Shape "bilinearmesh" "point3 P" [0 0 0  1 0 0  0 1 0  1 1 1e-3]
)",
                            R"(Translate 0.5 0.5 0 Shape "disk" "float radius" 2
)"}) {
    std::string with_alpha(shape);
    with_alpha.insert(with_alpha.find_last_not_of('\n') + 1, R"( "float alpha" 0.3)");
    const Scene scene = world(with_alpha);
    HashRng rng(1);
    constexpr int n = 20000;
    int seen = 0;
    for (int i = 0; i < n; ++i) {
      const Ray ray{{rng.next(), rng.next(), 1}, {0, 0, -1}};
      const bool hit = scene.intersect(ray, white).has_value();
      EXPECT_EQ(scene.visible(ray), !hit);
      seen += hit ? 1 : 0;
    }
    EXPECT_NEAR(seen, 0.3 * n, 5 * std::sqrt(0.21 * n));
  }
}

TEST(SceneAlpha, LayersAreIndependent) {
  // Two shapes one after the other, and the two sides of a sphere.
  const std::string quad = std::string(unit_quad).substr(0, std::string(unit_quad).size() - 1) + R"( "float alpha" 0.5
)";
  const Scene quads = world(quad + "Translate 0 0 -0.5\n" + quad);
  const Scene sphere = world(R"(Translate 0.5 0.5 0 Shape "sphere" "float radius" 3 "float alpha" 0.5
)");
  HashRng rng(2);
  constexpr int n = 20000;
  int through_quads = 0, through_sphere = 0;
  for (int i = 0; i < n; ++i) {
    const Ray ray{{rng.next(), rng.next(), 9}, {0, 0, -1}};
    through_quads += quads.visible(ray) ? 1 : 0;
    through_sphere += sphere.visible(ray) ? 1 : 0;
  }
  EXPECT_NEAR(through_quads, 0.25 * n, 5 * std::sqrt(0.1875 * n));
  EXPECT_NEAR(through_sphere, 0.25 * n, 5 * std::sqrt(0.1875 * n));
}

TEST_F(SceneTexture, AlphaTexturesCutOut) {
  const std::string mask = write_image<std::uint8_t>(folder, "mask.png", 2, 1, 1, {0, 255});
  const Scene scene = world(R"(Texture "a" "float" "imagemap" "string filename" ")" + mask +
                            R"(" "string filter" "point"
Shape "bilinearmesh" "point3 P" [0 0 0  1 0 0  0 1 0  1 1 0] "texture alpha" "a"
)");
  EXPECT_FALSE(at_uv(scene, 0.25f, 0.5f));
  EXPECT_TRUE(at_uv(scene, 0.75f, 0.5f));
  EXPECT_TRUE(scene.visible({{0.25f, 0.5f, 1}, {0, 0, -1}}));
}

TEST(PointBsdf, CopiesKeepTheirClosures) {
  const Bsdf of_material = Diffuse{Spectrum(0.25f)};
  const PointBsdf shared(&of_material);
  PointBsdf own = Diffuse{Spectrum(0.5f)};
  const PointBsdf copy = own;
  own = Diffuse{Spectrum(0.75f)};
  EXPECT_EQ(std::get<Diffuse>(copy.get()).reflectance[0], 0.5f);
  EXPECT_EQ(std::get<Diffuse>(own.get()).reflectance[0], 0.75f);
  own = shared;
  EXPECT_EQ(&own.get(), &of_material);
  own = copy;
  EXPECT_EQ(std::get<Diffuse>(own.get()).reflectance[0], 0.5f);
}

// Closures that are constant over the surface are not rebuilt for each hit.
TEST(SceneMaterials, ConstantClosuresAreShared) {
  const Scene scene = world(std::string(R"(Material "diffuse" "rgb reflectance" [0.2 0.3 0.4]
)") + unit_quad);
  EXPECT_EQ(&at_uv(scene, 0.2f, 0.5f)->bsdf.get(), &at_uv(scene, 0.6f, 0.5f)->bsdf.get());
}

TEST(SceneMaterials, ParametersBecomeClosures) {
  const auto bsdf = [](const std::string& material) {
    const Scene scene = world(material + "\n" + unit_quad);
    return at_uv(scene, 0.5f, 0.5f)->bsdf.get();
  };
  EXPECT_FLOAT_EQ(std::get<Diffuse>(bsdf(R"(Material "diffuse" "rgb reflectance" [0.2 0.3 0.4])")).reflectance[1],
                  0.3f);
  const auto rough = std::get<Dielectric>(bsdf(R"(Material "dielectric" "float eta" 1.33 "float roughness" 0.25)"));
  EXPECT_FLOAT_EQ(rough.eta, 1.33f);
  EXPECT_FLOAT_EQ(rough.alpha_x, 0.5f);
  EXPECT_FALSE(rough.dispersive);
  const auto flint = std::get<Dielectric>(bsdf(R"(Material "dielectric" "spectrum eta" "glass-F11")"));
  EXPECT_TRUE(flint.dispersive);
  EXPECT_GT(flint.eta, 1.6f);
  const auto metal = std::get<Conductor>(
      bsdf(R"(Material "conductor" "float uroughness" 0.1 "float vroughness" 0.4 "bool remaproughness" false)"));
  EXPECT_FLOAT_EQ(metal.alpha_x, 0.1f);
  EXPECT_FLOAT_EQ(metal.alpha_y, 0.4f);
  const auto tinted = std::get<Conductor>(bsdf(R"(Material "conductor" "rgb reflectance" [0.9 0.6 0.3])"));
  EXPECT_FLOAT_EQ(tinted.eta[0], 1);
  EXPECT_NEAR(tinted.k[1], 2 * std::sqrt(0.6f / 0.4f), 1e-4f);
  const auto coated = std::get<CoatedDiffuse>(bsdf(R"(Material "coateddiffuse" "float thickness" 0.2 "float g" 0.3 )"
                                                   R"("rgb albedo" [0.5 0.5 0.5])"));
  EXPECT_FLOAT_EQ(coated.coat.eta, 1.5f);
  EXPECT_FLOAT_EQ(coated.thickness, 0.2f);
  EXPECT_FLOAT_EQ(coated.g, 0.3f);
  const Scene varnished = world(R"(Material "coateddiffuse" "float roughness" 0.25
)" + std::string(unit_quad));
  const auto seen = at_uv(varnished, 0.5f, 0.5f);
  ASSERT_TRUE(seen);
  const auto clear = std::get<ClearCoated>(seen->bsdf.get());
  EXPECT_FLOAT_EQ(clear.passage->coat().eta, 1.5f);
  EXPECT_FLOAT_EQ(clear.passage->coat().alpha_x, 0.5f);
  EXPECT_EQ(clear.arrivals, 5);
  for (const char* varying : {R"("float uroughness" 0.1)", R"("spectrum eta" "glass-F11")"})
    EXPECT_TRUE(std::holds_alternative<CoatedDiffuse>(bsdf(fmt::format(R"(Material "coateddiffuse" {})", varying))))
        << varying;
  const auto plated = std::get<CoatedConductor>(bsdf(R"(Material "coatedconductor" "rgb reflectance" [0.5 0.5 0.5])"));
  EXPECT_NEAR(plated.base.eta[0], 1 / 1.5f, 1e-5f);  // relative to the coat
  const auto leaf = std::get<DiffuseTransmission>(bsdf(R"(Material "diffusetransmission" "float scale" 0.5)"));
  EXPECT_FLOAT_EQ(leaf.reflectance[0], 0.125f);
}

TEST(SceneMaterials, IndicesAreThoseOfTheHeroWavelength) {
  const Scene scene = world(R"(Material "dielectric" "spectrum eta" "glass-F11"
)" + std::string(unit_quad));
  EXPECT_TRUE(scene.has_dispersion());
  EXPECT_TRUE(scene.has_measured_spectra());
  const auto eta = [&](float u) {
    return std::get<Dielectric>(scene.intersect({{0.5f, 0.5f, 1}, {0, 0, -1}}, Wavelengths::spectral(u))->bsdf.get())
        .eta;
  };
  const auto eta_rgb = [&](float u) {
    return std::get<Dielectric>(scene.intersect({{0.5f, 0.5f, 1}, {0, 0, -1}}, Wavelengths::rgb(u))->bsdf.get()).eta;
  };
  EXPECT_GT(eta(0.05f), eta(0.9f) + 0.005f);  // blue light is refracted more
  EXPECT_GT(eta_rgb(0.05f), eta_rgb(0.9f) + 0.005f);
  EXPECT_FALSE(world(unit_quad).has_measured_spectra());
}

// An index is dispersive if it varies, not if it is written as a spectrum.
TEST(SceneMaterials, ConstantSpectraDisperseNothing) {
  for (const char* material : {"dielectric", "coateddiffuse", "coatedconductor", "thindielectric"}) {
    const char* const name = std::string(material) == "coatedconductor" ? "interface.eta" : "eta";
    const Scene scene = world(fmt::format(R"(Material "{}" "spectrum {}" [360 1.5 500 1.5 830 1.5]
{})",
                                          material, name, unit_quad));
    EXPECT_FALSE(scene.has_dispersion()) << material;
    EXPECT_FALSE(scene.has_measured_spectra()) << material;
  }
  const Scene metal =
      world(std::string(R"(Material "conductor" "spectrum eta" [360 .2 830 .2] "spectrum k" [360 3 830 3]
)") + unit_quad);
  EXPECT_FALSE(metal.has_measured_spectra());
}

TEST(SceneMaterials, MixesChooseByAmountAndAlwaysTheSame) {
  const auto scene_of = [](const char* amount) {
    return world(
        R"(MakeNamedMaterial "a" "string type" "diffuse" "rgb reflectance" [0 0 0]
MakeNamedMaterial "b" "string type" "diffuse" "rgb reflectance" [1 1 1]
Material "mix" "string materials" ["a" "b"] "float amount" )" +
        std::string(amount) + "\n" + unit_quad);
  };
  const Scene scene = scene_of("0.4");
  HashRng rng(3);
  constexpr int n = 20000;
  double second = 0;
  for (int i = 0; i < n; ++i) {
    const float u = rng.next(), v = rng.next();
    const Rgb first = reflectance(scene, u, v);
    EXPECT_EQ(first, reflectance(scene, u, v));
    second += first.r;
  }
  EXPECT_NEAR(second, 0.4 * n, 5 * std::sqrt(0.24 * n));
  expect_rgb(reflectance(scene_of("0"), 0.5f, 0.5f), {0, 0, 0});
  expect_rgb(reflectance(scene_of("1"), 0.5f, 0.5f), {1, 1, 1});
}

TEST(SceneMaterials, MixesHaveTheMediumOfTheirPartInside) {
  const std::string parts =
      R"(MakeNamedMedium "fog" "string type" "homogeneous"
MediumInterface "fog" ""
MakeNamedMaterial "grey" "string type" "diffuse"
MakeNamedMaterial "glass" "string type" "dielectric"
MakeNamedMaterial "none" "string type" "interface"
MakeNamedMaterial "skin" "string type" "subsurface" "string name" "Skin1"
MakeNamedMaterial "milk" "string type" "subsurface" "string name" "Wholemilk"
)";
  const auto mix = [](const std::string& materials, const std::string& amount = "0.5") {
    return R"("string type" "mix" "string materials" [)" + materials + R"(] "float amount" )" + amount + "\n";
  };
  // fog, skin, milk
  const auto inside = [&](const std::string& material, std::size_t warnings = 0) {
    const Scene scene = world(parts + material + R"(NamedMaterial "m"
)" + unit_quad);
    EXPECT_EQ(scene.warnings().size(), warnings) << material;
    return static_cast<int>(at_uv(scene, 0.4f, 0.7f)->media.inside);
  };
  const std::string named = R"(MakeNamedMaterial "m" )";
  const int fog = inside(named + mix(R"("grey" "glass")"));
  const int skin = fog + 1, milk = fog + 2;
  EXPECT_EQ(inside(named + mix(R"("grey" "skin")")), skin);
  EXPECT_EQ(inside(named + mix(R"("milk" "glass")")), milk);
  EXPECT_EQ(inside(named + mix(R"("none" "milk")"), 1), milk);
  EXPECT_EQ(inside(named + mix(R"("grey" "skin")", "0")), fog);
  EXPECT_EQ(inside(named + mix(R"("skin" "grey")", "1")), fog);
  EXPECT_EQ(inside(named + mix(R"("skin" "milk")", "1")), milk);
  EXPECT_EQ(inside(R"(MakeNamedMaterial "n" )" + mix(R"("grey" "skin")") + named + mix(R"("skin" "n")")), skin);
  EXPECT_EQ(inside(named + mix(R"("skin" "milk")"), 1), skin);
  const Scene both = world(parts + named + mix(R"("skin" "milk")") + R"(NamedMaterial "m"
)" + unit_quad);
  EXPECT_NE(both.warnings().at(0).message.find("different interior media"), std::string::npos);
  EXPECT_EQ(both.warnings()[0].location.line, 11);
}

// Mixes that refer to the previous mix once or twice. Line i + 4 defines mix i.
TEST(SceneMaterials, RefusesDeepAndDoublingMixes) {
  const auto error_of = [](int last, bool is_doubling, const std::string& amount) {
    std::string text = R"(MakeNamedMaterial "m0" "string type" "diffuse"
)";
    for (int i = 1; i <= last; ++i)
      text += fmt::format(R"(MakeNamedMaterial "m{}" "string type" "mix" "string materials" ["m{}" "m{}"] {}
)",
                          i, i - 1, is_doubling ? i - 1 : 0, amount);
    text += fmt::format(R"(NamedMaterial "m{}"
)",
                        last);
    return test::error_text([&] { EXPECT_TRUE(at_uv(world(text + unit_quad), 0.5f, 0.5f)); });
  };
  const std::string deep = "mix materials are nested more than 256 deep",
                    costly = "this mix takes more than 1000 lookups: a material counts once for each reference to it";
  const std::string half = R"("float amount" 0.5)";
  EXPECT_EQ(error_of(256, false, half), "no error");
  EXPECT_EQ(error_of(10'000, false, half), "test scene:261:1: " + deep);
  EXPECT_EQ(error_of(9, true, half), "no error");
  EXPECT_EQ(error_of(60, true, half), "test scene:14:1: " + costly);
  EXPECT_EQ(error_of(60, true, R"("float amount" 1)"), "no error");
}

TEST(SceneMaterials, InterfacesAreNotSurfaces) {
  const Scene scene = world(R"(Material "interface"
)" + std::string(unit_quad));
  EXPECT_FALSE(at_uv(scene, 0.5f, 0.5f));
  EXPECT_TRUE(scene.visible({{0.5f, 0.5f, 1}, {0, 0, -1}}));
}

TEST(SceneMaterials, AnisotropyFollowsDpdu) {
  const Scene scene = world(
      R"(Rotate 30 0 0 1
Material "conductor" "float uroughness" 0.1 "float vroughness" 0.4
Shape "trianglemesh" "point3 P" [-9 -9 0 9 -9 0 0 9 0] "point2 uv" [0 0 0 18 18 9] "integer indices" [0 1 2]
)");
  const auto at = look(scene, {0, 0, 1}, {0, 0, -1});
  ASSERT_TRUE(at);
  // v runs along the object's x, u along its y.
  const Vec3 along_u = rotate(30, {0, 0, 1}).vector({0, 1, 0});
  EXPECT_NEAR(std::fabs(dot(at->shading.s, along_u)), 1, 1e-4f);
}

TEST(SceneErrors, NameTheirPlace) {
  const auto message = [](const std::string& directives) { return test::error_text([&] { world(directives); }); };
  EXPECT_NE(message(R"(Texture "t" "spectrum" "imagemap" "string filename" "no-such.png"
Material "diffuse" "texture reflectance" "t"
)" + std::string(unit_quad))
                .find("no-such.png"),
            std::string::npos);
  EXPECT_NE(message(R"(Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 0 1 0] "integer indices" [0 1 7]
)")
                .find("test scene:"),
            std::string::npos);
}

// Refraction is 0/0 there, for light that goes straight on.
TEST(Materials, AnIndexOfAlmostOneBendsNothing) {
  for (const char* index : {"1", "1.0000001", "0.9999999"}) {
    const Scene scene = world(R"(Material "dielectric" "float roughness" 1 "float eta" )" + std::string(index) + R"(
Shape "disk")");
    const auto at = look(scene, {0, 0, 1}, {0, 0, -1});
    ASSERT_TRUE(at);
    const Bsdf& bsdf = at->bsdf;
    const Vec3 wi = normalize(Vec3(0.3f, 0.2f, 0.9f));
    const auto s = sample(bsdf, wi, 0.5f, Vec2(0.3f, 0.6f), Transport::radiance);
    ASSERT_TRUE(s) << index;
    EXPECT_EQ(s->wo, -wi) << index;
    EXPECT_TRUE(evaluate(bsdf, wi, -wi, Transport::radiance).f.is_black()) << index;
  }
}

}  // namespace
}  // namespace lanthorn::material_test
