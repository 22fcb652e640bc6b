// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "camera/camera.h"
#include "math/hash.h"

namespace lanthorn::camera_test {
namespace {

constexpr int width = 64, height = 48;

struct NamedCamera {
  std::string name;
  description::Camera camera;
};

std::vector<NamedCamera> cameras() {
  const AnimatedTransform placed(look_at({1, 2, 3}, {0.5f, 0, -2}, {0.1f, 1, 0}).inverted());
  const AnimatedTransform mirrored(placed.start * scale({-1, 1, 1}));
  const AnimatedTransform moving(placed.start, translate({0.4f, -0.1f, 0.2f}) * placed.start * rotate(25, {0, 1, 0}), 0,
                                 1);
  std::vector<NamedCamera> list;
  const auto add_all = [&](const std::string& motion, const AnimatedTransform& transform) {
    const auto add = [&](const char* name, auto node) {
      description::Camera camera;
      camera.node = node;
      camera.camera_to_world = transform;
      list.push_back({motion + " " + name, camera});
    };
    add("perspective", description::PerspectiveCamera{50, 0, 1e6f});
    add("thin lens", description::PerspectiveCamera{50, 0.2f, 3});
    add("orthographic", description::OrthographicCamera{0, 1e6f});
    add("orthographic lens", description::OrthographicCamera{0.2f, 3});
    add("equirectangular", description::SphericalCamera{description::SphericalMapping::equirectangular});
    add("equal-area", description::SphericalCamera{description::SphericalMapping::equal_area});
  };
  add_all("placed", placed);
  add_all("mirrored", mirrored);
  add_all("moving", moving);
  return list;
}

TEST(SceneCamera, ConnectionsFindTheRasterTheRayCameFrom) {
  for (const NamedCamera& c : cameras()) {
    SCOPED_TRACE(c.name);
    const Camera camera(c.camera, width, height);
    HashRng rng(1);
    for (int i = 0; i < 500; ++i) {
      const Vec2 raster(rng.next() * width, rng.next() * height), u_lens = rng.next2();
      const float time = rng.next(), distance = 0.5f + 20 * rng.next();
      const Ray ray = camera.sample_ray(raster, u_lens, time).ray;
      EXPECT_NEAR(length_squared(ray.direction), 1, 1e-5f);
      EXPECT_EQ(ray.time, time);
      const auto back = camera.connect(ray.origin + distance * ray.direction, u_lens, time);
      if (!back) {  // only rounding at the film's border can lose it
        EXPECT_TRUE(raster.x < 0.01f || raster.y < 0.01f || raster.x > width - 0.01f || raster.y > height - 0.01f);
        continue;
      }
      EXPECT_NEAR(back->raster.x, raster.x, 2e-3f);
      EXPECT_NEAR(back->raster.y, raster.y, 2e-3f);
      EXPECT_LT(length_squared(back->lens_point - ray.origin), 1e-9f);
      EXPECT_GT(dot(back->towards, -ray.direction), 0.99999f);
      EXPECT_NEAR(back->distance, distance, 1e-4f * distance);
    }
  }
}

// pdf * |d direction / d raster| is the density of raster positions, 1 / pixels; for the orthographic camera without
// lens the same holds for positions.
TEST(SceneCamera, DensitiesAreTheInverseOfTheFilmsStretch) {
  for (const NamedCamera& c : cameras()) {
    SCOPED_TRACE(c.name);
    const Camera camera(c.camera, width, height);
    const bool by_position = c.name.find("orthographic") != std::string::npos;
    HashRng rng(2);
    for (int i = 0; i < 200; ++i) {
      const Vec2 raster(2 + rng.next() * (width - 4), 2 + rng.next() * (height - 4)), u_lens = rng.next2();
      const float time = rng.next();
      constexpr float h = 0.02f;
      const auto ray = [&](float dx, float dy) { return camera.sample_ray(raster + Vec2(dx, dy), u_lens, time).ray; };
      const auto difference = [&](const Ray& a, const Ray& b) {
        return glm::dvec3(by_position ? a.origin : a.direction) - glm::dvec3(by_position ? b.origin : b.direction);
      };
      const double stretch =
          glm::length(glm::cross(difference(ray(h, 0), ray(-h, 0)), difference(ray(0, h), ray(0, -h)))) / (4 * h * h);
      const CameraPdf pdf = camera.pdf(ray(0, 0));
      const double density = by_position ? pdf.position : pdf.direction;
      EXPECT_NEAR(stretch * density * width * height, 1, 0.02);
    }
  }
}

TEST(SceneCamera, LensDensitiesAreTheInverseOfTheLensesStretch) {
  for (const NamedCamera& c : cameras()) {
    if (c.name.find("lens") == std::string::npos) continue;
    SCOPED_TRACE(c.name);
    const Camera camera(c.camera, width, height);
    const bool orthographic = c.name.find("orthographic") != std::string::npos;
    constexpr float h = 1e-3f;
    const Vec2 u(0.7f, 0.4f), raster(20, 30);
    const auto ray = [&](float dx, float dy) { return camera.sample_ray(raster, u + Vec2(dx, dy), 0).ray; };
    const auto difference = [&](const Ray& a, const Ray& b) {
      return glm::dvec3(orthographic ? a.direction : a.origin) - glm::dvec3(orthographic ? b.direction : b.origin);
    };
    const double stretch =
        glm::length(glm::cross(difference(ray(h, 0), ray(-h, 0)), difference(ray(0, h), ray(0, -h)))) / (4 * h * h);
    const CameraPdf pdf = camera.pdf(ray(0, 0));
    EXPECT_NEAR(stretch * (orthographic ? pdf.direction : pdf.position), 1, 0.02);
  }
}

TEST(SceneCamera, FieldOfViewSpansTheShorterSide) {
  description::Camera description;
  description.node = description::PerspectiveCamera{60, 0, 1e6f};
  const float half = std::tan(pi / 6);
  const auto slope = [](const Camera& camera, const Vec2& raster) {
    const Vec3 d = camera.sample_ray(raster, {0.5f, 0.5f}, 0).ray.direction;
    return Vec2(d.x / d.z, d.y / d.z);
  };
  const Camera wide(description, 200, 100);
  EXPECT_NEAR(slope(wide, {100, 0}).y, half, 1e-5f);  // the first row is the top
  EXPECT_NEAR(slope(wide, {200, 50}).x, 2 * half, 1e-5f);
  const Camera tall(description, 100, 200);
  EXPECT_NEAR(slope(tall, {0, 100}).x, -half, 1e-5f);
  EXPECT_NEAR(slope(tall, {50, 200}).y, -2 * half, 1e-5f);
  description.frame_aspect_ratio = 1.0f;
  EXPECT_NEAR(slope(Camera(description, 200, 100), {200, 50}).x, half, 1e-5f);
  description.screen_window = {{-0.5f, 1, -2, 2}};
  const Camera window(description, 200, 100);
  EXPECT_NEAR(slope(window, {0, 0}).x, -0.5f * half, 1e-5f);
  EXPECT_NEAR(slope(window, {200, 100}).x, half, 1e-5f);
  EXPECT_NEAR(slope(window, {0, 0}).y, 2 * half, 1e-5f);
}

TEST(SceneCamera, LensRaysMeetInTheFocalPlane) {
  description::Camera description;
  description.node = description::PerspectiveCamera{60, 0.3f, 4};
  const Camera camera(description, width, height);
  const auto at_focus = [&](const Vec2& u_lens) {
    const Ray ray = camera.sample_ray({10, 7}, u_lens, 0).ray;
    return ray.origin + ray.direction * (4 / ray.direction.z);
  };
  const Point sharp = at_focus({0.5f, 0.5f});
  EXPECT_NEAR(sharp.z, 4, 1e-5f);
  for (const Vec2& u : {Vec2(0.1f, 0.2f), Vec2(0.9f, 0.3f), Vec2(0.4f, 0.99f)})
    EXPECT_LT(length_squared(at_focus(u) - sharp), 1e-10f);
}

TEST(SceneCamera, SphericalDirectionsAreYUp) {
  description::Camera description;
  description.node = description::SphericalCamera{description::SphericalMapping::equirectangular};
  const Camera equirectangular(description, 400, 200);
  const auto direction = [](const Camera& c, const Vec2& raster) { return c.sample_ray(raster, {}, 0).ray.direction; };
  EXPECT_NEAR(direction(equirectangular, {100, 0.01f}).y, 1, 1e-4f);
  EXPECT_NEAR(direction(equirectangular, {0, 100}).x, 1, 1e-5f);
  EXPECT_NEAR(direction(equirectangular, {100, 100}).z, 1, 1e-5f);
  description.node = description::SphericalCamera{description::SphericalMapping::equal_area};
  EXPECT_NEAR(direction(Camera(description, 200, 200), {100, 100}).y, 1, 1e-5f);
}

TEST(SceneCamera, PointsOutOfViewAreNotConnected) {
  const description::Camera description;
  const Camera camera(description, width, height);
  EXPECT_FALSE(camera.connect({0, 0, -1}, {0.5f, 0.5f}, 0));
  EXPECT_FALSE(camera.connect({0, 1.001f, 1}, {0.5f, 0.5f}, 0));
  EXPECT_TRUE(camera.connect({0, 0.999f, 1}, {0.5f, 0.5f}, 0));
  // The filter reaches slightly beyond the border.
  EXPECT_TRUE(Camera(description, width, height, {2, 2}).connect({0, 1.001f, 1}, {0.5f, 0.5f}, 0));
}

TEST(SceneCamera, ShutterMapsTime) {
  description::Camera description;
  description.shutter_open = 0.25f;
  description.shutter_close = 0.75f;
  const Camera camera(description, width, height);
  EXPECT_FLOAT_EQ(camera.time(0), 0.25f);
  EXPECT_FLOAT_EQ(camera.time(0.5f), 0.5f);
}

TEST(SceneCamera, RejectsWhatCannotBe) {
  description::Camera flat;
  flat.camera_to_world = AnimatedTransform(scale({1, 0, 1}));
  EXPECT_THROW(Camera(flat, width, height), Error);
  description::Camera wide;
  wide.node = description::PerspectiveCamera{180, 0, 1};
  EXPECT_THROW(Camera(wide, width, height), Error);
  EXPECT_THROW(Camera(description::Camera{}, 0, height), Error);
}

}  // namespace
}  // namespace lanthorn::camera_test
