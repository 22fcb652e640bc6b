// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The lights that a scene builds: their scales, and that surfaces and emitters agree.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <numbers>
#include <string>
#include <variant>
#include <vector>

#include "support/error_text.h"
#include "support/exr_colours.h"
#include "support/render_scene.h"
#include "support/scene_text.h"
#include "support/temporary_dir.h"

namespace lanthorn::light_test {
namespace {

using test::white;
using test::world;

const char* const area_light = R"(AreaLightSource "diffuse" "rgb L" [3 2 1]
)";

const std::array<const char*, 11> shapes{
    R"(Shape "sphere" "float radius" 0.5 "float zmin" -0.2 "float phimax" 200
)",
    R"(Shape "disk" "float radius" 0.8 "float innerradius" 0.2 "float height" 0.3
)",
    R"(Shape "cylinder" "float radius" 0.5 "float zmin" -0.5 "float zmax" 0.7 "float phimax" 300
)",
    R"(Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 0 1 0 1 1 0.4] "integer indices" [0 1 2 2 1 3]
)",
    R"(Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 0 1 0] "normal N" [0 0 -1 0 0 -1 0 0 -1] "integer indices" [0 1 2]
)",
    R"(Shape "bilinearmesh" "point3 P" [0 0 0  1 0 0  0 1 0  1 1 0  0 0 1  1 0 1  0 1 1  1 1 1] "integer indices" [0 1 2 3 4 5 6 7]
)",
    R"(Shape "bilinearmesh" "point3 P" [0 0 0  1 0 0  0 1 0  1 1 0.4]
)",
    R"(Shape "bilinearmesh" "point3 P" [0 0 0  1 0 0  0 1 0  1 1 0.4] "normal N" [0 0 -1 0 0 -1 0 0 -1 0 0 -1]
)",
    R"(Shape "curve" "float width0" 0.4 "float width1" 0 "point3 P" [-1 0 0  -0.3 0.3 0  0.4 0.1 0.3  1 0 0.4]
)",
    R"(Shape "curve" "string type" "cylinder" "float width" 0.4 "integer degree" 2 "point3 P" [0 0 0  0.6 0 0  1 0.2 0.8]
)",
    R"(Shape "curve" "string type" "ribbon" "float width" 0.4 "normal N" [0 0 1 0.3 1 1] "point3 P" [0 0 0  1 0 0  1 1 0.4  0.2 1 0.4]
)"};

const std::array<std::string, 4> places{"", "ReverseOrientation\n", "Scale -1 2 1\n",
                                        "ConcatTransform [0.9 0.3 0 0  0.2 -1.3 0.1 0  0 0.4 0.7 0  3 -2 1 1]\n"};

// Of this many points on a mesh's triangles, rounding may move one across an edge, to the neighbouring triangle.
constexpr std::size_t most_at_edges = 1000;

// A ray from the front must find each point from which a light emits, as a point of that light with the same normal.
TEST(SceneLights, EmittersAreTheSurfacesThatRaysFind) {
  for (const char* shape : shapes)
    for (const std::string& place : places) {
      SCOPED_TRACE(place + shape);
      const Scene scene = world(place + area_light + shape);
      HashRng rng(1);
      std::size_t neighbours = 0;
      for (std::uint32_t l = 0; l < scene.lights().size(); ++l)
        for (int i = 0; i < 50; ++i) {
          const auto emission = sample_emission(scene.lights()[l], rng.next2(), rng.next2(), white);
          ASSERT_TRUE(emission);
          EXPECT_GT(dot(emission->direction, emission->normal), 0);
          const Ray ray{emission->origin + 1e-3f * emission->normal, -emission->normal};
          const auto at = scene.intersect(ray, white);
          ASSERT_TRUE(at);
          EXPECT_LT(length_squared(at->position - emission->origin), 1e-8f);
          ASSERT_TRUE(at->light);
          if (*at->light != l) {
            ++neighbours;
            continue;
          }
          EXPECT_GT(dot(at->normal, emission->normal), 0.99f);
          EXPECT_GT(emitted(scene.lights()[*at->light], {at->position, at->normal, at->uv}, at->normal, white)[0], 0);
          EXPECT_EQ(emitted(scene.lights()[*at->light], {at->position, at->normal, at->uv}, -at->normal, white)[0], 0);
        }
      EXPECT_LE(neighbours, scene.lights().size() * 50 / most_at_edges);
    }
}

