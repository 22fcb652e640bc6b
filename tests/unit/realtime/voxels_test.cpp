// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Surfaces in voxels, and light by cones through them.
#include "realtime/voxels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "realtime/renderer.h"
#include "support/opengl.h"
#include "support/render_scene.h"

namespace lanthorn::voxels_test {
namespace {

class VoxelsTest : public test::OpenGl {};

std::string view(const std::string& look_at, int fov) {
  return "LookAt " + look_at + "\nCamera \"perspective\" \"float fov\" [" + std::to_string(fov) + "]\n" +
         R"(Film "rgb" "integer xresolution" [32] "integer yresolution" [24]
PixelFilter "box"
WorldBegin
)";
}

// Every triangle is cut into pieces of voxels, each with two sides.
TEST_F(VoxelsTest, HoldAllSurfacesAtTheirPlaces) {
  const Scene scene = test::scene_from_text(view("0 1 -3  0 0 0  0 1 0", 40) + R"(
Material "diffuse" "rgb reflectance" [.5 .25 .125]
Shape "trianglemesh" "integer indices" [0 1 2] "point3 P" [-1 0 -1  1.3 .4 -.7  .2 .9 1.1]
Material "diffuse" "rgb reflectance" [.5 .5 .5]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-1 -1 -1  1 -1 -1  1 -1 1  -1 -1 1]
)");
  const GpuScene gpu_scene(scene);
  const Voxels voxels = voxelise(scene, gpu_scene, 32);
  const Vec3 a(2.3f, 0.4f, 0.3f), b(1.2f, 0.9f, 2.1f), normal = normalize(cross(a, b));
  const double slanted = 0.5 * static_cast<double>(std::sqrt(length_squared(cross(a, b))));
  double area = 0, of_slanted = 0;
  for (const VoxelLeaf& leaf : voxels.leaves)
    for (std::uint32_t i = leaf.first_side; i < leaf.first_side + leaf.side_count; ++i) {
      const VoxelSide& side = voxels.sides[i];
      area += static_cast<double>(side.area);
      const Vec3 place = (side.position - voxels.corner) / voxels.side;
      EXPECT_LE(std::fabs(place.x - static_cast<float>(leaf.x) - 0.5f), 0.501f);
      EXPECT_LE(std::fabs(place.y - static_cast<float>(leaf.y) - 0.5f), 0.501f);
      EXPECT_LE(std::fabs(place.z - static_cast<float>(leaf.z) - 0.5f), 0.501f);
      if (side.position.y < -0.5f) continue;
      of_slanted += static_cast<double>(side.area);
      EXPECT_NEAR(dot(side.position - Point(-1, 0, -1), normal), 0, 1e-4f);
      EXPECT_NEAR(std::fabs(dot(Vec3(side.normal), normal)), 1, 1e-4f);
      EXPECT_FLOAT_EQ(side.albedo.y, 0.25f);
    }
  EXPECT_NEAR(of_slanted / (2 * slanted), 1, 1e-4);
  EXPECT_NEAR(area / (2 * (slanted + 4)), 1, 1e-4);
}

FrameSettings cone_settings(int bounces) {
  FrameSettings settings;
  settings.indirect = IndirectLight::voxels;
  settings.voxels.size = 32;
  settings.voxels.bounces = bounces;
  return settings;
}

Rgb mean_of(const Image& image, int x0, int x1) {
  Rgb sum;
  for (int y = 0; y < image.height; ++y)
    for (int x = x0; x < x1; ++x) sum += Rgb{image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)};
  return (1 / static_cast<float>(image.height * (x1 - x0))) * sum;
}

Image indirect_of(Renderer& renderer, const Scene& scene, FrameSettings settings) {
  // Means over turns of the cones.
  constexpr int frames = 4;
  Image sum;
  for (int i = 0; i < frames; ++i) {
    settings.voxels.turn = turn_of_frame(static_cast<std::uint32_t>(i));
    renderer.draw(make_view(scene.description().view), settings);
    const Image frame = *select_layer(renderer.read_layers(), "indirect");
    if (i == 0)
      sum = frame;
    else
      for (std::size_t p = 0; p < frame.pixels.size(); ++p) sum.pixels[p] += frame.pixels[p];
  }
  for (float& value : sum.pixels) value /= frames;
  return sum;
}

