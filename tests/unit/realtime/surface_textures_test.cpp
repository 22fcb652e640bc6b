// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Effects of textures on surfaces drawn by the GPU: colours, lobes, normals, emission, opacity.
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "lanthorn/metrics.h"
#include "realtime/frame/renderer.h"
#include "realtime/techniques/voxelcones/voxels.h"
#include "support/edited.h"
#include "support/opengl.h"
#include "support/render_scene.h"
#include "support/temporary_dir.h"

namespace lanthorn::surface_textures_test {
namespace {

class SurfaceTexturesTest : public test::OpenGl {};

// A square of side 2 in front of the wall. u runs along x or against it, v along y or against it.
std::string square(float x, float y, const std::string& options = "", bool is_mirrored = false) {
  const auto at = [&](float dx, float dy) { return std::to_string(x + dx) + " " + std::to_string(y + dy) + " 0  "; };
  return R"(Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [)" + at(-1, -1) + at(1, -1) + at(1, 1) +
         at(-1, 1) + R"(] "point2 uv" [)" + (is_mirrored ? "0 1 1 1 1 0 0 0" : "0 0 1 0 1 1 0 1") + "] " + options +
         "\n";
}

// With such a narrow filter, the film's samples are at the same positions as a frame's.
std::string before_wall(const std::string& light, const std::string& squares) {
  return R"(
LookAt 0 0 -8  0 0 0  0 1 0
Camera "perspective" "float fov" [36]
Film "rgb" "integer xresolution" [48] "integer yresolution" [48]
PixelFilter "box" "float xradius" [.0001] "float yradius" [.0001]
WorldBegin
Texture "halves" "float" "checkerboard" "float uscale" [2] "float vscale" [1] "float tex1" [0] "float tex2" [1]
)" + light +
         R"(
Material "diffuse" "rgb reflectance" [.5 .5 .5]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-4 -4 1  4 -4 1  4 4 1  -4 4 1]
)" + squares;
}

// A map of 2 x 2 normals, tilted by about 30 degrees to the left, the right, downwards and upwards.
std::string normal_map(const test::TemporaryDir& folder) {
  const std::vector<float> texels{.25f, .5f, .93f, .75f, .5f, .93f, .5f, .25f, .93f, .5f, .75f, .93f};
  std::string path = (folder.path() / "n.exr").string();
  const auto output = OIIO::ImageOutput::create(path);
  EXPECT_TRUE(output->open(path, OIIO::ImageSpec(2, 2, 3, OIIO::TypeDesc::FLOAT)));
  EXPECT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, texels.data()));
  EXPECT_TRUE(output->close());
  return path;
}

// Four squares under a sky that is bright on one side: metal beside plaster, tilted normals, a lamp with a picture, and
// a half-transparent square with a mirrored map. Pixels at edges of patterns are skipped.
TEST_F(SurfaceTexturesTest, SurfacesAreThoseOfTheCpu) {
  const test::TemporaryDir folder;
  const std::string squares =
      R"(
MakeNamedMaterial "plaster" "string type" "diffuse" "rgb reflectance" [.2 .6 .3]
MakeNamedMaterial "metal" "string type" "conductor" "rgb reflectance" [.9 .5 .2] "float roughness" [.6]
Material "mix" "string materials" ["plaster" "metal"] "texture amount" "halves"
)" + square(-1.2f, 1.2f) +
      R"(Material "diffuse" "rgb reflectance" [.7 .7 .7] "string normalmap" ")" + normal_map(folder) + "\"\n" +
      square(1.2f, 1.2f) + R"(
AttributeBegin
Texture "window" "spectrum" "bilerp" "rgb v00" [.1 .2 .3] "rgb v10" [5 1 2] "rgb v01" [2 7 1] "rgb v11" [9 3 8]
AreaLightSource "diffuse" "texture L" "window" "bool twosided" true
Material "diffuse" "rgb reflectance" [.1 .1 .1]
)" + square(-1.2f, -1.2f) +
      R"(AttributeEnd