// A texture must give the same result whether a point was sampled or hit by a ray, for the parametrisation of each
// shape, in the world and in instances.
TEST(SceneLights, TexturedEmissionIsWhatRaysSee) {
  const std::string lamp =
      R"(Texture "l" "spectrum" "bilerp" "rgb v00" [1 2 3] "rgb v10" [5 1 2] "rgb v01" [2 7 1] "rgb v11" [9 3 8]
Texture "a" "float" "bilerp" "float v00" [0.9] "float v10" [0.4] "float v01" [0.6] "float v11" [0.2]
AreaLightSource "diffuse" "texture L" "l" "float scale" 2
)";
  for (const std::string shape : shapes)
    for (const std::string& place : places)
      for (const bool instanced : {false, true}) {
        SCOPED_TRACE(place + shape + (instanced ? "in an instance" : ""));
        const std::string emitter = lamp + shape + R"("texture alpha" "a"
)";
        const Scene scene = world(instanced ? R"(ObjectBegin "o"
)" + emitter + "ObjectEnd\n" + place + R"(ObjectInstance "o"
)"
                                            : place + emitter);
        HashRng rng(1);
        std::size_t neighbours = 0;
        for (std::uint32_t l = 0; l < scene.lights().size(); ++l)
          for (int i = 0, met = 0; met < 20; ++i) {
            ASSERT_LT(i, 1000);
            const Light& light = scene.lights()[l];
            const auto emission = sample_emission(light, rng.next2(), rng.next2(), white);
            ASSERT_TRUE(emission);
            const Ray ray{emission->origin + 1e-3f * emission->normal, -emission->normal};
            const auto at = scene.intersect(ray, white);
            // Rays pass through holes and may hit the surface elsewhere.
            if (!at || length_squared(at->position - emission->origin) > 1e-6f) continue;
            ++met;
            ASSERT_TRUE(at->light);
            if (*at->light != l) {
              ++neighbours;
              continue;
            }
            const Spectrum seen = emitted(light, {at->position, at->normal, at->uv}, at->normal, white);
            const float u = at->uv.x, v = at->uv.y;
            EXPECT_NEAR(seen[1], 2 * lerp(v, lerp(u, 2.0f, 1.0f), lerp(u, 7.0f, 3.0f)), 1e-3f);
            const float alpha = lerp(v, lerp(u, 0.9f, 0.4f), lerp(u, 0.6f, 0.2f));
            const float area = 1 / emission->pdf_position;
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(emission->flux[c] / (pi * area), seen[c] * alpha, 0.02f);
          }
        EXPECT_LE(neighbours, scene.lights().size() * 20 / most_at_edges);
      }
}

TEST(SceneLights, PatternsDecideThePower) {
  // Half of the area lets all rays pass. A mesh's power is distributed by brightness, so that all its triangles have
  // the same scale.
  const std::string step =
      R"(Texture "a" "float" "checkerboard" "float uscale" 8 "float vscale" 8 "float tex1" 1 "float tex2" 0
)";
  const Scene holed = world(step +
                            R"(AreaLightSource "diffuse" "rgb L" [1 2 3]
Shape "bilinearmesh" "point3 P" [0 0 0  2 0 0  0 1 0  2 1 0] "texture alpha" "a"
)");
  EXPECT_NEAR(power(holed.lights()[0]), pi * luminance({1, 2, 3}), 0.1f);
  const Scene graded = world(
      R"(Texture "l" "spectrum" "bilerp" "rgb v00" [0 0 0] "rgb v10" [1 1 1] "rgb v01" [0 0 0] "rgb v11" [1 1 1]
AreaLightSource "diffuse" "texture L" "l" "float power" 5
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [0 0 0 1 0 0 1 1 0 0.1 1.1 0] "point2 uv" [0 0 1 0 1 1 0 1]
)");
  ASSERT_EQ(graded.lights().size(), 2u);
  EXPECT_NEAR(power(graded.lights()[0]) / power(graded.lights()[1]), 2, 0.05f);
  EXPECT_NEAR(power(graded.lights()[0]) + power(graded.lights()[1]), 5, 1e-3f);
  const EmitterHit right{{1, 0.5f, 0}, {0, 0, 1}, {1, 0.5f}};
  EXPECT_NEAR(emitted(graded.lights()[0], right, {0, 0, 1}, white)[0],
              emitted(graded.lights()[1], right, {0, 0, 1}, white)[0], 1e-5f);
}

// With many primitives, each is sampled at only a few points.
TEST(SceneLights, PatternsOfManyPrimitivesDecideTheirPower) {
  constexpr int side = 200;
  std::string points, uvs, triangles;
  for (int y = 0; y <= side; ++y)
    for (int x = 0; x <= side; ++x) {
      points += std::to_string(x) + " " + std::to_string(y) + " 0 ";
      uvs += std::to_string(x / double{side}) + " " + std::to_string(y / double{side}) + " ";
      const int at = y * (side + 1) + x;
      if (x < side && y < side)
        for (const int corner : {at, at + 1, at + side + 2, at, at + side + 2, at + side + 1})
          triangles += std::to_string(corner) + " ";
    }
  const Scene scene = world(
      R"(Texture "l" "spectrum" "bilerp" "rgb v00" [0 0 0] "rgb v10" [2 2 2] "rgb v01" [0 0 0] "rgb v11" [2 2 2]
AreaLightSource "diffuse" "texture L" "l"
Shape "trianglemesh" "integer indices" [)" +
      triangles + R"(] "point3 P" [)" + points + R"(] "point2 uv" [)" + uvs + "]\n");
  ASSERT_EQ(scene.lights().size(), std::size_t{side * side});
  double total = 0;
  for (const Light& light : scene.lights()) total += static_cast<double>(power(light));
  EXPECT_NEAR(total / (static_cast<double>(pi) * side * side), 1, 0.01);
}

