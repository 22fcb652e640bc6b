// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Surfaces in nested voxel grids, and cone-traced light through them.
#include "realtime/techniques/voxelcones/voxels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "realtime/frame/renderer.h"
#include "support/opengl.h"
#include "support/render_scene.h"
#include "support/shapes.h"

namespace lanthorn::voxels_test {
namespace {

class VoxelsTest : public test::OpenGl {};

std::string view(const std::string& look_at, int fov) {
  return "LookAt " + look_at + R"(
Camera "perspective" "float fov" [)" +
         std::to_string(fov) + "]\n" +
         R"(Film "rgb" "integer xresolution" [32] "integer yresolution" [24]
PixelFilter "box"
WorldBegin
)";
}

// Every triangle is cut into pieces in voxels, each with two sides.
TEST_F(VoxelsTest, HoldAllSurfacesAtTheirPlaces) {
  const Scene scene = test::scene_from_text(view("0 1 -3  0 0 0  0 1 0", 40) + R"(
Material "diffuse" "rgb reflectance" [.5 .25 .125]
Shape "trianglemesh" "integer indices" [0 1 2] "point3 P" [-1 0 -1  1.3 .4 -.7  .2 .9 1.1]
Material "diffuse" "rgb reflectance" [.5 .5 .5]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-1 -1 -1  1 -1 -1  1 -1 1  -1 -1 1]
)");
  const GpuScene gpu_scene(scene);
  const GpuTriangles triangles(gpu_scene);
  const VoxelGrid grid = voxel_grids(bounds_of(gpu_scene, triangles), 32, {}, 1).front();
  const Voxels voxels = voxelise(scene, gpu_scene, triangles, grid);
  const Vec3 a(2.3f, 0.4f, 0.3f), b(1.2f, 0.9f, 2.1f), normal = normalize(cross(a, b));
  const double slanted = 0.5 * static_cast<double>(std::sqrt(length_squared(cross(a, b))));
  double area = 0, of_slanted = 0;
  for (const VoxelLeaf& leaf : voxels.leaves)
    for (std::uint32_t i = leaf.first_side; i < leaf.first_side + leaf.side_count; ++i) {
      const VoxelSide& side = voxels.sides[i];
      area += static_cast<double>(side.area);
      const Vec3 place = (side.position - grid.corner) / grid.side;
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

// If a floor is wider than the grid, the grid contains a square of it with two sides. If a floor lies beside the grid,
// the grid contains nothing.
TEST_F(VoxelsTest, HoldOfSurfacesWhatLiesInTheirGrid) {
  const Scene scene = test::scene_from_text(view("0 1 -3  0 0 0  0 1 0", 40) + R"(
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-8 0 -8  8 0 -8  8 0 8  -8 0 8]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-8 4 -8  8 4 -8  8 4 8  -8 4 8]
)");
  const GpuScene gpu_scene(scene);
  const VoxelGrid grid{16, Point(-3, -1.4f, 1), 0.25f};
  const Voxels voxels = voxelise(scene, gpu_scene, GpuTriangles(gpu_scene), grid);
  EXPECT_EQ(voxels.leaves.size(), 16u * 16);
  double area = 0;
  for (const VoxelSide& side : voxels.sides) {
    area += static_cast<double>(side.area);
    EXPECT_NEAR(side.position.y, 0, 1e-6f);
    EXPECT_TRUE(side.position.x > -3 && side.position.x < 1 && side.position.z > 1 && side.position.z < 5);
  }
  EXPECT_NEAR(area, 2 * 4 * 4, 1e-4);
}

