// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "scene/scene.h"
#include "support/gltf_triangle.h"
#include "support/read_gltf.h"

namespace lanthorn::gltf_material_test {
namespace {

using namespace description;
using nlohmann::json;
using test::corners;
using test::GltfWriter;
using test::one_mesh;
using test::read_gltf;
using test::warnings;

// The materials of a file that contains this one.
SceneDescription with_material(json material, GltfWriter file = {}) {
  file.mesh(corners, {0, 1, 2}, file.add("materials", std::move(material)));
  file.node({{"mesh", 0}});
  return read_gltf(file);
}
template <class T>
T only_material(json material) {
  const SceneDescription scene = with_material(std::move(material));
  return std::get<T>(scene.materials.at(scene.shapes.at(0).material).node);
}
Rgb rgb(const SpectrumParameter& p) { return std::get<RgbSpectrum>(p.value).rgb; }

TEST(GltfMaterial, MetallicRoughness) {
  const auto plastic = only_material<PlasticMaterial>(
      {{"pbrMetallicRoughness",
        {{"baseColorFactor", {0.1, 0.2, 0.3, 1}}, {"metallicFactor", 0}, {"roughnessFactor", 0.5}}},
       {"extensions", {{"KHR_materials_ior", {{"ior", 1.7}}}, {"KHR_materials_specular", {{"specularFactor", 0.5}}}}}});
  EXPECT_EQ(rgb(plastic.reflectance), (Rgb{0.1f, 0.2f, 0.3f}));
  EXPECT_EQ(plastic.roughness.u.value, 0.25f);
  EXPECT_FALSE(plastic.roughness.remap);
  EXPECT_EQ(std::get<float>(plastic.eta), 1.7f);
  EXPECT_EQ(plastic.specular.value, 0.5f);
  const auto metal = only_material<ConductorMaterial>({{"pbrMetallicRoughness", {{"roughnessFactor", 0.1}}}});
  EXPECT_EQ(rgb(*metal.reflectance), (Rgb{1, 1, 1}));
  EXPECT_FLOAT_EQ(metal.roughness.v.value, 0.01f);
  const SceneDescription mixed =
      with_material({{"name", "alloy"}, {"pbrMetallicRoughness", {{"metallicFactor", 0.25}}}});
  ASSERT_EQ(mixed.materials.size(), 3u);
  EXPECT_EQ(mixed.materials[2].name, "alloy");
  const auto& mix = std::get<MixMaterial>(mixed.materials[2].node);
  EXPECT_EQ(mix.amount.value, 0.25f);
  EXPECT_TRUE(std::holds_alternative<PlasticMaterial>(mixed.materials[mix.materials[0]].node));
  EXPECT_TRUE(std::holds_alternative<ConductorMaterial>(mixed.materials[mix.materials[1]].node));
  // Without a material: glTF's default is white rough metal.
  EXPECT_TRUE(std::holds_alternative<ConductorMaterial>(read_gltf(one_mesh()).materials.at(0).node));
}

TEST(GltfMaterial, GlassAndCoats) {
  const json clear = {{"transmissionFactor", 1}};
  const json dielectric = {{"metallicFactor", 0}, {"roughnessFactor", 0}};
  const auto glass = only_material<DielectricMaterial>({{"pbrMetallicRoughness", dielectric},
                                                        {"extensions",
                                                         {{"KHR_materials_transmission", clear},
                                                          {"KHR_materials_volume", {{"thicknessFactor", 1}}},
                                                          {"KHR_materials_ior", {{"ior", 1.33}}}}}});
  EXPECT_EQ(std::get<float>(glass.eta), 1.33f);
  only_material<ThinDielectricMaterial>(
      {{"pbrMetallicRoughness", dielectric}, {"extensions", {{"KHR_materials_transmission", clear}}}});
  const auto prism = only_material<DielectricMaterial>({{"pbrMetallicRoughness", dielectric},
                                                        {"extensions",
                                                         {{"KHR_materials_transmission", clear},
                                                          {"KHR_materials_volume", {{"thicknessFactor", 1}}},
                                                          {"KHR_materials_ior", {{"ior", 1.6}}},
                                                          {"KHR_materials_dispersion", {{"dispersion", 0.5}}}}}});
  const auto& eta = std::get<SampledSpectrum>(prism.eta);
  const auto at = [&](float nm) {
    const auto i = static_cast<std::size_t>((nm - eta.nm[0]) / 5);
    return lerp((nm - eta.nm[i]) / 5, eta.values[i], eta.values[i + 1]);
  };
  EXPECT_NEAR(at(587.6f), 1.6f, 1e-4f);
  EXPECT_NEAR((at(587.6f) - 1) / (at(486.1f) - at(656.3f)), 40, 0.1f);  // Abbe's number: 20 / 0.5
  const auto lacquered = only_material<CoatedConductorMaterial>(
      {{"extensions", {{"KHR_materials_clearcoat", {{"clearcoatFactor", 1}, {"clearcoatRoughnessFactor", 0.5}}}}}});
  EXPECT_EQ(lacquered.coat.roughness.u.value, 0.25f);
  const auto glazed = only_material<CoatedPlasticMaterial>(
      {{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0.5}}},
       {"extensions", {{"KHR_materials_clearcoat", {{"clearcoatFactor", 1}}}, {"KHR_materials_ior", {{"ior", 1.6}}}}}});
  EXPECT_EQ(glazed.base.roughness.u.value, 0.25f);
  EXPECT_EQ(std::get<float>(glazed.base.eta), 1.6f);
}

