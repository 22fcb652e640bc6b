// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "light/ray_lights.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "math/hash.h"

namespace lanthorn::ray_lights_test {
namespace {

const SpectrumCurve one = SpectrumCurve::constant(1);

SpotLight spot(const Point& position, const Vec3& axis, float degrees) {
  const float angle = degrees * pi / 180;
  return {position, SpotProfile(normalize(axis), one, 0.9f * angle, angle)};
}

Vec3 random_vector(HashRng& rng) { return 2.0f * Vec3(rng.next(), rng.next(), rng.next()) - 1.0f; }

std::vector<Segment> random_segments(int count) {
  HashRng rng(7);
  std::vector<Segment> segments;
  for (int i = 0; i < count; ++i)
    segments.push_back({2.0f * random_vector(rng), normalize(random_vector(rng)), i % 3 == 0 ? 1 + rng.next() : 6});
  return segments;
}

// Spot lights with narrow cones, wide ones, and ones wider than a hemisphere; a point light; and an area light, which
// has no interval.
std::vector<Light> some_lights() {
  return {spot({-1, 0, 0}, {1, 0.1f, 0}, 8), AreaLight{}, spot({0, 1, 0}, {0.2f, -1, 0.3f}, 60),
          spot({0.5f, 0, 1}, {0, 0, -1}, 120), EvenPointLight{{0.3f, -0.4f, 0.2f}, {one}}};
}

TEST(RayLights, DensitiesIntegrateToOne) {
  const RayLights lights{some_lights()};
  for (const Segment& segment : random_segments(30)) {
    const double strength = lights.strength(segment);
    ASSERT_GT(strength, 0);
    constexpr int steps = 40'000;
    double sum = 0;
    for (int i = 0; i < steps; ++i)
      for (const std::uint32_t light : {0u, 1u, 2u, 3u, 4u})
        sum += static_cast<double>(segment.length) / steps *
               static_cast<double>(
                   lights.pdf(segment, strength, light, segment.length * (static_cast<float>(i) + 0.5f) / steps));
    EXPECT_NEAR(sum, 1, 2e-3);
  }
}

// The interval of the segment with a density is the one that the light illuminates.
TEST(RayLights, DensitiesAreThereWhereTheLightIs) {
  const std::vector<Light> all = some_lights();
  const RayLights lights{all};
  const Wavelengths w = Wavelengths::rgb(0.5f);
  int lit = 0, dark = 0;
  for (const Segment& segment : random_segments(300)) {
    const double strength = lights.strength(segment);
    for (const std::uint32_t light : {0u, 2u, 3u, 4u})
      for (int i = 0; i < 50; ++i) {
        const float distance = segment.length * (static_cast<float>(i) + 0.5f) / 50;
        const auto seen = sample_direct(all[light], segment.origin + distance * segment.direction, Vec2(0.5f), w);
        const bool has_density = lights.pdf(segment, strength, light, distance) > 0;
        // Wide cones are not considered.
        EXPECT_EQ(has_density, seen.has_value() || light == 3) << light << ' ' << distance;
        ++(seen ? lit : dark);
      }
  }
  EXPECT_GT(lit, 1000);
  EXPECT_GT(dark, 1000);
}

TEST(RayLights, SamplesHaveTheirDensity) {
  const RayLights lights{some_lights()};
  HashRng rng(3);
  for (const Segment& segment : random_segments(10)) {
    const double strength = lights.strength(segment);
    // The mean of a function divided by the density is the function's integral: here of the distance, over all lights.
    double mean = 0, expected = 0;
    constexpr int count = 40'000;
    for (int i = 0; i < count; ++i) {
      const auto s = lights.sample(segment, strength, (static_cast<float>(i) + rng.next()) / count, rng.next());
      ASSERT_TRUE(s);
      EXPECT_FLOAT_EQ(s->pdf, lights.pdf(segment, strength, s->light, s->distance));
      mean += static_cast<double>(s->distance) / count;
    }
    constexpr int steps = 40'000;
    for (int i = 0; i < steps; ++i) {
      const float distance = segment.length * (static_cast<float>(i) + 0.5f) / steps;
      for (const std::uint32_t light : {0u, 2u, 3u, 4u})
        expected += static_cast<double>(segment.length) / steps * static_cast<double>(distance) *
                    static_cast<double>(lights.pdf(segment, strength, light, distance));
    }
    EXPECT_NEAR(mean, expected, 0.02);
  }
}

TEST(RayLights, ManyLightsAreNotLookedAt) {
  EXPECT_TRUE(RayLights{std::vector<Light>(65, EvenPointLight{{0, 0, 0}, {one}})}.empty());
  EXPECT_FALSE(RayLights{std::vector<Light>(64, EvenPointLight{{0, 0, 0}, {one}})}.empty());
}

}  // namespace
}  // namespace lanthorn::ray_lights_test