TEST(VoxelGrids, NarrowAroundTheFocusAsFarAsItLooks) {
  Bounds bounds;
  bounds.extend(Point(-100, -1, -100));
  bounds.extend(Point(100, 9, 100));
  const ViewFocus focus{Point(30, 1, -20), 2};
  const std::vector<VoxelGrid> grids = voxel_grids(bounds, 64, focus, 0);
  // 210 m, repeatedly halved as long as the result is at least 3 m.
  ASSERT_EQ(grids.size(), 7u);
  EXPECT_LT(grids[0].corner.x, -100);
  EXPECT_GT(grids[0].corner.x + grids[0].edge(), 100);
  for (std::size_t g = 1; g < grids.size(); ++g) {
    EXPECT_FLOAT_EQ(grids[g].edge(), 0.5f * grids[g - 1].edge());
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_GE(grids[g].corner[axis], grids[g - 1].corner[axis]);
      EXPECT_LE(grids[g].corner[axis] + grids[g].edge(), grids[g - 1].corner[axis] + grids[g - 1].edge());
      // Within an eighth of the width around the middle.
      const float place = (focus.centre[axis] - grids[g].corner[axis]) / grids[g].edge();
      EXPECT_NEAR(place, 0.5f, 0.0626f);
    }
  }
  // Along 14 m, each grid moves by eighths of its width, and not more often.
  std::vector<VoxelGrid> before = grids;
  std::vector<float> moves(grids.size());
  constexpr int steps = 1400;
  for (int i = 1; i <= steps; ++i) {
    const ViewFocus moved{focus.centre + Vec3(0.01f * static_cast<float>(i), 0, 0), 2};
    const std::vector<VoxelGrid> after = voxel_grids(bounds, 64, moved, 0);
    for (std::size_t g = 0; g < grids.size(); ++g) moves[g] += before[g] == after[g] ? 0.0f : 1.0f;
    before = after;
  }
  EXPECT_EQ(moves[0], 0);
  for (std::size_t g = 1; g < grids.size(); ++g) EXPECT_NEAR(moves[g], 14 / (grids[g].edge() / 8), 1) << g;
}

TEST(VoxelGrids, AreAsManyAsAreAskedForOrNeeded) {
  Bounds bounds;
  bounds.extend(Point(-1, -1, -1));
  bounds.extend(Point(1, 1, 1));
  EXPECT_EQ(voxel_grids(bounds, 32, {Point(0, 0, -4), 3.6f}, 0).size(), 1u) << "all is seen from afar";
  EXPECT_EQ(voxel_grids(bounds, 32, {}, 0).size(), 1u) << "nothing is seen";
  EXPECT_EQ(voxel_grids(bounds, 32, {Point(0), 0}, 0).size(), std::size_t{gpu::most_voxel_grids});
  EXPECT_EQ(voxel_grids(bounds, 32, {}, 3).size(), 3u);
  EXPECT_EQ(voxel_grids({}, 32, {}, 0).size(), 1u) << "there are no surfaces";
  EXPECT_EQ(voxel_grids(bounds, 256, {}, 8).size(), 2u) << "of .9 GiB each";
}

// The eye is 2 m above a floor. Parallel rays start at the same place, but need detail where they meet the floor.
TEST_F(VoxelsTest, FocusIsTheEyeOrWhatParallelRaysMeet) {
  const std::string floor = test::quad("-50 0 -50  50 0 -50  50 0 50  -50 0 50");
  const auto focus = [&](const std::string& camera) {
    const Scene scene = test::scene_from_text(camera + floor);
    return focus_of(scene, make_view(scene.description().view));
  };
  const std::string down = "7 2 5  7 0 5  0 0 1";
  const ViewFocus eye = focus(view(down, 10));
  EXPECT_EQ(eye.centre, Point(7, 2, 5));
  EXPECT_NEAR(eye.distance, 2, 0.02f);
  const ViewFocus parallel = focus("LookAt " + down + R"(
Camera "orthographic" "float screenwindow" [-1 1 -1 1]
Film "rgb" "integer xresolution" [32] "integer yresolution" [32]
WorldBegin
)");
  EXPECT_NEAR(parallel.centre.y, 0, 1e-4f);
  EXPECT_NEAR(parallel.centre.x, 7, 0.2f);
  EXPECT_NEAR(parallel.distance, 0.8f, 0.2f);
  EXPECT_EQ(focus(view("7 2 5  7 4 5  0 0 1", 10)).distance, infinity);
}

FrameSettings cone_settings(int bounces, int grids = 0, int size = 32) {
  FrameSettings settings;
  settings.technique = TechniqueChoice("voxelcones", {{"voxels", std::to_string(size)},
                                                      {"bounces", std::to_string(bounces)},
                                                      {"grids", grids == 0 ? "auto" : std::to_string(grids)}});
  return settings;
}

Rgb mean_of(const Image& image, int x0, int x1) {
  Rgb sum;
  for (int y = 0; y < image.height; ++y)
    for (int x = x0; x < x1; ++x) sum += Rgb{image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)};
  return (1 / static_cast<float>(image.height * (x1 - x0))) * sum;
}