TEST(GltfMaterial, AttenuationIsAMediumInside) {
  const SceneDescription scene = with_material(
      {{"pbrMetallicRoughness", {{"metallicFactor", 0}}},
       {"extensions",
        {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
         {"KHR_materials_volume",
          {{"thicknessFactor", 1}, {"attenuationDistance", 0.5}, {"attenuationColor", {1, 0.5, 0.25}}}}}}});
  const description::Medium& medium = scene.media.at(scene.shapes.at(0).inside_medium.value());
  const Rgb sigma = std::get<RgbSpectrum>(medium.sigma_a).rgb;
  EXPECT_EQ(sigma.r, 0);
  EXPECT_NEAR(std::exp(-0.5f * sigma.g), 0.5f, 1e-6f);
  EXPECT_NEAR(std::exp(-0.5f * sigma.b), 0.25f, 1e-6f);
}

TEST(GltfMaterial, TexturesKeepTheirChannels) {
  GltfWriter file;
  file.add("images", {{"bufferView", file.view("PNG or so")}, {"mimeType", "image/png"}});
  file.add("images", {{"uri", "data:image/png;base64,QUJD"}});
  file.add("images", {{"uri", "wood%20grain.png"}});
  file.add("samplers", {{"wrapS", 33648}, {"wrapT", 33648}, {"magFilter", 9728}});
  for (const int image : {0, 1, 2}) file.add("textures", {{"source", image}});
  file.root["textures"][0]["sampler"] = 0;
  const SceneDescription scene = with_material(
      {{"normalTexture", {{"index", 1}, {"scale", 0.5}}},
       {"pbrMetallicRoughness",
        {{"baseColorFactor", {0.5, 0.25, 1, 0.75}},
         {"baseColorTexture", {{"index", 0}, {"texCoord", 0}}},
         {"metallicFactor", 0.5},
         {"metallicRoughnessTexture", {{"index", 1}}}}},
       {"alphaMode", "MASK"},
       {"extensions",
        {{"KHR_materials_transmission", {{"transmissionTexture", {{"index", 2}}}, {"transmissionFactor", 1}}}}}},
      file);
  ASSERT_EQ(scene.embedded_images.size(), 2u);
  EXPECT_EQ(scene.embedded_images[0].bytes, "PNG or so");
  EXPECT_EQ(scene.embedded_images[0].name, "t.gltf#/images/0");
  EXPECT_EQ(scene.embedded_images[1].bytes, "ABC");
  ASSERT_EQ(scene.spectrum_textures.size(), 1u);
  const auto& base = std::get<ImageTexture>(scene.spectrum_textures[0].node);
  EXPECT_EQ(base.tint, (Rgb{0.5f, 0.25f, 1}));
  EXPECT_EQ(base.embedded, 0u);
  EXPECT_EQ(base.wrap, Wrap::mirror);
  EXPECT_EQ(base.filter, ImageFilter::point);
  EXPECT_EQ(base.encoding, Encoding::srgb);
  const auto image = [&](const FloatParameter& p) {
    return std::get<ImageTexture>(scene.float_textures.at(p.texture.value()).node);
  };
  const auto& mix = std::get<MixMaterial>(scene.materials.at(scene.shapes[0].material).node);
  EXPECT_EQ(image(mix.amount).channel, 2);
  EXPECT_EQ(image(mix.amount).scale, 0.5f);
  EXPECT_EQ(image(mix.amount).embedded, 1u);
  EXPECT_EQ(image(mix.amount).encoding, Encoding::linear);
  const auto& metal = std::get<ConductorMaterial>(scene.materials.at(mix.materials[1]).node);
  const auto& squared =
      std::get<ScaleTexture<FloatParameter>>(scene.float_textures.at(*metal.roughness.u.texture).node);
  EXPECT_EQ(squared.tex.texture, squared.scale.texture);
  EXPECT_EQ(image(squared.tex).channel, 1);
  const auto& see_through = std::get<MixMaterial>(scene.materials.at(mix.materials[0]).node);
  EXPECT_EQ(image(see_through.amount).channel, 0);
  EXPECT_EQ(image(see_through.amount).filename, "wood grain.png");
  EXPECT_EQ(scene.files.count("wood%20grain.png"), 1u);
  for (const Material& material : scene.materials) {
    const bool is_mix = std::holds_alternative<MixMaterial>(material.node);
    ASSERT_EQ(material.normal_map.has_value(), !is_mix);
    if (is_mix) continue;
    EXPECT_EQ(material.normal_map->strength, 0.5f);
    EXPECT_EQ(material.normal_map->image.encoding, Encoding::linear);
    EXPECT_EQ(material.normal_map->image.embedded, 1u);
  }
  const auto& mask =
      std::get<ThresholdTexture<FloatParameter>>(scene.float_textures.at(scene.shapes[0].alpha.texture.value()).node);
  const ImageTexture alpha = image(mask.value);
  EXPECT_EQ(alpha.channel, 3);
  EXPECT_EQ(alpha.scale, 0.75f);
  EXPECT_EQ(mask.least, 0.5f);
}

