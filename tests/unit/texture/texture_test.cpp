// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Textures without a surface: mappings are tested against points computed by hand, procedural textures against their
// definitions, and images at their borders and while being read.
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "math/noise.h"
#include "support/error_text.h"
#include "support/exr_colours.h"
#include "support/scene_text.h"
#include "support/temporary_dir.h"

namespace lanthorn::texture_test {
namespace {

// The textures of a scene text, in order of definition.
struct Textures {
  SceneDescription description;
  SpectrumStore spectra;
  TextureGraph graph;

  explicit Textures(const std::string& text, const std::filesystem::path& folder = ".")
      : description(read_pbrt_string("WorldBegin\n" + text, folder, "t.pbrt")), graph(description, spectra) {
    for (std::uint32_t i = 0; i < description.float_textures.size(); ++i)
      graph.compile(description::FloatParameter{0, i});
    for (std::uint32_t i = 0; i < description.spectrum_textures.size(); ++i) input(i);
    graph.load_images();
  }
  SpectrumInput input(std::uint32_t index) {
    return graph.compile({1.0f, index}, description::SpectrumRole::unbounded, SourceLocation{});
  }
  float value(const TexturePoint& at, std::uint32_t index = 0) {
    return graph.evaluate(graph.compile(description::FloatParameter{0, index}), at);
  }
  float value(const Point& at) { return value(TexturePoint{at, {0, 0, 1}, {0, 0}}); }
  float value(const Vec2& uv) { return value(TexturePoint{Point(0), {0, 0, 1}, uv}); }
  Rgb colour(const TexturePoint& at, std::uint32_t index = 0) {
    const Spectrum s = graph.evaluate(input(index), at, test::white);
    return {s[0], s[1], s[2]};
  }
};

std::string texture(const std::string& kind, const std::string& parameters, const std::string& type = "float") {
  return "Texture \"" + type + kind + R"(" ")" + type + R"(" ")" + kind + "\" " + parameters + "\n";
}

Point random_point(HashRng& rng, float size) {
  const float x = rng.next(), y = rng.next(), z = rng.next();
  return size * (2.0f * Vec3(x, y, z) - 1.0f);
}

// s and t of a mapping, by bilinear textures that return them.
Vec2 mapped(const std::string& mapping, const TexturePoint& at, const std::string& before = "") {
  Textures textures(before + R"(Texture "s" "float" "bilerp" "float v01" 0 "float v10" 1 "string mapping" )" + mapping +
                    R"(
Texture "t" "float" "bilerp" "string mapping" )" +
                    mapping);
  return {textures.value(at, 0), textures.value(at, 1)};
}

void expect_near(const Vec2& got, const Vec2& expected) {
  EXPECT_NEAR(got.x, expected.x, 2e-6f);
  EXPECT_NEAR(got.y, expected.y, 2e-6f);
}

TexturePoint at_point(const Point& p) { return {p, {0, 0, 1}, {0.1f, 0.2f}}; }

TEST(TextureMappings, Uv) {
  expect_near(mapped(R"("uv")", at_point({7, 8, 9})), {0.1f, 0.2f});
  expect_near(
      mapped(R"("uv" "float uscale" 3 "float vscale" -1 "float udelta" .5 "float vdelta" 2)", at_point({7, 8, 9})),
      {0.8f, 1.8f});
}

TEST(TextureMappings, Spherical) {
  expect_near(mapped(R"("spherical")", at_point({0, 0, 4})), {0, 0});
  expect_near(mapped(R"("spherical")", at_point({0, 0, -4})), {1, 0});
  expect_near(mapped(R"("spherical")", at_point({3, 0, 0})), {0.5f, 0});
  expect_near(mapped(R"("spherical")", at_point({0, 3, 0})), {0.5f, 0.25f});
  expect_near(mapped(R"("spherical")", at_point({-3, 0, 3})), {0.25f, 0.5f});
  expect_near(mapped(R"("spherical")", at_point({0, -3, -3})), {0.75f, 0.75f});
  // The CTM at the texture's definition defines texture space.
  expect_near(mapped(R"("spherical")", at_point({5, 6, 4}), "Translate 5 6 1 Rotate 90 0 1 0\n"), {0.5f, 0.5f});
}

TEST(TextureMappings, Cylindrical) {
  expect_near(mapped(R"("cylindrical")", at_point({2, 0, -1.5f})), {0.5f, -1.5f});
  expect_near(mapped(R"("cylindrical")", at_point({0, 2, 7})), {0.75f, 7});
  expect_near(mapped(R"("cylindrical")", at_point({0, -2, 0})), {0.25f, 0});
  expect_near(mapped(R"("cylindrical")", at_point({-1, 1, 0})), {0.875f, 0});
  expect_near(mapped(R"("cylindrical")", at_point({4, 0, 3}), "Translate 2 0 1 Scale 1 1 4\n"), {0.5f, 0.5f});
}

TEST(TextureMappings, Planar) {
  expect_near(mapped(R"("planar")", at_point({0.3f, 0.4f, 9})), {0.3f, 0.4f});
  expect_near(mapped(R"("planar" "vector3 v1" [0 0 2] "vector3 v2" [1 1 0] "float udelta" 1 "float vdelta" -2)",
                     at_point({0.3f, 0.4f, 0.5f})),
              {2, -1.3f});
  expect_near(mapped(R"("planar")", at_point({0, 5, 0}), "Rotate 90 0 0 1 Scale 2 2 2\n"), {2.5f, 0});
}

TEST(ProceduralTextures, BilerpInterpolatesAndExtrapolates) {
  Textures t(texture("bilerp", R"("float v00" 1 "float v10" 2 "float v01" 5 "float v11" 10)"));
  EXPECT_FLOAT_EQ(t.value(Vec2(0, 0)), 1);
  EXPECT_FLOAT_EQ(t.value(Vec2(1, 0)), 2);
  EXPECT_FLOAT_EQ(t.value(Vec2(0, 1)), 5);
  EXPECT_FLOAT_EQ(t.value(Vec2(1, 1)), 10);
  EXPECT_FLOAT_EQ(t.value(Vec2(0.25f, 0.5f)), 0.5f * (1.25f + 6.25f));
  EXPECT_FLOAT_EQ(t.value(Vec2(2, 0)), 3);
  Textures s(
      texture("bilerp", R"("rgb v00" [1 0 0] "rgb v10" [0 1 0] "rgb v01" [0 0 1] "rgb v11" [0 0 0])", "spectrum"));
  const Rgb c = s.colour({Point(0), {0, 0, 1}, {0.25f, 0.5f}});
  EXPECT_NEAR(c.r, 0.375f, 1e-6f);
  EXPECT_NEAR(c.g, 0.125f, 1e-6f);
  EXPECT_NEAR(c.b, 0.375f, 1e-6f);
}

TEST(ProceduralTextures, DirectionMixFollowsTheGeometricNormal) {
  Textures t("Rotate 90 1 0 0\n" + texture("directionmix", R"("float tex1" 2 "float tex2" 6 "vector3 dir" [0 3 0])"));
  const auto value = [&](const Normal& n) { return t.value(TexturePoint{Point(0), n, Vec2(0)}); };
  EXPECT_NEAR(value({0, 0, 1}), 2, 1e-5f);  // y in texture space
  EXPECT_NEAR(value({0, 0, -1}), 2, 1e-5f);
  EXPECT_NEAR(value({1, 0, 0}), 6, 1e-5f);
  EXPECT_NEAR(value({0.8f, 0, 0.6f}), 0.6f * 2 + 0.4f * 6, 1e-5f);
}

// In pbrt, the dots take the value "outside".
TEST(ProceduralTextures, DotsLieInTheCellsThatNoiseChooses) {
  Textures t(texture("dots", R"("float outside" 1 "float inside" 0)"));
  constexpr int cells = 40, steps = 30;
  int with_dot = 0;
  for (int i = 0; i < cells * cells; ++i) {
    const Vec2 cell(static_cast<float>(i % cells - 20), static_cast<float>(i / cells - 20));
    int inside = 0;
    Vec2 low(infinity), high(-infinity);
    for (int k = 0; k < steps * steps; ++k) {
      const Vec2 st = cell - 0.5f + (Vec2(k % steps, k / steps) + 0.5f) / static_cast<float>(steps);
      if (t.value(st) == 0) continue;
      ++inside;
      low = min(low, st);
      high = max(high, st);
    }
    EXPECT_EQ(inside > 0, perlin_noise({cell + 0.5f, 0.5f}) > 0);
    if (inside == 0) continue;
    ++with_dot;
    // A complete disk, inside its cell.
    EXPECT_NEAR(static_cast<double>(inside) / (steps * steps), 3.14159 * 0.35 * 0.35, 0.02);
    EXPECT_NEAR(high.x - low.x, 0.7f, 0.08f);
    EXPECT_NEAR(high.y - low.y, 0.7f, 0.08f);
  }
  EXPECT_GT(with_dot, cells * cells / 4);
}

TEST(ProceduralTextures, NoiseLivesInTextureSpace) {
  const std::string space = "Translate 1 2 3 Scale 2 2 2\n";
  Textures wrinkled(space + texture("wrinkled", R"("integer octaves" 5 "float roughness" .4)"));
  Textures brownian(space + texture("fbm", ""));
  Textures windy(space + texture("windy", ""));
  HashRng rng(5);
  for (int i = 0; i < 50; ++i) {
    const Point p = random_point(rng, 8);
    const Point q = (p - Vec3(1, 2, 3)) * 0.5f;
    EXPECT_NEAR(wrinkled.value(p), turbulence(q, 0.4f, 5), 1e-4f);
    EXPECT_NEAR(brownian.value(p), fbm(q, 0.5f, 8), 1e-3f);
    EXPECT_NEAR(windy.value(p), std::fabs(fbm(0.1f * q, 0.5f, 3)) * fbm(q, 0.5f, 6), 1e-4f);
  }
}

TEST(ProceduralTextures, MarbleIsASplineThroughVeins) {
  Textures plain(texture("marble", R"("float variation" 0)", "spectrum"));
  const auto at_phase = [&](float t) { return plain.colour(at_point({3, std::asin(2 * t - 1), 5})); };
  const auto expect_rgb = [](const Rgb& got, double r, double g, double b) {
    EXPECT_NEAR(got.r, r, 2e-5);
    EXPECT_NEAR(got.g, g, 2e-5);
    EXPECT_NEAR(got.b, b, 2e-5);
  };
  expect_rgb(at_phase(0), 0.87, 0.87, 0.9);
  expect_rgb(at_phase(1), 0.87, 0.87, 0.9);
  // At the midpoint of the last of six segments, weighted by (1 3 3 1) / 8.
  const float middle = 11.0f / 12;
  expect_rgb(at_phase(middle), 1.5 * (0.58 + 3 * 0.58 + 3 * 0.2 + 0.58) / 8, 1.5 * (5 * 0.58 + 3 * 0.2) / 8,
             1.5 * (5 * 0.6 + 3 * 0.33) / 8);
  Textures veined(texture("marble", R"("float variation" .7 "float scale" 2 "integer octaves" 3)", "spectrum"));
  HashRng rng(6);
  for (int i = 0; i < 50; ++i) {
    const Point p = random_point(rng, 4);
    const float phase = 2 * p.y + 0.7f * fbm(2.0f * p, 0.5f, 3);
    const Rgb expected = plain.colour(at_point({0, phase, 0})), got = veined.colour(at_point(p));
    expect_rgb(got, expected.r, expected.g, expected.b);
    EXPECT_LE(got.b, 0.91f);
  }
}

TEST(ProceduralTextures, Nest) {
  Textures t(
      R"(Texture "a" "float" "fbm"
Texture "b" "float" "bilerp"
Texture "c" "float" "dots" "texture outside" "a" "texture inside" "b"
Texture "d" "float" "checkerboard" "string mapping" "planar" "texture tex1" "c" "float tex2" 9
Texture "e" "float" "mix" "texture tex1" "d" "texture tex2" "b" "texture amount" "b"
)");
  HashRng rng(7);
  for (int i = 0; i < 50; ++i) {
    TexturePoint at = at_point(random_point(rng, 3));
    at.uv = {rng.next(), rng.next()};
    const bool second = (static_cast<int>(std::floor(at.position.x)) + static_cast<int>(std::floor(at.position.y))) & 1;
    const float c = t.value(at, 2);
    EXPECT_TRUE(c == t.value(at, 0) || c == t.value(at, 1));
    const float d = second ? 9 : c;
    EXPECT_NEAR(t.value(at, 4), (1 - at.uv.y) * d + at.uv.y * at.uv.y, 1e-4f);
  }
}

// Each ball of the scene shows more than one colour, and no texture is replaced.
TEST(ProceduralTextures, OfTheTestSceneVary) {
  const Scene scene(read_scene(LANTHORN_SOURCE_DIR "/tests/scenes/textures.pbrt"));
  EXPECT_TRUE(scene.warnings().empty());
  for (const float x : {-4.0f, -2.0f, 0.0f, 2.0f, 4.0f}) {
    Spectrum low(infinity), high(0);
    for (int i = 0; i < 400; ++i) {
      const auto at = test::look(
          scene, {x, 1, 5}, {0.011f * static_cast<float>(i % 20 - 10), 0.011f * static_cast<float>(i / 20 - 10), -1});
      ASSERT_TRUE(at);
      const auto* coated = std::get_if<ClearCoated>(&at->bsdf.get());
      const Spectrum r = coated != nullptr ? coated->reflectance : std::get<Diffuse>(at->bsdf.get()).reflectance;
      for (unsigned c = 0; c < 3; ++c) {
        low[c] = std::fmin(low[c], r[c]);
        high[c] = std::fmax(high[c], r[c]);
      }
    }
    EXPECT_GT(high[0] - low[0], 0.15f) << "ball at " << x;
    EXPECT_LE(max_component(Vec3(high[0], high[1], high[2])), 1);
  }
}

class ImageTextures : public ::testing::Test {
 protected:
  std::string write(const std::string& name, int width, int height, int channels, const std::vector<float>& texels) {
    const std::string path = (folder.path() / name).string();
    const auto output = OIIO::ImageOutput::create(path);
    EXPECT_TRUE(output->open(path, OIIO::ImageSpec(width, height, channels, OIIO::TypeDesc::FLOAT)));
    EXPECT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, texels.data()));
    EXPECT_TRUE(output->close());
    return path;
  }
  test::TemporaryDir folder;
};