Image indirect_of(Renderer& renderer, const Scene& scene, FrameSettings settings) {
  // Means over rotations of the cones.
  constexpr std::uint32_t frames = 4;
  Image sum;
  for (std::uint32_t i = 0; i < frames; ++i) {
    settings.views.frame = i;
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

// A ball around its lamp: the irradiance is E = I / r² everywhere, and each bounce is the albedo times the one before.
TEST_F(VoxelsTest, EnergyIsBoundedInsideABall) {
  for (const float albedo : {0.5f, 0.9f}) {
    const Scene scene = test::scene_from_text(view("0 0 -.5  0 0 1  0 1 0", 80) +
                                              R"(LightSource "point" "rgb I" [1 1 1]
Material "diffuse" "rgb reflectance" [)" + std::to_string(albedo) +
                                              " " + std::to_string(albedo) + " " + std::to_string(albedo) + R"(]
Shape "sphere"
)");
    Renderer renderer(scene);
    float expected = 0;
    for (int bounces = 1; bounces <= 4; ++bounces) {
      expected += std::pow(albedo, static_cast<float>(bounces + 1)) * inv_pi;
      const float found = mean_of(indirect_of(renderer, scene, cone_settings(bounces)), 0, 32).g;
      // Each bounce loses a tenth to the dark coarse voxels outside the ball, and none gains light.
      EXPECT_GT(found, std::pow(0.85f, static_cast<float>(bounces)) * expected) << albedo << ' ' << bounces;
      EXPECT_LT(found, 1.02f * expected) << albedo << ' ' << bounces;
    }
  }
}

// The same with finer grids on a visible part of the wall: where a grid ends, no light is gained, and no more is lost
// than in a single grid that is equally fine everywhere.
TEST_F(VoxelsTest, EnergyIsBoundedAcrossTheGridsOfAClipmap) {
  constexpr float albedo = 0.9f;
  const Scene scene = test::scene_from_text(view("0 0 .5  0 0 1  0 1 0", 80) +
                                            R"(LightSource "point" "rgb I" [1 1 1]
Material "diffuse" "rgb reflectance" [.9 .9 .9]
Shape "sphere"
)");
  Renderer renderer(scene);
  float expected = 0;
  for (int bounces = 1; bounces <= 2; ++bounces) {
    expected += std::pow(albedo, static_cast<float>(bounces + 1)) * inv_pi;
    const auto found = [&](int size, int grids) {
      return mean_of(indirect_of(renderer, scene, cone_settings(bounces, grids, size)), 0, 32).g;
    };
    const float nested = found(32, 2);
    EXPECT_GT(nested, 0.99f * found(64, 1)) << bounces;
    EXPECT_LT(nested, 1.02f * expected) << bounces;
  }
}

// A room of 4 m with its lamp, on its own and in the middle of a plain of 400 m.
TEST_F(VoxelsTest, ARoomInAWidePlainIsLitAsAlone) {
  const std::string room = R"(
LightSource "point" "rgb I" [3 3 3] "point3 from" [-1 2 0]
Material "diffuse" "rgb reflectance" [.7 .7 .7]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-2 0 2  2 0 2  2 0 -2  -2 0 -2]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-2 3 2  2 3 2  2 3 -2  -2 3 -2]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-2 0 2  2 0 2  2 3 2  -2 3 2]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-2 0 -2  2 0 -2  2 3 -2  -2 3 -2]
Material "diffuse" "rgb reflectance" [.7 .2 .2]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-2 0 -2  -2 0 2  -2 3 2  -2 3 -2]
Material "diffuse" "rgb reflectance" [.2 .2 .7]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [2 0 -2  2 0 2  2 3 2  2 3 -2]
)";
  const std::string plain = test::quad("-200 -.1 -200  200 -.1 -200  200 -.1 200  -200 -.1 200");
  const std::string camera = view("0 1.5 -1.8  0 1.4 2  0 1 0", 70);
  const Scene alone = test::scene_from_text(camera + room), within = test::scene_from_text(camera + room + plain);
  Renderer of_alone(alone), of_within(within);
  const Image expected = indirect_of(of_alone, alone, cone_settings(3));
  const auto difference = [&](int grids) {
    const Image found = indirect_of(of_within, within, cone_settings(3, grids));
    double sum = 0, total = 0;
    for (std::size_t i = 0; i < found.pixels.size(); ++i) {
      sum += std::fabs(static_cast<double>(found.pixels[i] - expected.pixels[i]));
      total += static_cast<double>(expected.pixels[i]);
    }
    return sum / total;
  };
  EXPECT_LT(difference(0), 0.1);
  EXPECT_GT(difference(1), 0.4) << "one grid has voxels of 14 m";
}

