// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Split-sum shading with OpenGL: compares maps baked by compute shaders, and frames, with the CPU's.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "lanthorn/ibl.h"
#include "lanthorn/metrics.h"
#include "realtime/frame/renderer.h"
#include "realtime/scene/gpu_scene.h"
#include "realtime/scene/shader_files.h"
#include "realtime/techniques/splitsum/environment_maps.h"
#include "support/opengl.h"
#include "support/render_scene.h"

namespace lanthorn::environment_test {
namespace {

class EnvironmentTest : public test::OpenGl {};

// An environment that varies in all directions and colours, with a sun of two of 64 x 32 texels: more would not count
// as a sun (ibl/environment).
Rgb sky(float x, float y) {
  const float azimuth = 2 * pi * x, polar = pi * y;
  const bool is_sun = std::fabs(x - 0.3f) < 0.008f && std::fabs(y - 0.25f) < 0.016f;
  return {1 + 0.8f * std::sin(azimuth) * std::sin(polar) + (is_sun ? 300.0f : 0), 0.7f + 0.5f * std::cos(polar),
          0.5f + 0.4f * std::cos(3 * azimuth) * std::sin(polar)};
}

Image sky_image(int width) {
  Image image(width, width / 2, {"R", "G", "B"});
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < width; ++x) {
      const Rgb c = sky((static_cast<float>(x) + 0.5f) / static_cast<float>(width),
                        (static_cast<float>(y) + 0.5f) / static_cast<float>(image.height));
      image.at(x, y, 0) = c.r;
      image.at(x, y, 1) = c.g;
      image.at(x, y, 2) = c.b;
    }
  return image;
}

// Largest difference between texels, borders included, relative to the root mean square of the CPU's.
double difference(const CubeMap& found, const CubeMap& expected) {
  double largest = 0, squares = 0, count = 0;
  const int n = expected.size();
  for (int face = 0; face < cube_faces; ++face)
    for (int y = -1; y <= n; ++y)
      for (int x = -1; x <= n; ++x)
        for (int c = 0; c < 3; ++c) {
          const double value = static_cast<double>(expected.texel(face, x, y)[c]);
          largest = std::max(largest, std::fabs(static_cast<double>(found.texel(face, x, y)[c]) - value));
          squares += value * value;
          ++count;
        }
  return largest / std::sqrt(squares / count);
}

TEST_F(EnvironmentTest, MapsOfTheGpuAreThoseOfTheCpu) {
  const Image image = sky_image(64);
  for (const LobeWeight weight : {LobeWeight::masking, LobeWeight::cosine}) {
    IblSettings settings;
    settings.irradiance_size = 8;
    settings.specular_size = 32;
    settings.smallest_size = 4;
    settings.samples = 256;
    settings.checks = 0;
    settings.weight = weight;
    const Ibl expected = bake_ibl(image, settings);
    ASSERT_GT(expected.sun_texels, 0U);
    const EnvironmentMaps found = EnvironmentBaker(shader_files()).bake(image, settings);
    EXPECT_LT(difference(found.irradiance.read(0), cube_of(*expected.irradiance)), 1e-3);
    ASSERT_EQ(found.reflections.levels(), static_cast<int>(expected.specular.size()));
    for (int l = 0; l < found.reflections.levels(); ++l)
      EXPECT_LT(difference(found.reflections.read(l), cube_of(expected.specular[static_cast<std::size_t>(l)].faces)),
                1e-3)
          << l;
    const Image table = brdf_table(split_sum_table_size, false);
    const auto terms = found.brdf.read<Vec2>({GL_RG, GL_FLOAT}, 1);
    double largest = 0;
    for (std::size_t i = 0; i < terms.size(); ++i)
      for (std::size_t c = 0; c < 2; ++c)
        largest = std::max(
            largest, static_cast<double>(std::fabs(terms[i][static_cast<glm::length_t>(c)] - table.pixels[3 * i + c])));
    EXPECT_LT(largest, 1e-3);
  }
}

// A ball of triangles with a ball's normals: both renderers see the same triangles.
std::string ball(float x, float radius) {
  constexpr int across = 40;
  std::string indices, points, normals;
  for (int j = 0; j <= across; ++j)
    for (int i = 0; i <= across; ++i) {
      const float azimuth = 2 * pi * static_cast<float>(i) / across, polar = pi * static_cast<float>(j) / across;
      const Vec3 n(std::sin(polar) * std::cos(azimuth), std::cos(polar), std::sin(polar) * std::sin(azimuth));
      const auto add = [](std::string& text, const Vec3& v) {
        for (int c = 0; c < 3; ++c) text += std::to_string(v[c]) + " ";
      };
      add(normals, n);
      add(points, Vec3(x, radius, 0) + radius * n);
      if (i == across || j == across) continue;
      const int first = j * (across + 1) + i, below = first + across + 1;
      for (const int k : {first, first + 1, below, first + 1, below + 1, below}) indices += std::to_string(k) + " ";
    }
  return R"(Shape "trianglemesh" "integer indices" [)" + indices + R"(] "point3 P" [)" + points + R"(] "normal N" [)" +
         normals + "]\n";
}

// With such a narrow filter, the film's samples are at the same positions as a frame's.
Scene balls_under_the_sky() {
  const std::string text =
      R"(
LookAt 0 1.6 -4.5  0 .7 0  0 1 0
Camera "perspective" "float fov" [44]
Film "rgb" "integer xresolution" [64] "integer yresolution" [32]
PixelFilter "box" "float xradius" [.0001] "float yradius" [.0001]
WorldBegin
LightSource "infinite" "rgb L" [1 1 1]
Material "diffuse" "rgb reflectance" [.5 .6 .7]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-3 0 -2  3 0 -2  3 0 2  -3 0 2]
Material "conductor" "spectrum eta" "metal-Cu-eta" "spectrum k" "metal-Cu-k" "float roughness" [.4] "bool remaproughness" false
)" + ball(-1.8f, 0.7f) +
      R"(Material "conductor" "rgb reflectance" [.9 .8 .7] "float roughness" [0]
)" + ball(-0.6f, 0.5f) +
      R"(Material "dielectric" "float eta" [1.5]
)" + ball(0.6f, 0.5f) +
      R"(Material "diffusetransmission" "rgb reflectance" [.3 .2 .1] "rgb transmittance" [.2 .4 .1]
)" + ball(1.8f, 0.7f);
  SceneDescription description = read_pbrt_string(text, ".", "test scene");
  description::SphericalTexels texels{64, 32, {}};
  for (int i = 0; i < 64 * 32; ++i)
    texels.rows.push_back(sky((static_cast<float>(i % 64) + 0.5f) / 64, (static_cast<float>(i / 64) + 0.5f) / 32));
  std::get<description::InfiniteLight>(description.lights.at(0).node).texels =
      std::make_shared<const description::SphericalTexels>(texels);
  return Scene(std::move(description));
}