// Clamped along s and mirrored along t. The texels are 0 1 above 2 3.
TEST_F(ImageTextures, AxesWrapByThemselves) {
  const std::string path = write("w.exr", 2, 2, 1, {0, 1, 2, 3});
  const TextureImage image(path, FileAccess{}, {{description::Encoding::linear, 1, ColorSpace::srgb}}, {});
  const auto at = [&](float s, float t) {
    return image.scalar({s, t}, {description::Wrap::clamp, description::Wrap::mirror}, description::ImageFilter::point);
  };
  EXPECT_EQ(at(0.25f, 0.75f), 0);
  EXPECT_EQ(at(1.25f, 0.75f), 1);  // 0 if it were repeated
  EXPECT_EQ(at(-0.25f, 0.25f), 2);
  EXPECT_EQ(at(0.25f, 1.25f), 0);  // 2 if it were not mirrored
  EXPECT_EQ(at(0.25f, -0.75f), 0);
}

// Of the same file, a spectrum texture reads colours, while a float texture and a normal map read numbers.
TEST_F(ImageTextures, ColoursAreConvertedAndNumbersAreNot) {
  const Image image = test::colour_of_one_pixel(0.5f, 0.2f, 0.1f);
  folder.write("c.exr", test::exr_of(image, test::acescg));
  const std::string file = R"("string filename" "c.exr")", inverted = file + R"( "bool invert" true)";
  Textures t(texture("imagemap", file, "spectrum") + texture("imagemap", file) +
                 R"(Texture "inverted" "spectrum" "imagemap" )" + inverted + "\n",
             folder.path());
  const TexturePoint at = at_point({0, 0, 0});
  const Rgb c = t.colour(at), inverse = t.colour(at, 1);
  constexpr Rgb expected{0.71984f, 0.16198f, 0.07750f};  // the Academy's matrix
  EXPECT_NEAR(c.r, expected.r, 2e-5f);
  EXPECT_NEAR(c.g, expected.g, 2e-5f);
  EXPECT_NEAR(c.b, expected.b, 2e-5f);
  EXPECT_NEAR(inverse.r, 1 - expected.r, 2e-5f);
  EXPECT_NEAR(t.value(at), 0.8f / 3, 1e-6f);
  description::NormalMap map;
  map.image.filename = (folder.path() / "c.exr").string();
  const NormalMapInput normals = t.graph.compile(map, {});
  t.graph.load_images();
  const Vec3 stored(2 * 0.5f - 1, 2 * 0.2f - 1, 2 * 0.1f - 1);
  EXPECT_LT(length(Vec3(TextureGraph::evaluate(normals, at)) - normalize(stored)), 1e-5f);
  // In tiles, the texels are the same. The space of the description is that of files without a statement.
  const ImageWish wish{{description::Encoding::automatic, 1, ColorSpace::rec2020}};
  const std::string path = (folder.path() / "c.exr").string();
  const TextureImage cached(path, FileAccess{}, wish, {}, std::make_shared<TextureCache>(std::uint64_t{1} << 20));
  const Rgb tile = cached.colour(cached.texel(0, 0));
  EXPECT_NEAR(tile.r, expected.r, 2e-5f);
  EXPECT_NEAR(tile.b, expected.b, 2e-5f);
}