// The eye moves over a plain. A grid is rebuilt when the eye has moved by an eighth of its width, not before.
TEST_F(VoxelsTest, GridsFollowTheEyeBySteps) {
  const auto plain = [](const std::string& look_at) {
    return test::scene_from_text(view(look_at, 60) + R"(
LightSource "distant" "point3 from" [0 1 0]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-99 0 -99  99 0 -99  99 0 99  -99 0 99]
)");
  };
  const Scene scene = plain("0 2 0  0 0 3  0 1 0");
  Renderer renderer(scene);
  const auto cuts = [&](const std::string& look_at) {
    const Scene moved = plain(look_at);
    renderer.draw(make_view(moved.description().view), cone_settings(1));
    const std::vector<gl::StageTime> stages = renderer.report().stages;
    return std::any_of(stages.begin(), stages.end(),
                       [](const gl::StageTime& s) { return s.stage == std::string("voxelisation (CPU)"); });
  };
  EXPECT_TRUE(cuts("0 2 0  0 0 3  0 1 0"));
  EXPECT_FALSE(cuts("0 2 0  0 0 3  0 1 0"));
  EXPECT_FALSE(cuts(".1 2 0  .1 0 3  0 1 0"));
  EXPECT_TRUE(cuts("8 2 0  8 0 3  0 1 0"));
}

// A wide room, dark at the other end, with a lamp that moves from left to right.
TEST_F(VoxelsTest, LightFollowsALampThatMoves) {
  const auto room = [](float x) {
    return test::scene_from_text(view("0 1 -5.5  0 1 0  0 1 0", 50) +
                                 R"(LightSource "point" "rgb I" [3 3 3] "point3 from" [)" + std::to_string(x) +
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
                                            R"(LightSource "point" "rgb I" [1 1 1] "point3 from" [.3 .2 .1]
Material "diffuse"
Shape "sphere"
)");
  Renderer first(scene), second(scene);
  EXPECT_EQ(indirect_of(first, scene, cone_settings(2)).pixels, indirect_of(second, scene, cone_settings(2)).pixels);
}

// A metal ball in a white environment reflects the light of its lobe, although no direction of the frame hits the
// environment.
TEST_F(VoxelsTest, ConesOfNarrowLobesShowTheSky) {
  const Scene scene = test::scene_from_text(R"(
LookAt 0 0 -4  0 0 0  0 1 0
Camera "perspective" "float fov" [20]
Film "rgb" "integer xresolution" [16] "integer yresolution" [16]
WorldBegin
LightSource "infinite" "rgb L" [1 1 1]
Material "conductor" "rgb reflectance" [.9 .9 .9] "float roughness" [.1] "bool remaproughness" false
Shape "sphere"
)");
  Renderer renderer(scene);
  renderer.draw(make_view(scene.description().view), cone_settings(4));
  const Image frame = renderer.read_layers();
  for (int x = 6; x < 10; ++x) {
    EXPECT_NEAR(frame.at(x, 8, 6), 0.9f, 0.05f) << "indirect";
    EXPECT_EQ(frame.at(x, 8, 3), 0) << "direct: the views of the sky";
  }
}

// A glass pane in front of a wall shows the wall's direct light, minus the reflection at its two sides.
TEST_F(VoxelsTest, GlassShowsDirectLight) {
  const Scene scene = test::scene_from_text(R"(
LookAt 0 0 -4  0 0 0  0 1 0
Camera "perspective" "float fov" [40]
Film "rgb" "integer xresolution" [16] "integer yresolution" [16]
WorldBegin
LightSource "point" "rgb I" [9 9 9] "point3 from" [2 2 -.5]
Material "diffuse"
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-4 -4 1  4 -4 1  4 4 1  -4 4 1]
Material "thindielectric"
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-4 -4 -1  0 -4 -1  0 4 -1  -4 4 -1]
)");
  Renderer renderer(scene);
  FrameSettings settings = cone_settings(4);
  settings.shadows = ShadowKind::none;
  double through = 0, beside = 0;
  constexpr std::uint32_t frames = 20;
  for (std::uint32_t frame = 0; frame < frames; ++frame) {
    settings.views.frame = frame;
    renderer.draw(make_view(scene.description().view), settings);
    const Image layers = renderer.read_layers();
    for (int y = 6; y < 10; ++y) {
      through += static_cast<double>(layers.at(7, y, 3) + layers.at(7, y, 9));
      beside += static_cast<double>(layers.at(8, y, 3));
    }
  }
  EXPECT_GT(beside, 0);
  // 80 paths, of which .08 are reflected: five standard deviations are .15. Another .05 is for the gradient of the
  // light.
  EXPECT_NEAR(through / beside, 0.92, 0.2);
}

}  // namespace
}  // namespace lanthorn::voxels_test