TEST(GltfMaterial, TextureTransform) {
  GltfWriter file;
  file.add("images", {{"uri", "a.png"}});
  file.add("textures", {{"source", 0}});
  const json transform = {{"offset", {0.1, 0.2}}, {"rotation", 0.3}, {"scale", {2, 3}}, {"texCoord", 4}};
  const SceneDescription scene =
      with_material({{"pbrMetallicRoughness",
                      {{"baseColorTexture", {{"index", 0}, {"extensions", {{"KHR_texture_transform", transform}}}}}}}},
                    file);
  const auto& image = std::get<ImageTexture>(scene.spectrum_textures.at(0).node);
  const Vec2 uv(0.6f, 0.7f);
  const float c = std::cos(0.3f), s = std::sin(0.3f);
  const Vec2 expected(c * 2 * uv.x + s * 3 * uv.y + 0.1f, -s * 2 * uv.x + c * 3 * uv.y + 0.2f);
  const auto& mapping = std::get<UvMapping>(image.mapping);
  const Vec2 st = mapping.linear * Vec2(uv.x, 1 - uv.y) + mapping.offset;
  EXPECT_NEAR(st.x, expected.x, 1e-6f);
  EXPECT_NEAR(st.y, 1 - expected.y, 1e-6f);
}

TEST(GltfMaterial, AlphaModes) {
  const auto alpha = [](const char* mode, float factor, float cutoff) {
    return with_material({{"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, factor}}}},
                          {"alphaMode", mode},
                          {"alphaCutoff", cutoff}})
        .shapes.at(0)
        .alpha.value;
  };
  EXPECT_EQ(alpha("OPAQUE", 0.25f, 0.5f), 1);
  EXPECT_EQ(alpha("BLEND", 0.25f, 0.5f), 0.25f);
  EXPECT_EQ(alpha("MASK", 0.25f, 0.5f), 0);
  EXPECT_EQ(alpha("MASK", 0.25f, 0.25f), 1);
}

TEST(GltfMaterial, Emission) {
  const SceneDescription scene =
      with_material({{"emissiveFactor", {1, 0.5, 0.25}},
                     {"doubleSided", true},
                     {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 10}}}}}});
  const description::AreaLight& light = scene.area_lights.at(0);
  EXPECT_EQ(rgb(light.radiance), (Rgb{1, 0.5f, 0.25f}));
  EXPECT_EQ(light.scale, 10);
  EXPECT_TRUE(light.two_sided);

  GltfWriter file;
  file.add("images", {{"uri", "a.png"}});
  file.add("textures", {{"source", 0}});
  const SceneDescription textured =
      with_material({{"emissiveFactor", {1, 0.5, 0.25}}, {"emissiveTexture", {{"index", 0}}}}, file);
  const SpectrumParameter& radiance = textured.area_lights.at(0).radiance;
  EXPECT_EQ(std::get<ImageTexture>(textured.spectrum_textures.at(radiance.texture.value()).node).tint,
            (Rgb{1, 0.5f, 0.25f}));
  EXPECT_EQ(textured.lights.size(), 1u);  // it may be black except for a few spots
}