// Whatever a texture is used for, in memory as in tiles.
TEST_F(ImageTextures, ValuesThatAreNotFiniteAreRefused) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  const auto cache = std::make_shared<TextureCache>(std::uint64_t{1} << 20);
  for (const char* name : {"a.exr", "a.tif"})
    for (const float bad : {std::nanf(""), infinity, -infinity}) {
      const std::string path = write(name, 2, 2, 3, {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, bad, 1});
      const std::string message = "image \"" + path + "\" cannot be used: its pixel (1, 1) is infinite or not a number";
      EXPECT_EQ(test::error_text([&] {
                  TextureImage(path, FileAccess{}, ImageWish{}, {"s.pbrt", 3, 4});
                }),
                "s.pbrt:3:4: " + message);
      EXPECT_EQ(test::error_text([&] { TextureImage(path, FileAccess{}, ImageWish{}, {}, cache); }), message);
    }
  // A depth beside the colours is no alpha, and may be infinite.
  Image with_depth(1, 1, {"R", "G", "B", "Z"});
  with_depth.pixels = {0.5f, 0.2f, 0.1f, infinity};
  const TextureImage seen(folder.write("z.exr", test::exr_of(with_depth, test::acescg)).string(), FileAccess{},
                          ImageWish{}, {});
  EXPECT_FALSE(seen.has_alpha());
  EXPECT_NEAR(seen.scalar({0.5f, 0.5f}, description::Wrap::repeat, description::ImageFilter::point), 0.8f / 3, 1e-6f);
  // A number that a wide gamut carries beyond the largest float.
  Image image = test::colour_of_one_pixel(3e38f, 0, 0);
  const std::string wide = folder.write("wide.exr", test::exr_of(image, test::acescg)).string();
  EXPECT_NE(test::error_text([&] { TextureImage(wide, FileAccess{}, ImageWish{}, {}); }).find("pixel (0, 0)"),
            std::string::npos);
}

