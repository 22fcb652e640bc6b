// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Shadow rays end exactly at the lamp: they miss no occluder in front of it, and no lamp shadows itself, at any size
// and position.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "light/light.h"
#include "support/scene_text.h"

namespace lanthorn::shadow_rays_test {
namespace {

struct Lamp {
  const char* name;
  const char* shape;  // about 1 in size, centred at the origin
  bool two_sided = true;
  float least_cosine = 0;  // below this, a curved lamp may hide parts of itself
};

const std::vector<Lamp> lamps = {
    {"triangle", R"(Shape "trianglemesh" "point3 P" [-.5 0 -.5 .5 0 -.5 .3 0 .5] "integer indices" [0 1 2])"},
    {"two triangles",
     R"(Shape "trianglemesh" "point3 P" [-.5 0 -.5 .5 0 -.5 .5 0 .5 -.5 0 .5] "integer indices" [0 1 2 0 2 3])"},
    {"strip",
     R"(Shape "trianglemesh" "point3 P" [-.5 0 -.001 .5 0 -.001 .5 0 .001 -.5 0 .001] "integer indices" [0 1 2 0 2 3])"},
    {"sliver", R"(Shape "trianglemesh" "point3 P" [-.5 0 -.001 .5 0 -.001 .2 .3 .001] "integer indices" [0 1 2])"},
    {"twisted patch", R"(Shape "bilinearmesh" "point3 P" [-.5 0 -.5 .5 .1 -.5 -.5 .1 .5 .5 0 .5])", true, .4f},
    {"ball", R"(Shape "sphere" "float radius" .5)", false},
    {"cap", R"(Shape "sphere" "float radius" .5 "float zmin" .2 "float phimax" 200)", false},
    {"disk", R"(Shape "disk" "float radius" .5 "float innerradius" .1)"},
    {"tube", R"(Shape "cylinder" "float radius" .2 "float zmin" -.5 "float zmax" .5)", false},
};

// Shadow rays from points in all directions and at many distances, and how many of them the lamp itself blocks.
struct Shadows {
  int rays = 0, blocked = 0;
  float largest_error = 0;  // of sampled points, relative to the lamp's size plus its middle's distance from the origin
};

Shadows shadows_of(const Lamp& lamp, float size, const Point& middle, bool is_instance) {
  const std::string place = fmt::format("Translate {} {} {} Rotate 37 1 2 3 Scale {} {} {}\n", middle.x, middle.y,
                                        middle.z, size, is_instance ? .2f * size : size, is_instance ? 3 * size : size);
  const std::string shape = fmt::format(R"(AreaLightSource "diffuse" "bool twosided" {}
{}
)",
                                        lamp.two_sided ? "true" : "false", lamp.shape);
  const Scene scene = test::world(is_instance ? R"(ObjectBegin "lamp"
)" + shape + "ObjectEnd\n" + place + R"(ObjectInstance "lamp")"
                                              : place + shape);
  HashRng rng(7);
  Shadows result;
  for (const float distance : {.02f, 1.0f, 30.0f, 1e3f, 1e5f})
    for (int i = 0; i < 1000; ++i) {
      const Point from = middle + distance * size * sample_uniform_sphere(rng.next2());
      const auto light = static_cast<std::size_t>(rng.next() * static_cast<float>(scene.lights().size()));
      const auto l = sample_direct(scene.lights()[light], from, rng.next2(), test::white);
      if (!l || std::fabs(dot(l->wi, l->normal)) < lamp.least_cosine) continue;
      // Points that single precision cannot distinguish from a point on the lamp.
      if (l->distance < 100 * (l->position_error + 0x1p-23f * max_component(abs(from)))) continue;
      ++result.rays;
      const Ray ray = segment_to({l->position, l->normal, l->position_error}, from, l->wi, 0);
      result.blocked += scene.visible(ray) ? 0 : 1;
      const float near = size * (is_instance ? 3.0f : 1.0f) + max_component(abs(middle));
      if (distance <= 1) result.largest_error = std::max(result.largest_error, l->position_error / near);
    }
  return result;
}

class ShadowRays : public testing::TestWithParam<Lamp> {};

TEST_P(ShadowRays, NoLampShadowsItself) {
  for (const float size : {1e-3f, 1.0f, 1e3f})
    for (const float away : {0.0f, 10.0f, 1e4f})
      for (const bool is_instance : {false, true}) {
        const Point middle(away, .3f * away, -.7f * away);
        if (is_instance && size < 1e-6f * away) continue;  // its transform is singular in single precision
        const Shadows s = shadows_of(GetParam(), size, middle, is_instance);
        const std::string where = fmt::format("size {}, {} m away{}", size, away, is_instance ? ", an instance" : "");
        if (size >= 1e-4f * away) {
          EXPECT_GT(s.rays, 500) << where;
        }
        EXPECT_EQ(s.blocked, 0) << where << ", of " << s.rays;
        // An occluder a few rounding errors in front of a lamp is seen.
        EXPECT_LT(s.largest_error, is_instance ? 1e-3f : 2e-4f) << where;
      }
}

INSTANTIATE_TEST_SUITE_P(Lamps, ShadowRays, testing::ValuesIn(lamps), [](const auto& lamp) {
  std::string name = lamp.param.name;
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
});

TEST(ShadowRays, EndAtPointsInSpaceExactly) {
  const Scene scene = test::world(R"(Shape "disk" "float radius" 10)");
  // A plate .1 mm before the end of a ray of 1 km.
  const Ray ray = segment_to({Point(0, 0, -1e-4f)}, {0, 0, 1000}, {0, 0, -1}, 0);
  EXPECT_FALSE(scene.visible(ray));
  EXPECT_TRUE(scene.visible(segment_to({Point(0, 0, 1e-4f)}, {0, 0, 1000}, {0, 0, -1}, 0)));
}

TEST(ShadowRays, GoOnBehindAPaneToTheSameEnd) {
  const Scene scene = test::world(R"(
    Material "thindielectric" Shape "disk" "float radius" 10
    AttributeBegin Translate 0 0 -.001 Material "diffuse" Shape "disk" "float radius" 10 AttributeEnd)");
  const Ray whole = segment_to({Point(3, 1, -5e-4f)}, {-100, 7, 900}, {0, 0, -1}, 0);
  const auto pane = scene.intersect(whole, test::white);
  ASSERT_TRUE(pane);
  const Ray rest = continue_segment(*pane, whole);
  EXPECT_GT(rest.t_max, 0);
  EXPECT_TRUE(scene.visible(rest));
  const Point end = rest.origin + rest.t_max * rest.direction;
  EXPECT_NEAR(end.z, -5e-4f, 1e-4f);
}

}  // namespace
}  // namespace lanthorn::shadow_rays_test