// A screen of which a quarter is lit. Most points must be there, whether the screen is one piece, triangles, or has its
// own texture coordinates.
TEST(SceneLights, PointsAreDrawnWhereScreensAreBright) {
  const std::string screen =
      R"(Texture "lit" "spectrum" "checkerboard" "float uscale" 4 "float vscale" 4 "rgb tex1" [0 0 9] "rgb tex2" [0 0 0]
Texture "corner" "float" "checkerboard" "float uscale" 2 "float vscale" 1 "float tex1" 1 "float tex2" 0
Texture "screen" "spectrum" "scale" "texture tex" "lit" "texture scale" "corner"
AreaLightSource "diffuse" "texture L" "screen"
)";
  for (
      const std::string shape :
      {R"(Shape "bilinearmesh" "point3 P" [0 0 0  1 0 0  0 1 0  1 1 0]
)",
       R"(Scale 3 -2 1
Shape "bilinearmesh" "point3 P" [0 0 0  1 0 0  0 1 0  1 1 0] "point2 uv" [0 1 0 0 1 1 1 0]
)",
       R"(Shape "trianglemesh" "integer indices" [0 1 3 0 3 2] "point3 P" [0 0 0  1 0 0  0 1 0  1 1 0] "point2 uv" [0 0 1 0 0 1 1 1]
)"}) {
    SCOPED_TRACE(shape);
    const Scene scene = world(screen + shape);
    HashRng rng(1);
    int lit = 0, seen = 0, drawn = 0;
    for (const Light& light : scene.lights())
      for (int i = 0; i < 2000; ++i, ++drawn) {
        const auto emission = sample_emission(light, rng.next2(), rng.next2(), white);
        ASSERT_TRUE(emission);
        EXPECT_NEAR(emission->pdf_position,
                    pdf_emission(light, {emission->origin, emission->normal, {}}, emission->normal).position, 1e-3f);
        lit += emission->flux[2] > 0;
        const auto direct = sample_direct(light, emission->origin + 20.0f * emission->normal, rng.next2(), white);
        ASSERT_TRUE(direct);
        seen += direct->radiance[2] > 0;
      }
    // A quarter of the area is lit.
    EXPECT_GT(lit, 0.8 * drawn);
    EXPECT_GT(seen, 0.5 * drawn);
  }
}

TEST(SceneLights, AlphaZeroMakesInvisibleLamps) {
  const Scene scene = world(std::string(area_light) + R"(Shape "disk" "float alpha" 0
)");
  ASSERT_EQ(scene.lights().size(), 1u);
  EXPECT_FALSE(scene.intersect({{0.1f, 0.1f, 1}, {0, 0, -1}}, white));
  EXPECT_TRUE(is_delta(scene.lights()[0]));
  const auto sample = sample_direct(scene.lights()[0], {0, 0, 2}, {0.3f, 0.4f}, white);
  ASSERT_TRUE(sample);
  EXPECT_TRUE(sample->delta);
  EXPECT_NEAR(sample->radiance[0], 3, 1e-5f);
}

// A light is the same described as one patch or as two triangles, in any order of their corners.
TEST(SceneLights, TwoTrianglesAreOneParallelogram) {
  const auto lamp = [](const std::string& shape) {
    return world(R"(AreaLightSource "diffuse" "rgb L" [1 2 3]
)" + shape);
  };
  const Scene patch = lamp(R"(Shape "bilinearmesh" "point3 P" [0 0 0  2 0 0  0.5 1 0  2.5 1 0]
)");
  const Point from{0.4f, 0.3f, 0.7f};
  for (const std::string indices : {"0 1 3  0 3 2", "1 3 0  2 0 3", "3 0 1  3 2 0", "0 1 2  1 3 2", "2 0 1  3 2 1"}) {
    SCOPED_TRACE(indices);
    const Scene pair = lamp(R"(Shape "trianglemesh" "point3 P" [0 0 0  2 0 0  0.5 1 0  2.5 1 0] "integer indices" [)" +
                            indices + "]\n");
    ASSERT_EQ(pair.lights().size(), 1u);
    EXPECT_FLOAT_EQ(power(pair.lights()[0]), power(patch.lights()[0]));
    for (const Vec2 u : {Vec2(0.1f, 0.9f), Vec2(0.7f, 0.2f)}) {
      const auto drawn = sample_direct(pair.lights()[0], from, u, white);
      ASSERT_TRUE(drawn);
      const EmitterHit hit{drawn->position, {0, 0, 1}, {}};
      EXPECT_NEAR(drawn->pdf, pdf_direct(pair.lights()[0], from, hit), 1e-4f * drawn->pdf);
      EXPECT_NEAR(drawn->pdf, pdf_direct(patch.lights()[0], from, hit), 1e-4f * drawn->pdf);
    }
    for (const float x : {0.9f, 1.6f}) {
      const auto at = test::look(pair, {x, 0.5f, 1}, {0, 0, -1});
      ASSERT_TRUE(at && at->light);
      EXPECT_EQ(*at->light, 0u);
    }
  }
}

