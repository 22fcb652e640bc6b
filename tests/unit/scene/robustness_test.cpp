// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Scenes at the limits of single precision. What cannot be represented is left out with a warning, and no ray that
// Embree cannot handle reaches it (Debian's build of Embree would abort).
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "support/scene_text.h"

namespace lanthorn::robustness_test {
namespace {

using test::look;
using test::world;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

std::string instances_of_triangle(const std::string& transforms) {
  return R"(ObjectBegin "o"
Shape "trianglemesh" "point3 P" [-1 -1 0 1 -1 0 0 1 0] "integer indices" [0 1 2]
ObjectEnd
)" + transforms;
}

std::string instance(const std::string& transform) {
  return "AttributeBegin\n" + transform + R"(
ObjectInstance "o"
AttributeEnd
)";
}

// The warnings that say that something is left out, one per line.
std::string left_out(const Scene& scene) {
  std::string found;
  for (const description::Warning& w : scene.warnings())
    if (w.message.find("left out") != std::string::npos) found += w.message + "\n";
  return found;
}

TEST(Robustness, InstancesTooSmallToMapRaysAreLeftOutAndCounted) {
  for (const char* scale : {"0", "1e-18", "1e-20", "1e-30", "1e-38"}) {
    const std::string s(scale);
    const Scene scene = world(instances_of_triangle(instance("Scale " + s + " " + s + " " + s) +
                                                    instance("Scale " + s + " 1 1") + instance("Translate 0 0 1")));
    EXPECT_EQ(left_out(scene).substr(0, 24), "2 shapes or instances, t") << s;
    const auto hit = look(scene, {0, 0, 5}, {0, 0, -1});
    ASSERT_TRUE(hit) << s;
    EXPECT_FLOAT_EQ(hit->position.z, 1) << s;
  }
}

TEST(Robustness, SmallInstancesAreMetFromAnywhere) {
  // Embree transforms rays in single precision: from far away, their origins in the space of small instances would
  // overflow.
  for (const float scale : {1e-3f, 1e-6f, 1e-9f, 1e-12f, 1e-15f, 1e-17f}) {
    std::ostringstream text;
    text << "Scale " << scale << ' ' << scale << ' ' << scale;
    const Scene scene = world(instances_of_triangle(instance(text.str())));
    EXPECT_EQ(left_out(scene), "") << scale;
    for (const float distance : {1.0f, 1e3f, 1e9f, 1e15f, 1e25f}) (void)look(scene, {0, 0, distance}, {0, 0, -1});
    const auto near = look(scene, {0, 0, 10 * scale}, {0, 0, -1});
    ASSERT_TRUE(near) << scale;
    EXPECT_FLOAT_EQ(near->normal.z, 1) << scale;
  }
}

TEST(Robustness, LargeInstancesOfSmallShapesKeepTheirNormals) {
  for (const float size : {1e-6f, 1e-9f, 1e-12f}) {
    std::ostringstream text;
    text << R"(ObjectBegin "o"
Shape "trianglemesh" "point3 P" [)"
         << -size << ' ' << -size << " 0 " << size << ' ' << -size << " 0 0 " << size
         << R"( 0] "integer indices" [0 1 2]
ObjectEnd
Scale )" << 1 / size
         << ' ' << 1 / size << ' ' << 1 / size << R"(
ObjectInstance "o"
)";
    const auto hit = look(world(text.str()), {0, 0, 3}, {0, 0, -1});
    ASSERT_TRUE(hit) << size;
    EXPECT_FLOAT_EQ(std::fabs(hit->normal.z), 1) << size;
    EXPECT_FLOAT_EQ(std::fabs(hit->shading.n.z), 1) << size;
  }
}

TEST(Robustness, SingularShapesOfEveryKindAreLeftOutInOneWarning) {
  const Scene scene = world(R"(
    ObjectBegin "o" Shape "sphere" ObjectEnd
    AttributeBegin Translate 0 0 -3 Shape "sphere" AttributeEnd
    Scale 0 0 0
    Shape "sphere"
    Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 0 1 0] "integer indices" [0 1 2]
    Shape "bilinearmesh" "point3 P" [0 0 0 1 0 0 0 1 0 1 1 1]
    Shape "curve" "point3 P" [0 0 0 1 0 0 1 1 0 2 1 0]
    AreaLightSource "diffuse"
    Shape "disk"
    ObjectInstance "o"
  )");
  EXPECT_EQ(left_out(scene).substr(0, 24), "6 shapes or instances, t");
  EXPECT_TRUE(look(scene, {0, 0, 5}, {0, 0, -1}));
  EXPECT_TRUE(scene.lights().empty());
}