// The closure at the centre of the only triangle, seen from the front.
template <class Closure>
Closure closure_of(const SceneDescription& description) {
  const Scene scene(description);
  const auto at = scene.intersect({{0.25f, 0.25f, 1}, {0, 0, -1}}, Wavelengths::rgb(0.5f));
  return std::get<Closure>(at.value().bsdf.get());
}

// One triangle with the colours red, green and blue at its corners; at (1/4, 1/4) they have the weights 1/2, 1/4, 1/4.
GltfWriter coloured(json material, std::size_t components) {
  GltfWriter file;
  file.mesh(corners, {0, 1, 2}, file.add("materials", std::move(material)));
  json& attributes = file.root["meshes"][0]["primitives"][0]["attributes"];
  attributes["COLOR_0"] = components == 3 ? file.accessor<std::uint8_t>({255, 0, 0, 0, 255, 0, 0, 0, 255}, 3, true)
                                          : file.accessor<float>({1, 0, 0, 1, 0, 1, 0, 0.5f, 0, 0, 1, 0}, 4);
  file.node({{"mesh", 0}});
  return file;
}

TEST(GltfMaterial, VertexColoursMultiplyTheBaseColour) {
  const json dull = {{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"baseColorFactor", {0.8, 0.4, 1, 1}}}}};
  for (const std::size_t components : {3u, 4u}) {
    const Spectrum colour = closure_of<Plastic>(read_gltf(coloured(dull, components))).reflectance;
    EXPECT_NEAR(colour[0], 0.5f * 0.8f, 1e-5f) << components;
    EXPECT_NEAR(colour[1], 0.25f * 0.4f, 1e-5f) << components;
    EXPECT_NEAR(colour[2], 0.25f * 1, 1e-5f) << components;
  }
  // The same without a material; and the material without vertex colours is white.
  GltfWriter file = coloured(dull, 3);
  file.root["meshes"][0]["primitives"][0].erase("material");
  const SceneDescription metal = read_gltf(file);
  EXPECT_TRUE(std::get<ConductorMaterial>(metal.materials.at(metal.shapes[0].material).node).reflectance->texture);
  file = coloured(dull, 3);
  file.mesh(corners, {0, 1, 2}, 0);
  file.node({{"mesh", 1}});
  const SceneDescription both = read_gltf(file);
  ASSERT_EQ(both.shapes.size(), 2u);
  EXPECT_NE(both.shapes[0].material, both.shapes[1].material);
}

TEST(GltfMaterial, VertexAlphaBlends) {
  const json see_through = {{"alphaMode", "BLEND"}, {"pbrMetallicRoughness", {{"metallicFactor", 0}}}};
  const Scene scene(read_gltf(coloured(see_through, 4)));
  int hits = 0;
  constexpr int rays = 4000;
  for (int i = 0; i < rays; ++i) {
    const float jitter = static_cast<float>(i) * 1e-6f;
    hits += scene.intersect({{0.25f + jitter, 0.25f, 1}, {0, 0, -1}}, Wavelengths::rgb(0.5f)).has_value() ? 1 : 0;
  }
  // 0.5 + 0.25 * 0.5, six standard deviations of a binomial distribution.
  EXPECT_NEAR(static_cast<double>(hits) / rays, 0.625, 6 * std::sqrt(0.625 * 0.375 / rays));
}