TEST(SceneLights, OneLightForEachPrimitiveAndForEachPairOfTriangles) {
  const Scene scene = world(
      std::string(area_light) +
      R"(Shape "bilinearmesh" "point3 P" [0 0 0  1 0 0  0 1 0  1 1 0  0 0 1  1 0 1  0 1 1  1 1 1] "integer indices" [0 1 2 3 4 5 6 7]
Shape "trianglemesh" "point3 P" [5 0 0 6 0 0 5 1 0 6 1 0] "integer indices" [0 1 2 2 1 3]
Shape "trianglemesh" "point3 P" [5 0 1 6 0 1 5 1 1 6 2 1] "integer indices" [0 1 2 2 1 3]
Shape "sphere"
)");
  EXPECT_EQ(scene.lights().size(), 6u);
  EXPECT_EQ(scene.statistics().patches, 2u);
  EXPECT_EQ(scene.statistics().triangles, 4u);
  EXPECT_EQ(scene.statistics().quadrics, 1u);
}

double total_power(const std::string& directives) {
  const Scene scene = world(directives);
  double sum = 0;
  for (const Light& light : scene.lights()) sum += power(light);
  return sum;
}

// A lamp emits its `power` however many primitives it has, with the same radiance everywhere.
TEST(SceneLights, PowerIsThatOfTheWholeLamp) {
  const test::TemporaryDir dir;
  dir.write("mixed.ply",
            "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\nelement "
            "face 2\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 .5\n3 3 0\n4 0 1 2 "
            "3\n3 1 4 2\n");
  const std::string lamp = R"(AreaLightSource "diffuse" "float power" 5 )", more = "\n";
  const std::string corners = R"( "point3 P" [0 0 0  1 0 0  0 1 0  1 1 0  2 0 1])";
  const std::string quad = R"(Shape "trianglemesh" "integer indices" [0 1 2 2 1 3])" + corners;
  struct Case {
    std::string directives;
    std::size_t lamps = 1;
  };
  for (const Case& c : {
           Case{lamp + quad},
           Case{lamp + quad + more + quad, 2},
           Case{lamp + R"("bool twosided" true )" + quad},
           Case{"Scale -3 1 1 " + lamp + quad},
           Case{lamp + quad + R"("float alpha" .25)"},
           Case{lamp + quad + R"("float alpha" 0)"},
           Case{lamp + R"(Shape "trianglemesh" "integer indices" [0 1 2 2 1 3 3 1 4])" + corners},
           Case{lamp + R"(Shape "bilinearmesh" "integer indices" [0 1 2 3 3 2 1 4])" + corners},
           Case{lamp + R"(Shape "loopsubdiv" "integer indices" [0 1 2 2 1 3])" + corners},
           Case{lamp + R"(Shape "plymesh" "string filename" "mixed.ply")"},
           Case{lamp + R"(Shape "sphere" Shape "disk")", 2},
           Case{
               R"(ObjectBegin "o" )" + lamp + quad + R"( ObjectEnd ObjectInstance "o" Scale 2 1 -3 ObjectInstance "o")",
               2},
       }) {
    SCOPED_TRACE(c.directives);
    const Scene scene = world(c.directives, "", dir.path().string());
    double sum = 0;
    for (const Light& light : scene.lights()) sum += static_cast<double>(power(light));
    EXPECT_NEAR(sum / static_cast<double>(c.lamps), 5, 1e-3);
    if (c.lamps > 1) continue;
    for (const Light& light : scene.lights())
      EXPECT_FLOAT_EQ(std::get<AreaLight>(light).radiance.rgb.r, std::get<AreaLight>(scene.lights()[0]).radiance.rgb.r);
  }
}

// The power of a pattern is measured at points of the surface. By hand, the mean of this pattern is 1/2 and that of its
// alpha 3/4.
TEST(SceneLights, PowerOfAPatternIsExact) {
  const Scene scene = world(
      R"(Texture "l" "spectrum" "checkerboard" "float uscale" 10 "float vscale" 10 "rgb tex1" [2 2 2] "rgb tex2" [0 0 0]
Texture "a" "float" "bilerp" "float v00" [.5] "float v01" [.5] "float v10" [1] "float v11" [1]
AreaLightSource "diffuse" "texture L" "l" "float power" 6
Shape "bilinearmesh" "point3 P" [0 0 0  2 0 0  0 2 0  2 2 0] "texture alpha" "a"
)");
  ASSERT_EQ(scene.lights().size(), 1u);
  HashRng rng(1);
  double flux = 0;
  constexpr int photons = 1 << 16;
  for (int i = 0; i < photons; ++i)
    flux += static_cast<double>(sample_emission(scene.lights()[0], rng.next2(), rng.next2(), white)->flux[0]) / photons;
  EXPECT_NEAR(flux, 6, 0.1);
  // The brightest point of the lamp has radiance 2 times the factor that makes 6 W of 4 m² times pi times 1 times 3/4.
  float brightest = 0;
  for (int i = 0; i < 32; ++i)
    if (const auto at = test::look(scene, {0.06f * static_cast<float>(i) + 0.03f, 0.1f, 1}, {0, 0, -1});
        at && at->light)
      brightest =
          std::max(brightest, emitted(scene.lights()[0], {at->position, at->normal, at->uv}, at->normal, white)[0]);
  EXPECT_NEAR(brightest, 2 * 6 / (4 * pi * 0.75f), 0.01f);
}