TEST(Robustness, CurvesOfNoSizeAreBuilt) {
  for (const char* kind : {"flat", "cylinder", "ribbon"})
    for (const char* end : {"0 0 0", "1e-40 0 0", "0 1e-37 0"}) {
      const std::string point(end);
      EXPECT_FALSE(look(world(R"(Shape "curve" "string type" ")" + std::string(kind) + R"(" "float width" 0 )" +
                              (kind == std::string("ribbon") ? R"("normal N" [0 0 1 0 0 1] )" : "") +
                              R"("point3 P" [0 0 0 )" + point + " " + point + " " + point + "]"),
                        {0, 0, 5}, {0.1f, 0, -1}));
    }
}

TEST(Robustness, MotionThroughASingularMapIsFollowedWhereItCanBe) {
  const Scene scene = world(instances_of_triangle(R"(ActiveTransform EndTime
Scale -1 -1 -1
ActiveTransform All
ObjectInstance "o"
)"),
                            R"(Camera "perspective" "float shutterclose" 1
)");
  for (int i = 0; i <= 100; ++i) {
    const auto hit = scene.intersect({{0.01f, 0, 5}, {0, 0, -1}, infinity, 0.01f * static_cast<float>(i)}, test::white);
    EXPECT_TRUE(!hit || std::isfinite(hit->normal.z)) << i;
  }
}

TEST(Robustness, RaysThatAreNotValidHitNothingAndNoLightArrivesAlongThem) {
  const Scene scene = world(R"(Shape "sphere"
)" + instances_of_triangle(instance("Scale 2 2 2")));
  const Direction forward(0, 0, -1);
  const Point from(0, 0, 5);
  const std::vector<Ray> invalid{{{nan, 0, 5}, forward, infinity, 0},      {{0, 0, infinity}, forward, infinity, 0},
                                 {{0, 0, 2e18f}, forward, infinity, 0},    {from, {nan, 0, -1}, infinity, 0},
                                 {from, {0, -infinity, -1}, infinity, 0},  {from, forward, nan, 0},
                                 {{1.8e18f, 0, 5}, forward, infinity, nan}};
  for (std::size_t i = 0; i < invalid.size(); ++i) {
    EXPECT_FALSE(scene.intersect(invalid[i], test::white)) << i;
    EXPECT_FALSE(scene.visible(invalid[i])) << i;
  }
  // Accepted, although useless.
  for (const Ray& ray : {Ray{from, {0, 0, 0}, infinity, 0}, Ray{from, forward, -1, 0}, Ray{from, {0, 0, 1e-42f}, 1, 0}})
    (void)scene.intersect(ray, test::white);
}

TEST(Robustness, NormalsOfAnyLengthAreNormalised) {
  for (const char* length : {"1e-30", "1e-12", "1e12", "1e30"}) {
    const std::string n = " 0 0 " + std::string(length);
    const Scene scene = world(R"(Shape "trianglemesh" "point3 P" [-1 -1 0 1 -1 0 0 1 0] "normal N" [)" + n + n + n +
                              R"(] "integer indices" [0 1 2]
)");
    const auto hit = look(scene, {0, 0, 5}, {0, 0, -1});
    ASSERT_TRUE(hit);
    EXPECT_FLOAT_EQ(hit->shading.n.z, 1) << length;
  }
}

// Tracking takes one step per mean free path of the densest part, for the whole length of a flight.
TEST(Robustness, MediaOfTooManyMeanFreePathsAreRefused) {
  const auto load = [](const std::string& transform, const std::string& parameters) {
    return world(transform + R"(
MakeNamedMedium "m" )" +
                 parameters + "\n");
  };
  const std::string grid = R"("integer nx" 2 "integer ny" 1 "integer nz" 1 )";
  const auto uniform = [&](const std::string& sigma_a) {
    return R"("string type" "uniformgrid" "rgb sigma_s" [2 2 2] "rgb sigma_a" )" + sigma_a + grid +
           R"("float density" [0 1] )";
  };
  const std::string colours =
      R"("string type" "rgbgrid" "rgb sigma_a" [0 0 1 0 0 1] "rgb sigma_s" [1 1 1 0 0 0] )" + grid;
  EXPECT_NO_THROW(load("", uniform("[1 1 1e5]")));
  EXPECT_NO_THROW(load("Scale 1000 1000 1000", uniform("[1 1 1]")));
  EXPECT_NO_THROW(load("", colours + R"("float scale" 1e4)"));
  EXPECT_NO_THROW(load("", R"("string type" "homogeneous" "rgb sigma_a" [1 1 1e30])"));  // has no steps
  EXPECT_THROW(load("", uniform("[1 1 4294967296]")), Error);
  EXPECT_THROW(load("", uniform("[1 1 1]") + R"("float scale" 1e7)"), Error);
  EXPECT_THROW(load("Scale 1 1e9 1", uniform("[1 1 1]")), Error);
  EXPECT_THROW(load("", R"("string type" "cloud" "rgb sigma_a" [0 0 1e8])"), Error);
  EXPECT_THROW(load("", colours + R"("float scale" 1e7)"), Error);
}

}  // namespace
}  // namespace lanthorn::robustness_test