Material "diffuse" "rgb reflectance" [.1 .2 .9] "string normalmap" ")" +
      normal_map(folder) + "\"\n" + square(1.2f, -1.2f, R"("texture alpha" "halves")", true);
  SceneDescription description =
      read_pbrt_string(before_wall(R"(LightSource "infinite" "rgb L" [1 1 1])", squares), ".", "test scene");
  description::SphericalTexels sky{64, 32, {}};
  for (int i = 0; i < 64 * 32; ++i) {
    const float azimuth = 2 * pi * (static_cast<float>(i % 64) + 0.5f) / 64,
                polar = pi * (static_cast<float>(i / 64) + 0.5f) / 32;
    sky.rows.push_back({1 + 0.9f * std::sin(azimuth), 1 + 0.9f * std::cos(azimuth), 1 + 0.9f * std::cos(polar)});
  }
  std::get<description::InfiniteLight>(description.lights.at(0).node).texels =
      std::make_shared<const description::SphericalTexels>(sky);
  const Scene scene(std::move(description));
  RenderOptions options = test::options_for("splitsum", 1);
  options.color = ColorMode::rgb;
  const Image expected = test::render_image(scene, options);
  Renderer renderer(scene);
  FrameSettings settings;
  settings.technique = TechniqueChoice("splitsum");
  renderer.draw(make_view(scene.description().view), settings);
  const Image found = renderer.read_layers();
  for (const char* layer : {"emission", "direct"}) {
    const Image a = *select_layer(expected, layer), b = *select_layer(found, layer);
    int differ = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i)
      if (std::fabs(a.pixels[i] - b.pixels[i]) > 0.01f * std::max(0.1f, a.pixels[i])) ++differ;
    RecordProperty(layer, std::to_string(differ));
    // 0 with llvmpipe. Edges between halves may fall on the other side of some pixels.
    EXPECT_LT(differ, static_cast<int>(a.pixels.size()) / 200) << layer;
  }
}

Image mean_of_frames(const Scene& scene, FrameSettings settings, std::uint32_t frames) {
  Renderer renderer(scene);
  Image sum;
  for (std::uint32_t i = 0; i < frames; ++i) {
    settings.views.frame = i;
    renderer.draw(make_view(scene.description().view), settings);
    const Image frame = renderer.read_layers();
    if (i == 0) sum = Image(frame.width, frame.height, frame.channels);
    for (std::size_t p = 0; p < frame.pixels.size(); ++p) sum.pixels[p] += frame.pixels[p] / static_cast<float>(frames);
  }
  return sum;
}

double mean_over(const Image& image, int x0, int y0, int x1, int y1) {
  double sum = 0;
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x) sum += static_cast<double>(image.at(x, y, 3));
  return sum / ((x1 - x0) * (y1 - y0));
}

// Two black squares of opacities .3 and .5, one behind the other, in front of the wall. The wall is visible in .35 of
// 180 pixels of 50 frames; five standard deviations are .025.
TEST_F(SurfaceTexturesTest, FramesSeeThroughSurfacesByChance) {
  const std::string light = R"(LightSource "distant" "point3 from" [0 0 -1] "point3 to" [0 0 0]
)";
  const std::string black = R"(Material "diffuse" "rgb reflectance" [0 0 0]
)";
  const Scene scene =
      test::scene_from_text(before_wall(light, black + square(0, 0, R"("float alpha" [.3])") + "Translate 0 0 -.5\n" +
                                                   square(0, 0, R"("float alpha" [.5])")));
  const Scene bare = test::scene_from_text(before_wall(light, ""));
  FrameSettings settings;
  settings.shadows = ShadowKind::none;
  const double seen = mean_over(mean_of_frames(scene, settings, 50), 18, 18, 30, 33),
               wall = mean_over(mean_of_frames(bare, settings, 1), 18, 18, 30, 33);
  EXPECT_GT(wall, 0);
  EXPECT_NEAR(seen / wall, 0.35, 0.025);
}

// In the sun, the left half of the square casts no shadow, and a square of opacity .25 casts a faint one.
TEST_F(SurfaceTexturesTest, MapsShadowByOpacity) {
  const auto shadow = [&](const std::string& alpha) {
    const std::string sun = R"(LightSource "distant" "point3 from" [-4 0 -1] "point3 to" [0 0 0]
)";
    const Scene scene = test::scene_from_text(before_wall(sun, square(-4.5f, 0, alpha)));
    FrameSettings settings;
    settings.views.is_random = false;
    return mean_of_frames(scene, settings, 1);
  };
  const Image opaque = shadow(""), holed = shadow(R"("texture alpha" "halves")"),
              light = shadow(R"("float alpha" [.25])");
  // The shadow is at x = -1.5 to .5. Its halves meet at -.5, in column 26 or 20, depending on whether x grows to the
  // right or left.
  const double lit = mean_over(opaque, 2, 2, 46, 8);
  std::vector<double> columns;
  for (int x = 0; x < 48; ++x)
    if (mean_over(opaque, x, 22, x + 1, 26) < 0.01 * lit) columns.push_back(x);
  ASSERT_GT(columns.size(), 8u);
  const int first = static_cast<int>(columns.front()) + 1, last = static_cast<int>(columns.back()),
            middle = (first + last) / 2;
  const double left = mean_over(holed, first, 22, middle - 1, 26) / lit,
               right = mean_over(holed, middle + 2, 22, last, 26) / lit;
  EXPECT_NEAR(std::max(left, right), 1, 0.05);
  EXPECT_NEAR(std::min(left, right), 0, 0.05);
  EXPECT_NEAR(mean_over(light, first, 22, last, 26) / lit, 0.75, 0.02);
}