TEST(SceneLights, CurvesGiveOffTheLightOfTheirArea) {
  const std::string white_lamp = R"(AreaLightSource "diffuse" "rgb L" [1 1 1])";
  const auto straight = [](const std::string& more) {
    return R"(
Shape "curve" "point3 P" [0 1 0  0.5 1 0.5  1 1 1  3 1 3] )" +
           more;
  };
  const std::string width = R"( "float width" 0.1 )", tapered = R"( "float width0" 0.16 "float width1" 0.04 )";
  const std::string tube = R"("string type" "cylinder")", ribbon = R"("string type" "ribbon" "normal N" [0 1 0 0 1 0])";
  const double length = 3 * std::numbers::sqrt2, of_tube = std::numbers::pi * 0.1 * length;
  for (const std::string& kind : {tube, std::string()})
    EXPECT_NEAR(total_power(white_lamp + straight(width + kind)) / (std::numbers::pi * of_tube), 1, 1e-4) << kind;
  EXPECT_NEAR(total_power(white_lamp + straight(width + ribbon)), std::numbers::pi * 0.1 * length, 1e-4);
  const std::string both = white_lamp + R"("bool twosided" true)";
  EXPECT_NEAR(total_power(both + straight(width + ribbon)), 2 * std::numbers::pi * 0.1 * length, 1e-4);
  // A transformation that stretches would make circles ellipses. Here the tube is only scaled.
  EXPECT_NEAR(total_power("Scale 2 2 2 " + white_lamp + straight(width + tube)), 4 * std::numbers::pi * of_tube, 2e-3);
  // The chords of a bend are shorter than its arc. The expected value for this half ring (handles of 4/3, within 0.03
  // %) is by Pappus's theorem.
  const std::string handle = std::to_string(4.0 / 3);
  const std::string bend = R"(
Shape "curve" "point3 P" [1 0 0  1 )" +
                           handle + " 0  -1 " + handle + " 0  -1 0 0]";
  EXPECT_NEAR(total_power(white_lamp + bend + width + tube) / (std::numbers::pi * std::numbers::pi * of_tube / length),
              1, 0.015);
  // `power` applies to one directive however many triangles it makes. All of them have the same radiance.
  const std::string lit = white_lamp + R"("float power" 7)";
  EXPECT_NEAR(total_power(lit + straight(tapered + tube)), 7, 1e-4);
  EXPECT_NEAR(total_power(lit + straight(tapered + tube) + straight(tapered + tube)), 14, 1e-3);
  const Scene scene = world(lit + straight(tapered + tube));
  for (const Light& light : scene.lights())
    EXPECT_FLOAT_EQ(std::get<AreaLight>(light).radiance.rgb.r, std::get<AreaLight>(scene.lights()[0]).radiance.rgb.r);
}

Rgb colour(const SpectrumCurve& curve) {
  const Spectrum s = curve.evaluate(white);
  return {s[0], s[1], s[2]};
}
void expect_rgb(const Rgb& got, const Rgb& expected) {
  EXPECT_NEAR(got.r, expected.r, 1e-4f * (1 + std::fabs(expected.r)));
  EXPECT_NEAR(got.g, expected.g, 1e-4f * (1 + std::fabs(expected.g)));
  EXPECT_NEAR(got.b, expected.b, 1e-4f * (1 + std::fabs(expected.b)));
}
template <class Kind>
Kind only_light(const std::string& directives) {
  const Scene scene = world(directives + R"(Shape "sphere" "float radius" 2
)");
  EXPECT_EQ(scene.lights().size(), 1u);
  return std::get<Kind>(scene.lights()[0]);
}