TEST(GltfMaterial, UnlitSurfacesEmitTheirColourAndAreNoLamps) {
  GltfWriter file = coloured({{"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 1, 1, 1}}}},
                              {"emissiveFactor", {9, 9, 9}},
                              {"extensions", {{"KHR_materials_unlit", json::object()}}}},
                             3);
  file.mesh({{0, 0, -1}, {1, 0, -1}, {0, 1, -1}}, {0, 1, 2});
  file.node({{"mesh", 1}});
  const SceneDescription scene = read_gltf(file);
  EXPECT_EQ(scene.lights.size(), 1u) << "the studio";
  EXPECT_TRUE(scene.area_lights.at(0).two_sided);
  EXPECT_TRUE(closure_of<Diffuse>(scene).reflectance.is_black());
  const Scene built(scene);
  const auto at = built.intersect({{0.25f, 0.25f, 1}, {0, 0, -1}}, Wavelengths::rgb(0.5f));
  const auto& light = std::get<lanthorn::AreaLight>(built.lights().at(at->light.value()));
  const Spectrum seen = light.emitted({at->position, at->normal, at->uv}, {0, 0, 1}, Wavelengths::rgb(0.5f));
  EXPECT_NEAR(seen[0], 0.25f, 1e-5f);
  EXPECT_NEAR(seen[1], 0.25f, 1e-5f);
}

TEST(GltfMaterial, TransmittedLightHasTheBaseColour) {
  const auto glass = [](double roughness, double thickness) {
    return json{{"pbrMetallicRoughness",
                 {{"metallicFactor", 0}, {"roughnessFactor", roughness}, {"baseColorFactor", {0.25, 1, 0.5, 1}}}},
                {"extensions",
                 {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                  {"KHR_materials_volume", {{"thicknessFactor", thickness}}}}}};
  };
  // For a volume, the tint applies to passing both interfaces; for a sheet, to passing the sheet.
  const auto solid = closure_of<Dielectric>(with_material(glass(0.5, 1)));
  EXPECT_NEAR(solid.tint[0], 0.5f, 1e-6f);
  EXPECT_NEAR(solid.tint[2], std::sqrt(0.5f), 1e-6f);
  EXPECT_FLOAT_EQ(solid.alpha_x, 0.25f);
  const auto sheet = closure_of<ThinDielectric>(with_material(glass(0.5, 0)));
  EXPECT_NEAR(sheet.tint[0], 0.25f, 1e-6f);
  EXPECT_FLOAT_EQ(sheet.alpha_y, 0.25f);
  // White is stored as a number, which is exact in spectral rendering as well.
  const auto clear = only_material<ThinDielectricMaterial>(
      {{"pbrMetallicRoughness", {{"metallicFactor", 0}}},
       {"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 1}}}}}});
  EXPECT_EQ(std::get<float>(clear.tint.value), 1);
}

TEST(GltfMaterial, DiffuseTransmissionIsMixedIn) {
  const SceneDescription leaf =
      with_material({{"pbrMetallicRoughness", {{"metallicFactor", 0}}},
                     {"extensions",
                      {{"KHR_materials_diffuse_transmission",
                        {{"diffuseTransmissionFactor", 0.25}, {"diffuseTransmissionColorFactor", {0, 1, 0}}}}}}});
  const auto& mix = std::get<MixMaterial>(leaf.materials.at(leaf.shapes[0].material).node);
  EXPECT_EQ(mix.amount.value, 0.25f);
  const auto& through = std::get<DiffuseTransmissionMaterial>(leaf.materials.at(mix.materials[1]).node);
  EXPECT_EQ(rgb(through.transmittance), (Rgb{0, 1, 0}));
  EXPECT_EQ(std::get<float>(through.reflectance.value), 0);
}

TEST(GltfMaterial, SheenIsClothOverTheDielectric) {
  const auto cloth = closure_of<Cloth>(with_material(
      {{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"baseColorFactor", {0.5, 0, 0, 1}}}},
       {"extensions", {{"KHR_materials_sheen", {{"sheenColorFactor", {0, 0.5, 1}}, {"sheenRoughnessFactor", 0.5}}}}}}));
  EXPECT_NEAR(cloth.base.reflectance[0], 0.5f, 1e-6f);
  EXPECT_NEAR(cloth.sheen[1], 0.5f, 1e-6f);
  EXPECT_FLOAT_EQ(cloth.alpha, 0.25f);
  const json none = {{"pbrMetallicRoughness", {{"metallicFactor", 0}}},
                     {"extensions", {{"KHR_materials_sheen", {{"sheenRoughnessFactor", 0.5}}}}}};
  closure_of<Plastic>(with_material(none));
}

TEST(GltfMaterial, IridescenceIsAFilm) {
  const json film = {{"iridescenceFactor", 1}, {"iridescenceIor", 1.8}, {"iridescenceThicknessMaximum", 300}};
  const auto with = [&](json material) {
    material["extensions"]["KHR_materials_iridescence"] = film;
    return with_material(material);
  };
  // A metal is described as a dielectric of its reflectance over black.
  const auto metal = closure_of<Plastic>(with({{"pbrMetallicRoughness", {{"baseColorFactor", {0.9, 0.5, 0.1, 1}}}}}));
  EXPECT_TRUE(metal.reflectance.is_black());
  EXPECT_NEAR(metal.f0[1], 0.5f, 1e-5f);
  EXPECT_EQ(metal.film.eta, 1.8f);
  EXPECT_EQ(metal.film.thickness, 300);
  const auto dull = closure_of<Plastic>(with({{"pbrMetallicRoughness", {{"metallicFactor", 0}}}}));
  EXPECT_EQ(dull.reflectance[0], 1);
  EXPECT_EQ(dull.film.thickness, 300);
  json glass = {{"pbrMetallicRoughness", {{"metallicFactor", 0}}},
                {"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 1}}}}}};
  EXPECT_EQ(closure_of<ThinDielectric>(with(glass)).film.eta, 1.8f);
  glass["extensions"]["KHR_materials_volume"] = {{"thicknessFactor", 1}};
  EXPECT_EQ(closure_of<Dielectric>(with(glass)).film.eta, 1.8f);
  for (const int metallic : {0, 1}) {
    const auto coated =
        closure_of<CoatedPlastic>(with({{"pbrMetallicRoughness", {{"metallicFactor", metallic}}},
                                        {"extensions", {{"KHR_materials_clearcoat", {{"clearcoatFactor", 1}}}}}}));
    EXPECT_EQ(coated.base.film.thickness, 300);
    EXPECT_EQ(coated.base.reflectance.is_black(), metallic == 1);
  }
}

TEST(GltfMaterial, IridescenceVaries) {
  GltfWriter file;
  file.add("images", {{"uri", "a.png"}});
  file.add("textures", {{"source", 0}});
  const SceneDescription scene =
      with_material({{"pbrMetallicRoughness", {{"metallicFactor", 0}}},
                     {"extensions",
                      {{"KHR_materials_iridescence",
                        {{"iridescenceFactor", 0.25}, {"iridescenceThicknessTexture", {{"index", 0}}}}}}}},
                    file);
  const auto& mix = std::get<MixMaterial>(scene.materials.at(scene.shapes[0].material).node);
  EXPECT_EQ(mix.amount.value, 0.25f);
  EXPECT_FALSE(std::get<PlasticMaterial>(scene.materials.at(mix.materials[0]).node).film);
  const auto& film = std::get<PlasticMaterial>(scene.materials.at(mix.materials[1]).node).film;
  const auto& thickness = std::get<MixTexture<FloatParameter>>(scene.float_textures.at(*film->thickness.texture).node);
  EXPECT_EQ(thickness.tex1.value, 100);
  EXPECT_EQ(thickness.tex2.value, 400);
  EXPECT_EQ(std::get<ImageTexture>(scene.float_textures.at(*thickness.amount.texture).node).channel, 1);
}

TEST(GltfMaterial, AnisotropyStretchesAndTurns) {
  GltfWriter file;
  file.mesh(corners, {0, 1, 2},
            file.add("materials", {{"pbrMetallicRoughness", {{"roughnessFactor", 0.5}}},
                                   {"extensions",
                                    {{"KHR_materials_anisotropy",
                                      {{"anisotropyStrength", 0.5}, {"anisotropyRotation", std::acos(0.0)}}}}}}));
  json& attributes = file.root["meshes"][0]["primitives"][0]["attributes"];
  attributes["NORMAL"] = file.accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, 3);
  attributes["TEXCOORD_0"] = file.accessor<float>({0, 1, 1, 1, 0, 0}, 2);
  file.node({{"mesh", 0}});
  const auto turned_to = [&] {
    const Scene scene(read_gltf(file));
    const auto at = scene.intersect({{0.25f, 0.25f, 1}, {0, 0, -1}}, Wavelengths::rgb(0.5f));
    const Conductor metal = std::get<Conductor>(at.value().bsdf.get());
    EXPECT_NEAR(metal.alpha_x, lerp(0.25f, 0.25f, 1.0f), 1e-6f);  // the strength squared
    EXPECT_FLOAT_EQ(metal.alpha_y, 0.25f);
    return at->shading.s;
  };
  EXPECT_NEAR(turned_to().y, 1, 1e-5f);  // u runs along x; a quarter turn counter-clockwise leads to y
  file.root["meshes"][0]["primitives"][0]["attributes"]["TANGENT"] =
      file.accessor<float>({0, 1, 0, -1, 0, 1, 0, -1, 0, 1, 0, -1}, 4);
  EXPECT_NEAR(turned_to().x, 1, 1e-5f);  // with w = -1, in the opposite sense, from y
}

// The mask compares the product of the factor's, the texture's and the vertices' alpha with the cutoff.
TEST(GltfMaterial, AlphaOfVerticesCountsWithMasks) {
  const auto is_hit = [](float factor, float of_vertices, const char* mode) {
    GltfWriter file;
    file.mesh(corners, {0, 1, 2},
              file.add("materials", {{"alphaMode", mode},
                                     {"alphaCutoff", 0.5},
                                     {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, factor}}}}}));
    json& attributes = file.root["meshes"][0]["primitives"][0]["attributes"];
    const float a = of_vertices;
    attributes["COLOR_0"] = file.accessor<float>({1, 1, 1, a, 1, 1, 1, a, 1, 1, 1, a}, 4);
    file.node({{"mesh", 0}});
    return Scene(read_gltf(file)).intersect({{0.25f, 0.25f, 1}, {0, 0, -1}}, Wavelengths::rgb(0.5f)).has_value();
  };
  EXPECT_TRUE(is_hit(1, 0.6f, "MASK"));
  EXPECT_FALSE(is_hit(1, 0.4f, "MASK"));
  EXPECT_FALSE(is_hit(0.8f, 0.6f, "MASK"));
  EXPECT_FALSE(is_hit(1, 0, "MASK"));
  EXPECT_FALSE(is_hit(1, 0, "BLEND"));
  EXPECT_TRUE(is_hit(1, 0, "OPAQUE"));
}