// A quarter of a square of 4 m² and opacity .25 is in the voxels.
TEST_F(SurfaceTexturesTest, VoxelsHoldSurfacesByOpacity) {
  const Scene scene = test::scene_from_text(R"(WorldBegin
LightSource "point"
)" + square(0, 0, R"("float alpha" [.25])"));
  const GpuScene gpu_scene(scene);
  const GpuTriangles triangles(gpu_scene);
  const Voxels voxels =
      voxelise(scene, gpu_scene, triangles, voxel_grids(bounds_of(gpu_scene, triangles), 16, {}, 1).front());
  double area = 0;
  for (const VoxelSide& side : voxels.sides) area += static_cast<double>(side.area);
  EXPECT_NEAR(area, 2 * 0.25 * 4, 1e-4);
}

// While the eye moves, the GPU draws plaster with patches of rough metal, and eye paths draw polished metal.
TEST_F(SurfaceTexturesTest, StandInsAreNearEyePaths) {
  const auto scene =
      [&](const std::string& roughness) {
        return test::scene_from_text(before_wall(R"(LightSource "point" "rgb I" [9 9 9] "point3 from" [0 1 -4])", R"(
MakeNamedMaterial "plaster" "string type" "diffuse" "rgb reflectance" [.2 .6 .3]
MakeNamedMaterial "metal" "string type" "conductor" "rgb reflectance" [.9 .5 .2] "float roughness" )" + roughness + R"(
Material "mix" "string materials" ["plaster" "metal"] "texture amount" "halves"
)" + square(0, 0)));
      };
  FrameSettings settings;
  const Scene rough = scene("[.6]"), polished = scene("[.001]");
  Renderer renderer(rough);
  const auto draw = [&](const Scene& shown) {
    renderer.draw(make_view(shown.description().view), settings);
    return *select_layer(renderer.read_layers(), "direct");
  };
  const Image exact = draw(rough);
  EXPECT_GT(renderer.report().rays, 0u);
  settings.has_stand_ins = true;
  const Image near = draw(rough);
  EXPECT_EQ(renderer.report().rays, 0u);
  int differ = 0;
  for (std::size_t i = 0; i < exact.pixels.size(); ++i)
    if (std::fabs(near.pixels[i] - exact.pixels[i]) > 0.1f * exact.pixels[i]) ++differ;
  EXPECT_LT(differ, static_cast<int>(exact.pixels.size()) / 20);
  renderer.update(polished);
  draw(polished);
  EXPECT_GT(renderer.report().rays, 0u);
}

// Moving a lamp keeps textured surfaces; another texture on them does not.
TEST_F(SurfaceTexturesTest, AreMadeAnewForOtherTexturesAlone) {
  const Scene scene = test::scene_from_text(before_wall(R"(LightSource "point"
)",
                                                        R"(
Texture "stripes" "spectrum" "checkerboard" "float uscale" [9] "float vscale" [1] "rgb tex1" [.1 .2 .3] "rgb tex2" [.8 .7 .9]
Material "diffuse" "texture reflectance" "stripes"
)" + square(0, 0)));
  GpuScene gpu_scene(scene);
  const std::uint64_t version = gpu_scene.surface_version();
  const SharedScene moved = test::edited(scene, [](SceneDescription& description) {
    description.lights[0].light_to_world = translate({-1, 0, 0});
  });
  gpu_scene.update(*moved);
  EXPECT_EQ(gpu_scene.surface_version(), version);
  const SharedScene painted = test::edited(scene, [](SceneDescription& description) {
    description.materials.back() = description.materials[description.materials.size() - 2];
  });
  gpu_scene.update(*painted);
  EXPECT_GT(gpu_scene.surface_version(), version);
  SurfaceTextures textures;
  const SurfaceLayer grey = [](const Vec2&) { return glm::vec4(0.5f); };
  const SurfaceLayer ramp = [](const Vec2& uv) { return glm::vec4(uv.x); };
  EXPECT_TRUE(textures.update({grey}));
  EXPECT_FALSE(textures.update({grey}));
  EXPECT_TRUE(textures.update({ramp}));
}

}  // namespace
}  // namespace lanthorn::surface_textures_test