// Beyond an edge, lookups return texels of the same edge, mirrored about its midpoint.
TEST_F(ImageTextures, OctahedralSphereFoldsAtItsEdges) {
  std::vector<float> texels(16);
  for (std::size_t i = 0; i < 16; ++i) texels[i] = static_cast<float>(i);
  write("o.exr", 4, 4, 1, texels);
  Textures t(
      texture("imagemap", R"("string filename" "o.exr" "string wrap" "octahedralsphere" "string filter" "point")"),
      folder.path());
  const auto at_texel = [&](int column, int row) {
    return static_cast<int>(
        t.value(Vec2((static_cast<float>(column) + 0.5f) / 4, 1 - (static_cast<float>(row) + 0.5f) / 4)));
  };
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(at_texel(i, 2), 8 + i);
    EXPECT_EQ(at_texel(-1, i), 4 * (3 - i));
    EXPECT_EQ(at_texel(4, i), 4 * (3 - i) + 3);
    EXPECT_EQ(at_texel(i, -1), 3 - i);
    EXPECT_EQ(at_texel(i, 4), 12 + 3 - i);
    EXPECT_EQ(at_texel(i + 8, 1), at_texel(i, 1));  // the period is two squares
    EXPECT_EQ(at_texel(i, 2 - 8), at_texel(i, 2));
  }
  EXPECT_EQ(at_texel(-1, -1), 15);
}