TEST(GltfMaterial, BothAxesOfATextureWrapAsTheyAre) {
  GltfWriter file;
  file.add("images", {{"uri", "a.png"}});
  file.add("samplers", {{"wrapS", 33071}, {"wrapT", 10497}});
  file.add("textures", {{"source", 0}, {"sampler", 0}});
  const SceneDescription scene =
      with_material({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}, file);
  const auto& image = std::get<ImageTexture>(scene.spectrum_textures.at(0).node);
  EXPECT_EQ(image.wrap, Wrap::clamp);
  EXPECT_EQ(image.wrap_t, Wrap::repeat);
}

TEST(GltfMaterial, BasisTexturesAreNamedAndHaveFallbacks) {
  const auto with = [](json texture) {
    GltfWriter file;
    file.add("images", {{"uri", "bark.ktx2"}});
    file.add("images", {{"uri", "bark.png"}});
    file.add("textures", std::move(texture));
    file.root["extensionsUsed"] = {"KHR_texture_basisu"};
    file.root["extensionsRequired"] = {"KHR_texture_basisu"};
    return with_material({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}, file);
  };
  const json basis = {{"extensions", {{"KHR_texture_basisu", {{"source", 0}}}}}};
  for (const json& texture : {basis, json{{"source", 0}}}) {
    const SceneDescription none = with(texture);
    EXPECT_TRUE(none.spectrum_textures.empty());
    EXPECT_EQ(
        warnings(none).at(0),
        R"(t.gltf#/textures/0: KHR_texture_basisu: KTX2 images such as "bark.ktx2" are not supported: neutral values )"
        R"(replace textures without another image. Convert the file with "gltf-transform ktxdecompress IN OUT" )"
        "(of npm's "
        "@gltf-transform/cli and Khronos' KTX-Software)");
  }
  json both = basis;
  both["source"] = 1;
  const SceneDescription other = with(both);
  EXPECT_EQ(std::get<ImageTexture>(other.spectrum_textures.at(0).node).filename, "bark.png");
  EXPECT_EQ(warnings(other).size(), 1u);  // of the stand-ins
}