TEST(SceneLights, ScalesFollowPbrt) {
  expect_rgb(colour(only_light<EvenPointLight>(R"(LightSource "point" "rgb I" [0.6 0.5 0.4] "float scale" 2
)")
                        .profile.curve),
             {1.2f, 1, 0.8f});
  // `power` scales the light from luminance 1, which has 4 pi W at 1 W/sr.
  expect_rgb(colour(only_light<EvenPointLight>(R"(LightSource "point" "rgb I" [1 2 3] "float power" 12.5663706
)")
                        .profile.curve),
             {1, 2, 3});
  EXPECT_NEAR(luminance(colour(only_light<EvenPointLight>(R"(LightSource "point" "blackbody I" [2800] "float scale" 0.5
)")
                                   .profile.curve)),
              0.5f, 2e-3f);
  EXPECT_NEAR(luminance(colour(only_light<EvenPointLight>(R"(LightSource "point" "spectrum I" [400 7 700 3]
)")
                                   .profile.curve)),
              1, 2e-3f);
  const auto spot = only_light<SpotLight>(R"(LightSource "spot" "rgb I" [1 1 1] "float power" 10
)");
  EXPECT_NEAR(spot.power(), 10, 1e-3f);
  const auto distant = only_light<DistantLight>(
      R"(LightSource "distant" "rgb L" [1 1 1] "float illuminance" 5 "point3 from" [0 3 0] "point3 to" [0 0 0]
)");
  expect_rgb(colour(distant.irradiance), {5, 5, 5});
  EXPECT_NEAR(distant.towards.y, 1, 1e-6f);
  const auto sky = only_light<EvenSky>(R"(LightSource "infinite" "float illuminance" 3.14159265
)");
  expect_rgb(colour(sky.profile.curve), {1, 1, 1});
  EXPECT_NEAR(sky.scene.radius, 2 * std::sqrt(3.0f), 1e-3f);
  const Scene lamp = world(
      R"(AreaLightSource "diffuse" "rgb L" [1 1 1] "float power" 7 "bool twosided" true
Shape "sphere" "float radius" 2
)");
  EXPECT_NEAR(power(lamp.lights()[0]), 7, 0.01f);
  EXPECT_NEAR(lamp.largest_radiance(), 7 / (2 * pi * 16 * pi), 0.02f);
}

// The camera is at the origin. Towards +z it sees the sun, towards -z the sun's mirror image.
TEST(SceneLights, OnlyTheCameraDoesNotSeeAHiddenSun) {
  const auto seen = [](int towards, bool is_visible, const std::string& method) {
    SceneDescription description = read_pbrt_string("LookAt 0 0 0  0 0 " + std::to_string(towards) +
                                                        R"(  0 1 0
Camera "perspective" "float fov" 5
Film "rgb" "integer xresolution" 4 "integer yresolution" 4
WorldBegin
LightSource "distant" "point3 from" [0 0 1] "point3 to" [0 0 0] "float angle" 30 "rgb L" [3 3 3]
Material "conductor" "rgb reflectance" [.5 .5 .5] "float roughness" 0
Translate 0 0 -1
Shape "disk" "float radius" 2
)",
                                                    ".", "sun");
    std::get<description::DistantLight>(description.lights[0].node).visible_to_camera = is_visible;
    return test::render_image(Scene(description), test::options_for(method, 1)).at(2, 2, 1);
  };
  const float radiance = 3 / (pi * sqr(std::sin(to_radians(15.0f))));
  for (const std::string method : {"path", "vcm"}) {
    EXPECT_NEAR(seen(1, true, method), radiance, 1e-3f * radiance) << method;
    EXPECT_EQ(seen(1, false, method), 0) << method;
    EXPECT_NEAR(seen(-1, false, method), 0.5f * radiance, 1e-2f * radiance) << method;
  }
}

// The film's range depends on the distance of surfaces to point-like lights, not on the size of the world.
TEST(SceneLights, TheLargestRadianceIsThatOfTheNearestSurface) {
  const auto largest_of = [](const std::string& light, const std::string& height, const std::string& size) {
    const std::string corners = "-" + size + " 0 -" + size + "  " + size + " 0 -" + size + "  " + size + " 0 " + size +
                                "  -" + size + " 0 " + size;
    return world(R"(Shape "trianglemesh" "point3 P" [)" + corners +
                 R"(] "integer indices" [0 1 2 0 2 3]
Translate 0 )" + height +
                 " 0\nLightSource " + light)
        .largest_radiance();
  };
  const std::string point = R"("point" "rgb I" [12 12 12]
)";
  for (const std::string& light : {point, std::string(R"("spot" "point3 to" [0 -1 0]
)")}) {
    EXPECT_NEAR(largest_of(light, "10", "1e5") / largest_of(light, "10", "1e3"), 1, 1e-3) << light;
    EXPECT_NEAR(largest_of(light, "10", "1e5") / largest_of(light, "20", "1e5"), 4, 1e-2) << light;
  }
  // A light that touches a surface increases the range, but only as far as the far end of the landscape allows.
  const float far = largest_of(point, "10", "1e3") * sqr(10 / 1.4142136e5f);
  EXPECT_LT(largest_of(point, "1e-9", "1e5") / far, std::exp2(33));
}

TEST(SceneLights, TransformsMoveLights) {
  const auto spot = only_light<SpotLight>(
      R"(Translate 1 2 3 Rotate 90 1 0 0 LightSource "spot" "point3 from" [0 0 1] "point3 to" [0 0 5]
Identity
)");
  const Transform t = translate({1, 2, 3}) * rotate(90, {1, 0, 0});
  EXPECT_LT(length_squared(spot.position - t.point({0, 0, 1})), 1e-10f);
  EXPECT_GT(dot(spot.profile.axis, t.vector({0, 0, 1})), 0.99999f);
}