// Textures t0 to t<last>, each of which refers to the previous one once (chain) or twice (doubling). Line i + 2 defines
// texture i.
std::string chain(const std::string& kind, const std::string& inputs, int last, const std::string& type) {
  std::string text = R"(Texture "t0" ")" + type + R"(" "bilerp"
)";
  for (int i = 1; i <= last; ++i) {
    text += "Texture \"t" + std::to_string(i) + R"(" ")" + type + R"(" ")" + kind + "\"";
    for (std::size_t at = 0; at < inputs.size();) {
      const std::size_t end = std::min(inputs.find(' ', at), inputs.size());
      text += " \"texture " + inputs.substr(at, end - at) + R"(" "t)" + std::to_string(i - 1) + "\"";
      at = end + 1;
    }
    text += "\n";
  }
  return text;
}

// Compiles the last texture, which compiles all earlier ones.
std::string error_of_last(const std::string& text) {
  const SceneDescription description = read_pbrt_string("WorldBegin\n" + text, ".", "t.pbrt");
  SpectrumStore spectra;
  TextureGraph graph(description, spectra);
  return test::error_text([&] {
    if (!description.float_textures.empty())
      graph.compile(description::FloatParameter{0, static_cast<std::uint32_t>(description.float_textures.size() - 1)});
    else
      graph.compile({1.0f, static_cast<std::uint32_t>(description.spectrum_textures.size() - 1)},
                    description::SpectrumRole::unbounded, SourceLocation{});
  });
}