// A ball around its lamp: irradiance E = I / r² everywhere, and each bounce is the albedo times the one before.
TEST_F(VoxelsTest, EnergyIsBoundedInsideABall) {
  for (const float albedo : {0.5f, 0.9f}) {
    const Scene scene = test::scene_from_text(view("0 0 -.5  0 0 1  0 1 0", 80) +
                                              "LightSource \"point\" \"rgb I\" [1 1 1]\nMaterial \"diffuse\" \"rgb "
                                              "reflectance\" [" +
                                              std::to_string(albedo) + " " + std::to_string(albedo) + " " +
                                              std::to_string(albedo) + "]\nShape \"sphere\"\n");
    Renderer renderer(scene);
    float expected = 0;
    for (int bounces = 1; bounces <= 4; ++bounces) {
      expected += std::pow(albedo, static_cast<float>(bounces + 1)) * inv_pi;
      const float found = mean_of(indirect_of(renderer, scene, cone_settings(bounces)), 0, 32).g;
      // Each bounce loses a tenth to the coarse dark outside of the ball, and none gains.
      EXPECT_GT(found, std::pow(0.85f, static_cast<float>(bounces)) * expected) << albedo << ' ' << bounces;
      EXPECT_LT(found, 1.02f * expected) << albedo << ' ' << bounces;
    }
  }
}

// A wide room, dark at its other end, with the lamp in it moved from left to right.
TEST_F(VoxelsTest, LightFollowsALampThatMoves) {
  const auto room = [](float x) {
    return test::scene_from_text(view("0 1 -5.5  0 1 0  0 1 0", 50) +
                                 "LightSource \"point\" \"rgb I\" [3 3 3] \"point3 from\" [" + std::to_string(x) +
                                 R"( 1 0]
Material "diffuse" "rgb reflectance" [.7 .7 .7]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-3 0 1  3 0 1  3 0 -1  -3 0 -1]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-3 2 1  3 2 1  3 2 -1  -3 2 -1]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-3 0 1  3 0 1  3 2 1  -3 2 1]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-3 0 -1  -3 0 1  -3 2 1  -3 2 -1]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [3 0 -1  3 0 1  3 2 1  3 2 -1]
)");
  };
  const Scene left = room(-2), right = room(2);
  Renderer renderer(left);
  const Image at_left = indirect_of(renderer, left, cone_settings(2));
  const std::uint64_t version = renderer.gpu_scene().surface_version();
  renderer.update(right);
  const Image at_right = indirect_of(renderer, right, cone_settings(2));
  EXPECT_EQ(renderer.gpu_scene().surface_version(), version) << "the surfaces are the same: nothing to voxelise";
  EXPECT_GT(mean_of(at_left, 0, 12).g, 3 * mean_of(at_left, 20, 32).g);
  EXPECT_GT(mean_of(at_right, 20, 32).g, 3 * mean_of(at_right, 0, 12).g);
  EXPECT_NEAR(mean_of(at_right, 20, 32).g / mean_of(at_left, 0, 12).g, 1, 0.05);
}

TEST_F(VoxelsTest, FramesAreTheSameFromRunToRun) {
  const Scene scene = test::scene_from_text(view("0 0 -.5  0 0 1  0 1 0", 80) +
                                            "LightSource \"point\" \"rgb I\" [1 1 1] \"point3 from\" [.3 .2 .1]\n"
                                            "Material \"diffuse\"\nShape \"sphere\"\n");
  Renderer first(scene), second(scene);
  EXPECT_EQ(indirect_of(first, scene, cone_settings(2)).pixels, indirect_of(second, scene, cone_settings(2)).pixels);
}

}  // namespace
}  // namespace lanthorn::voxels_test