TEST(SceneLights, ImagesAreSquareOrPanoramasAndUpright) {
  const test::TemporaryDir folder;
  const auto write_pfm = [&](const std::string& name, int w, int h, const std::vector<float>& bottom_up) {
    std::ofstream file(folder.path() / name, std::ios::binary);
    file << "PF\n" << w << ' ' << h << "\n-1\n";
    file.write(reinterpret_cast<const char*>(bottom_up.data()), static_cast<std::streamsize>(4 * bottom_up.size()));
  };
  write_pfm("sky.pfm", 2, 2, {1, 0, 0, 0, 1, 0, 0, 0, 4, 2, 2, 2});
  write_pfm("wide.pfm", 2, 1, {1, 0, 0, 0, 1, 0});
  write_pfm("tall.pfm", 1, 2, {1, 0, 0, 0, 1, 0});
  write_pfm("broken.pfm", 1, 1, {1, infinity, 0});
  const Scene scene = world(R"(LightSource "infinite" "string filename" "sky.pfm" "float scale" 2
)",
                            "", folder.path().string());
  const auto& light = std::get<ImageSky>(scene.lights().at(0));
  EXPECT_EQ(light.profile.image->width, 2);
  EXPECT_EQ(light.profile.image->texels[0], (Rgb{0, 0, 4}));  // the last row of the file is the top
  EXPECT_EQ(light.profile.image->texels[3], (Rgb{0, 1, 0}));
  EXPECT_FLOAT_EQ(light.profile.scale, 2);
  EXPECT_EQ(scene.infinite_lights(), std::vector<std::uint32_t>{0});
  const auto load = [&](const std::string& directives) { return world(directives, "", folder.path().string()); };
  const Scene panorama = load(
      R"(LightSource "infinite" "string filename" "wide.pfm"
LightSource "infinite" "string filename" "wide.pfm"
)");
  EXPECT_EQ(std::get<ImageSky>(panorama.lights().at(0)).profile.image->layout, SphereLayout::equirectangular);
  ASSERT_EQ(panorama.warnings().size(), 1u);
  EXPECT_NE(panorama.warnings()[0].message.find("equirectangular"), std::string::npos);
  EXPECT_EQ(panorama.warnings()[0].location.line, 4);
  EXPECT_THROW(load(R"(LightSource "infinite" "string filename" "tall.pfm"
)"),
               Error);
  EXPECT_THROW(load(R"(LightSource "infinite" "string filename" "broken.pfm"
)"),
               Error);
  EXPECT_THROW(load(R"(LightSource "projection" "string filename" "broken.pfm"
)"),
               Error);
  EXPECT_THROW(load(R"(Scale 1 0 1 LightSource "infinite" "string filename" "sky.pfm"
)"),
               Error);

  // In pbrt-v4, the space of goniometric lights has y up: the image's z axis is the light's y axis.
  const Scene lamps = load(
      R"(Translate 1 2 3 LightSource "goniometric" "string filename" "sky.pfm" "rgb I" [2 2 2] "float power" 5
LightSource "projection" "string filename" "sky.pfm" "float fov" 60 "float power" 7
)");
  const auto& lamp = std::get<GoniometricLight>(lamps.lights().at(0));
  EXPECT_EQ(lamp.position, Point(1, 2, 3));
  EXPECT_GT(dot(lamp.profile.map.world_from_light({0, 0, 1}).direction, Vec3(0, 1, 0)), 0.9999f);
  EXPECT_NEAR(lamp.power() / luminance(Rgb{2, 2, 2}), 5, 1e-3f);
  EXPECT_FLOAT_EQ(lamp.profile.image->texels[0].r, 4.0f / 3);
  const auto& projector = std::get<ProjectionLight>(lamps.lights().at(1));
  EXPECT_NEAR(projector.power(), 7, 1e-3f);
  EXPECT_NEAR(projector.profile.image->half_size.x, std::tan(30 * pi / 180), 1e-5f);
}

// Environments, projectors and goniometric lights take colours in Rec.709 from a file in ACEScg.
TEST(SceneLights, ColoursOfImagesHaveTheChromaticitiesOfTheirFiles) {
  const test::TemporaryDir folder;
  folder.write("c.exr", test::exr_of(test::colour_of_one_pixel(0.5f, 0.2f, 0.1f), test::acescg));
  const auto load = [&](const std::string& directives) { return world(directives, "", folder.path().string()); };
  const Scene scene = load(
      R"(LightSource "infinite" "string filename" "c.exr"
LightSource "projection" "string filename" "c.exr"
LightSource "goniometric" "string filename" "c.exr"
)");
  constexpr Rgb expected{0.71984f, 0.16198f, 0.07750f};  // the Academy's matrix
  const auto expect = [](const Rgb& c, const Rgb& right) {
    EXPECT_NEAR(c.r, right.r, 2e-5f);
    EXPECT_NEAR(c.g, right.g, 2e-5f);
    EXPECT_NEAR(c.b, right.b, 2e-5f);
  };
  expect(std::get<ImageSky>(scene.lights().at(0)).profile.image->texels[0], expected);
  expect(std::get<ProjectionLight>(scene.lights().at(1)).profile.image->texels[0], expected);
  const float mean = (expected.r + expected.g + expected.b) / 3;
  expect(std::get<GoniometricLight>(scene.lights().at(2)).profile.image->texels[0], {mean, mean, mean});
  EXPECT_NE(test::error_text([&] {
              folder.write("nan.exr", test::exr_of(test::colour_of_one_pixel(0, NAN, 0), test::acescg));
              load(R"(LightSource "goniometric" "string filename" "nan.exr"
)");
            }).find("nan.exr\" cannot be used: its pixel (0, 0) is infinite or not a number"),
            std::string::npos);
}