// Materials as Blender writes them for a Glass BSDF, and for a Principled BSDF with Transmission and an index.
TEST(GltfMaterial, GlassThatAnExporterLost) {
  const auto messages = [](const json& material) {
    GltfWriter file;
    file.mesh(corners, {0, 1, 2}, file.add("materials", material));
    file.node({{"mesh", 0}});
    std::vector<std::string> all = warnings(read_gltf(file));
    std::erase_if(all, [](const std::string& text) { return text.find(R"(material "gem")") == text.npos; });
    return all;
  };
  const auto glass = [](const json& extensions) {
    return json{{"name", "gem"}, {"pbrMetallicRoughness", {{"metallicFactor", 0}}}, {"extensions", extensions}};
  };
  const json clear = {{"transmissionFactor", 1}}, diamond = {{"ior", 2.417}};
  const auto lost = messages({{"name", "gem"}, {"doubleSided", true}, {"pbrMetallicRoughness", json::object()}});
  ASSERT_EQ(lost.size(), 1u);
  EXPECT_NE(lost[0].find("rough white metal"), std::string::npos);
  const auto sheet = messages(glass({{"KHR_materials_transmission", clear}, {"KHR_materials_ior", diamond}}));
  ASSERT_EQ(sheet.size(), 1u);
  EXPECT_NE(sheet[0].find("thin sheet"), std::string::npos);
  EXPECT_TRUE(messages(glass({{"KHR_materials_transmission", clear}})).empty());  // a pane
  EXPECT_TRUE(messages(glass({{"KHR_materials_transmission", clear},
                              {"KHR_materials_ior", diamond},
                              {"KHR_materials_volume", {{"thicknessFactor", 1}}}}))
                  .empty());
  EXPECT_TRUE(
      messages({{"name", "gem"}, {"emissiveFactor", {1, 1, 1}}, {"pbrMetallicRoughness", json::object()}}).empty());
}

TEST(GltfMaterial, ApproximationsAreSaidOnce) {
  GltfWriter file;
  for (int i = 0; i < 2; ++i)
    file.mesh(corners, {0, 1, 2},
              file.add("materials", {{"extensions",
                                      {{"KHR_materials_sheen", json::object()},
                                       {"KHR_materials_clearcoat", {{"clearcoatFactor", 0.5}}}}}}));
  file.node({{"mesh", 0}});
  file.node({{"mesh", 1}});
  file.root["extensionsUsed"] = {"KHR_materials_sheen", "VENDOR_thing"};
  EXPECT_EQ(
      warnings(read_gltf(file)),
      (std::vector<std::string>{
          R"(t.gltf#/extensionsUsed/1: extension "VENDOR_thing" is not supported: ignored)",
          "t.gltf#/materials/0/extensions/KHR_materials_clearcoat: KHR_materials_sheen is ignored under a clear coat "
          "(and 1 more like it)",
          "t.gltf: the file has no camera and no light: a view of all of it from the front, in a studio of three soft "
          "lamps, stands in"}));
}

}  // namespace
}  // namespace lanthorn::gltf_material_test