struct Chain {
  std::string kind, once, twice;
};
const std::vector<Chain> chains = {{"scale", "tex", ""},
                                   {"mix", "tex1", "tex1 tex2"},
                                   {"checkerboard", "tex2", "tex1 tex2"},
                                   {"directionmix", "tex1", "tex1 tex2"},
                                   {"bilerp", "v01", "v00 v11"},
                                   {"dots", "inside", "inside outside"}};

TEST(TextureGraph, RefusesDeepChains) {
  for (const std::string type : {"float", "spectrum"})
    for (const Chain& c : chains) {
      Textures deepest(chain(c.kind, c.once, 255, type));
      if (type == "float") {
        EXPECT_TRUE(std::isfinite(deepest.value(at_point(Point(0)), 255)));
        EXPECT_EQ(deepest.graph.detail(deepest.graph.compile(description::FloatParameter{0, 255})).metres, infinity)
            << c.kind;
      } else {
        EXPECT_TRUE(std::isfinite(deepest.colour(at_point(Point(0)), 255).r));
      }
      const std::string message = ": textures are nested more than 256 deep";
      EXPECT_EQ(test::error_text([&] { Textures deep(chain(c.kind, c.once, 10'000, type)); }),
                "t.pbrt:258:1" + message);
      EXPECT_EQ(error_of_last(chain(c.kind, c.once, 10'000, type)), "t.pbrt:9746:1" + message);
    }
}

TEST(TextureGraph, RefusesDoublingChains) {
  const std::string message =
      ":1: a value of this texture takes more than 1000 lookups: a texture counts once for each reference to it";
  for (const std::string type : {"float", "spectrum"})
    for (const Chain& c : chains) {
      if (c.twice.empty()) continue;
      EXPECT_EQ(error_of_last(chain(c.kind, c.twice, 8, type)), "no error") << c.kind;
      EXPECT_EQ(error_of_last(chain(c.kind, c.twice, 60, type)), "t.pbrt:11" + message) << c.kind;
    }
  EXPECT_EQ(error_of_last(chain("scale", "tex scale", 60, "float")), "t.pbrt:11" + message);
  // Each octave of noise counts.
  std::string noise = chain("mix", "tex1 tex2", 8, "float");
  EXPECT_EQ(error_of_last(noise), "no error");
  noise.replace(noise.find(R"("bilerp")"), 8, R"("fbm" "integer octaves" 24)");
  EXPECT_EQ(error_of_last(noise), "t.pbrt:8" + message);
}

TEST(TextureGraph, RefusesTexturesThatNameThemselves) {
  SceneDescription description;
  description::FloatTexture& texture = description.float_textures.emplace_back();
  texture.node = description::ScaleTexture<description::FloatParameter>{{1, 0}, {2, {}}};
  SpectrumStore spectra;
  TextureGraph graph(description, spectra);
  EXPECT_NE(test::error_text([&] {
              graph.compile(description::FloatParameter{0, 0});
            }).find("256 deep"),
            std::string::npos);
}

TEST_F(ImageTextures, OfUnusedMaterialsAreNotRead) {
  const std::string missing =
      R"(Texture "t" "spectrum" "imagemap" "string filename" "missing.png"
MakeNamedMaterial "a" "string type" "diffuse" "texture reflectance" "t"
MakeNamedMaterial "b" "string type" "diffuse"
MakeNamedMaterial "ab" "string type" "mix" "string materials" ["a" "b"]
)";
  EXPECT_NO_THROW(test::world(missing + R"(NamedMaterial "b" Shape "sphere")"));
  EXPECT_THROW(test::world(missing + R"(NamedMaterial "a" Shape "sphere")"), Error);
  EXPECT_THROW(test::world(missing + R"(NamedMaterial "ab" Shape "sphere")"), Error);
  EXPECT_THROW(test::world(missing + R"(ObjectBegin "o" NamedMaterial "a" Shape "sphere" ObjectEnd)"), Error);
}

TEST_F(ImageTextures, AreReadOnceEachAndTheFirstProblemIsTold) {
  write("one.exr", 1, 1, 1, {0.25f});
  write("two.exr", 1, 1, 1, {0.75f});
  std::string text;
  for (int i = 0; i < 20; ++i)
    text += "Texture \"t" + std::to_string(i) + R"(" "float" "imagemap" "string filename" ")" +
            (i % 2 == 0 ? "one.exr\"\n" : "two.exr\"\n");
  Textures t(text, folder.path());
  EXPECT_EQ(t.graph.image_count(), 2u);
  EXPECT_EQ(t.graph.bytes(), 8u);
  EXPECT_FLOAT_EQ(t.value(at_point(Point(0)), 6), 0.25f);
  EXPECT_FLOAT_EQ(t.value(at_point(Point(0)), 7), 0.75f);
  for (int i = 0; i < 8; ++i)
    text += "Texture \"m" + std::to_string(i) + R"(" "float" "imagemap" "string filename" "missing)" +
            std::to_string(i) + ".exr\"\n";
  for (int run = 0; run < 5; ++run) {
    const std::string error = test::error_text([&] { Textures broken(text, folder.path()); });
    EXPECT_NE(error.find("t.pbrt:22:1: cannot read image"), std::string::npos) << error;
    EXPECT_NE(error.find("missing0.exr"), std::string::npos) << error;
  }
}

}  // namespace
}  // namespace lanthorn::texture_test