TEST(SceneLights, WhatCannotEmitSaysSo) {
  const auto warned = [](const Scene& scene, const std::string& word) {
    for (const auto& w : scene.warnings())
      if (w.message.find(word) != std::string::npos) return true;
    return false;
  };
  const Scene curve = world(std::string(area_light) + R"(Shape "curve" "point3 P" [0 0 0 1 0 0 1 1 0 0 1 0]
)");
  EXPECT_TRUE(warned(curve, "triangles"));
  const Scene nothing = world(R"(Material "interface"
)" + std::string(area_light) +
                              R"(Shape "curve" "point3 P" [0 0 0 1 0 0 1 1 0 0 1 0]
)");
  EXPECT_TRUE(nothing.lights().empty());
  EXPECT_TRUE(warned(nothing, "interface"));
  const Scene moving = world(
      "ActiveTransform EndTime Translate 1 0 0 ActiveTransform All\n" + std::string(area_light) + R"(Shape "sphere"
)",
      "TransformTimes 0 1\n");
  ASSERT_EQ(moving.lights().size(), 1u);
  EXPECT_TRUE(warned(moving, "shutter"));
  const auto& light = std::get<AreaLight>(moving.lights()[0]);
  EXPECT_NEAR(std::get<SphereEmitter>(light.shape).centre.x, 0.5f, 1e-5f);
  const auto at = test::look(moving, {0.8f, 0, 5}, {0, 0, -1}, 0.8f);
  ASSERT_TRUE(at);
  EXPECT_EQ(at->light, 0u);
}

TEST(SceneLights, MayNotBeSoBrightThatNumbersOverflow) {
  const auto error_of = [](const std::string& directives) { return test::error_text([&] { world(directives); }); };
  const std::string message = "the light's power exceeds 1e32 W: it is too bright, or it or the scene is too large";
  const std::string lamp = std::string(area_light) + R"(Shape "bilinearmesh" "point3 P" )";
  EXPECT_EQ(error_of(lamp + "[0 0 0 1 0 0 0 1e15 0 1 1 0]\n"), "no error");
  EXPECT_EQ(error_of(lamp + "[0 0 0 1 0 0 0 1e38 0 1 1 0]\n"), "test scene:5:1: " + message);
  EXPECT_EQ(error_of(R"(LightSource "point" "rgb I" [9 9 9] "float scale" 1e38
)"),
            "test scene:4:1: " + message);
  const std::string sun = R"(LightSource "distant" "float scale" 1e24
)";
  EXPECT_EQ(error_of(sun), "no error");
  EXPECT_EQ(error_of(sun + R"(Shape "sphere" "float radius" 1e5
)"),
            "test scene:4:1: " + message);
  const std::string bright =
      "the emission is too bright: its radiance, or that of a white surface near the light, exceeds 1e25 W/(m² sr)";
  const std::string weak = R"(LightSource "infinite"
)";
  EXPECT_EQ(error_of(weak + R"(LightSource "infinite" "rgb L" [0 2e25 0]
)"),
            "test scene:5:1: " + bright);
  EXPECT_EQ(error_of(R"(AreaLightSource "diffuse" "rgb L" [1e38 3 1] "bool twosided" true
Shape "curve" "float width" 1e-8 "point3 P" [0 0 0 1 0 0 1 1 0 0 1 0]
)" + weak),
            "test scene:5:1: " + bright);
  // An infinite medium is not a light.
  EXPECT_EQ(error_of(R"(MakeNamedMedium "m" "string type" "homogeneous" "rgb Le" [2e25 0 0]
MediumInterface "" "m" Shape "sphere"
)"),
            "test scene:4:1: " + bright);
  // The brightness of a point light is measured by the surfaces it lights.
  const std::string near = R"(LightSource "point" "rgb I" [1e24 0 0]
)";
  EXPECT_EQ(error_of(near + weak), "no error");
  EXPECT_EQ(error_of(weak + near + R"(Translate 0 0 .2 Shape "disk" "float radius" 10
)"),
            "test scene:5:1: " + bright);
}

}  // namespace
}  // namespace lanthorn::light_test