// Differences are relative to the pixel's brightness or the mean, whichever is larger. Pixels whose sample is on an
// edge may show either side, so a few are skipped. Graphics cards only have 256 steps between two texels of a map.
TEST_F(EnvironmentTest, FrameIsThePictureOfTheCpu) {
  const Scene scene = balls_under_the_sky();
  RenderOptions options = test::options_for("splitsum", 1);
  options.color = ColorMode::rgb;
  const Image expected = *select_layer(test::render_image(scene, options), "direct");
  Renderer renderer(scene);
  FrameSettings settings;
  settings.technique = TechniqueChoice("splitsum");
  const View view = make_view(scene.description().view);
  renderer.draw(view, settings);
  const Image found = *select_layer(renderer.read_layers(), "direct");
  const double mean = image_errors(expected, found).mean_image;
  const double tolerance = context_->driver().software ? 1e-3 : 1.0 / 256;
  int differ = 0, lit = 0;
  for (std::size_t i = 0; i < expected.pixels.size(); ++i) {
    const double value = static_cast<double>(expected.pixels[i]);
    if (value > 0) ++lit;
    if (std::fabs(static_cast<double>(found.pixels[i]) - value) > tolerance * std::max(mean, value)) ++differ;
  }
  EXPECT_GT(lit, 1000);
  EXPECT_LE(differ, lit / 200);
  // A second frame reuses the maps of the first.
  const auto has_baked = [&] {
    const std::vector<gl::StageTime> stages = renderer.report().stages;
    return std::any_of(stages.begin(), stages.end(),
                       [](const gl::StageTime& s) { return s.stage == "environment maps"; });
  };
  EXPECT_TRUE(has_baked());
  renderer.draw(view, settings);
  EXPECT_FALSE(has_baked());
  EXPECT_EQ(select_layer(renderer.read_layers(), "direct")->pixels, found.pixels);
}

// The sun is smaller than the distance between the directions all around.
TEST(EnvironmentFingerprint, ChangesWithASmallSun) {
  const auto of = [](const std::string& light) {
    return environment_fingerprint(test::scene_from_text(R"(WorldBegin
LightSource "distant" "float angle" .5 )" + light + R"(
Shape "sphere"
)"));
  };
  const std::string up = R"("point3 from" [.1 1 .2] "point3 to" [0 0 0] )";
  const auto one = of(up + R"("rgb L" [1 1 1])");
  EXPECT_EQ(of(up + R"("rgb L" [1 1 1])"), one);
  EXPECT_NE(of(up + R"("rgb L" [1 1 .9])"), one);
  EXPECT_NE(of(R"("point3 from" [.2 1 .1] "point3 to" [0 0 0] "rgb L" [1 1 1])"), one);
}

}  // namespace
}  // namespace lanthorn::environment_test
