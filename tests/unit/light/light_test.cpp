// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "light/light.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <numbers>
#include <numeric>

#include "light/brightness.h"
#include "light/emission_guide.h"
#include "light/light_sampler.h"
#include "light/light_texels.h"
#include "math/hash.h"
#include "math/octahedral.h"
#include "support/test_lights.h"

namespace lanthorn::test {
namespace {

const Wavelengths rgb = Wavelengths::rgb(0.5f);

double to_double(float x) { return static_cast<double>(x); }
float colour_luminance(const Spectrum& s) { return luminance(Rgb{s[0], s[1], s[2]}); }

/// Points around, near, inside and far away from the test surfaces.
std::vector<Point> receivers() {
  return {{2, 1, 3}, {-1.5f, 2, -2}, {0.3f, 0.2f, 0.1f}, {0, -3, 0.2f}, {60, -80, 20}, {1.2f, 0.1f, 0.1f}};
}

TEST(Distribution, PiecewiseConstant1d) {
  const std::vector<float> values{0, 3, 0, 1, 4, 0};
  const PiecewiseConstant1d d(values);
  EXPECT_FLOAT_EQ(d.integral(), 8.0f / 6);
  std::vector<int> counts(6);
  constexpr int n = 48000;
  for (int i = 0; i < n; ++i) {
    const auto s = d.sample((static_cast<float>(i) + 0.5f) / n);
    ASSERT_TRUE(s);
    ASSERT_EQ(s->cell, static_cast<std::size_t>(s->x * 6));
    ASSERT_FLOAT_EQ(s->pdf, d.pdf(s->x));
    ++counts[s->cell];
  }
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(counts[i], values[i] / 8 * n, 2);
  EXPECT_EQ(d.sample(0)->cell, 1u);
  EXPECT_EQ(d.sample(one_minus_epsilon)->cell, 4u);
  EXPECT_FALSE(PiecewiseConstant1d(std::vector<float>{0, 0}).sample(0.5f));
}

TEST(Distribution, PiecewiseConstant2d) {
  const std::vector<float> values{1, 0, 2, 0, 0, 0, 0, 5, 4, 3, 0, 1};
  const PiecewiseConstant2d d(values, 3, 4);
  EXPECT_FLOAT_EQ(d.integral(), 16.0f / 12);
  std::vector<int> counts(12);
  constexpr int n = 400;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const auto s = d.sample((Vec2(i, j) + 0.5f) / static_cast<float>(n));
      ASSERT_TRUE(s);
      ASSERT_FLOAT_EQ(s->pdf, d.pdf_of_cell(s->cell));
      ASSERT_EQ(d.cell(s->at), s->cell);
      ++counts[s->cell];
    }
  for (std::size_t i = 0; i < 12; ++i) EXPECT_NEAR(counts[i], values[i] / 16 * n * n, 400) << i;
  double mass = 0;
  for (std::size_t i = 0; i < 12; ++i) mass += to_double(d.pdf_of_cell(i)) / 12;
  EXPECT_NEAR(mass, 1, 1e-6);
}

TEST(Distribution, WindowedPiecewiseConstant2d) {
  const std::vector<float> values{1, 0, 2, 0, 0, 0, 0, 5, 4, 3, 0, 1};
  const WindowedPiecewiseConstant2d d(values, 3, 4);
  using Window = WindowedPiecewiseConstant2d::Window;
  for (const Window& window : {Window{}, Window{{0.1f, 0.3f}, {0.9f, 0.95f}}, Window{{0.4f, 0.6f}, {0.45f, 0.7f}},
                               Window{{0.2f, 0.05f}, {1, 1}}}) {
    const Vec2 size = window.max - window.min;
    constexpr int n = 200, bins = 5;
    std::array<double, bins * bins> expected{}, counts{};
    const auto bin = [&](const Vec2& p) {
      const Vec2 x = glm::clamp((p - window.min) / size * static_cast<float>(bins), Vec2(0), Vec2(bins - 0.001f));
      return static_cast<std::size_t>(x.y) * bins + static_cast<std::size_t>(x.x);
    };
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const Vec2 u = (Vec2(i, j) + 0.5f) / static_cast<float>(n), p = window.min + u * size;
        expected[bin(p)] += to_double(d.pdf(p, window) * size.x * size.y) / (n * n);
        const auto s = d.sample(u, window);
        ASSERT_TRUE(s);
        ASSERT_TRUE(glm::all(glm::greaterThanEqual(s->at, window.min - 1e-6f)) &&
                    glm::all(glm::lessThanEqual(s->at, window.max + 1e-6f)));
        const Vec2 inside = glm::clamp(s->at, Vec2(0), Vec2(one_minus_epsilon));
        if (std::fabs(d.pdf(inside, window) - s->pdf) < 1e-3f * s->pdf) counts[bin(s->at)] += 1.0 / (n * n);
      }
    double mass = 0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      EXPECT_NEAR(counts[i], expected[i], 0.015) << i;
      mass += expected[i];
    }
    EXPECT_NEAR(mass, 1, 0.015);
  }
  EXPECT_FALSE(d.sample({0.5f, 0.5f}, Window{{0.1f, 0.3f}, {0.6f, 0.45f}}));  // black there
}

TEST(Distribution, AliasTable) {
  const std::vector<float> weights{0.5f, 0, 7, 1, 1, 0.25f, 0.25f, 0};
  const AliasTable table(weights);
  std::vector<int> counts(weights.size());
  std::vector<double> left(weights.size());
  constexpr int n = 200000;
  for (int i = 0; i < n; ++i) {
    const auto s = table.sample((static_cast<float>(i) + 0.5f) / n);
    ASSERT_TRUE(s);
    ASSERT_GE(s->u, 0);
    ASSERT_LT(s->u, 1);
    ASSERT_FLOAT_EQ(s->pmf, weights[s->index] / 10);
    ++counts[s->index];
    left[s->index] += to_double(s->u);
  }
  for (std::size_t i = 0; i < weights.size(); ++i) {
    EXPECT_NEAR(counts[i], weights[i] / 10 * n, 8) << i;
    if (counts[i] == 0) continue;
    EXPECT_NEAR(left[i] / counts[i], 0.5, 1e-2) << i;
  }
  EXPECT_FALSE(AliasTable(std::vector<float>{0, 0}).sample(0.5f));
}

TEST(Octahedral, RoundTripsAndKeepsAreas) {
  HashRng rng(1);
  for (int i = 0; i < 20000; ++i) {
    const Vec2 p = rng.next2();
    const Direction d = direction_from_octahedral(p);
    ASSERT_NEAR(length_squared(d), 1, 1e-5f);
    const Vec2 q = octahedral_from_direction(normalize(d));
    ASSERT_NEAR(p.x, q.x, 2e-6f);
    ASSERT_NEAR(p.y, q.y, 2e-6f);
  }
  // A cap of half angle theta occupies a fraction (1 - cos) / 2 of the square.
  for (const Direction& axis : {Vec3(0, 0, 1), Vec3(0, 0, -1), Vec3(0.6f, 0, -0.8f), Vec3(0, -1, 0)}) {
    int inside = 0;
    constexpr int n = 1000;
    for (int i = 0; i < n * n; ++i)
      inside += dot(axis, direction_from_octahedral((Vec2(i % n, i / n) + 0.5f) / static_cast<float>(n))) > 0.7f;
    EXPECT_NEAR(inside / static_cast<double>(n * n), 0.15, 1e-3);
  }
  // Clarberg's layout: +z at the centre, -z at the corners, +x on the right, +y below (v grows).
  EXPECT_FLOAT_EQ(octahedral_from_direction({0, 0, 1}).x, 0.5f);
  EXPECT_FLOAT_EQ(octahedral_from_direction({1, 0, 0}).x, 1);
  EXPECT_FLOAT_EQ(octahedral_from_direction({0, 1, 0}).y, 1);
  EXPECT_GT(std::fabs(octahedral_from_direction(normalize(Vec3(0.01f, 0.01f, -1))).x - 0.5f), 0.49f);
}

TEST(Emitter, AreaIsTheSurfaceIntegral) {
  for (const TestSurface& s : test_surfaces()) {
    double expected = 0;
    s.integrate(200, [&](double, double, auto, auto, double da) { expected += da; });
    EXPECT_NEAR(to_double(area(s.shape)) / expected, 1, 1e-4) << s.name;
  }
  // A prolate spheroid, in closed form.
  const double a = 0.01, c = 1, e = std::sqrt(1 - a * a / (c * c));
  const SphereEmitter needle(scale({0.01f, 0.01f, 1}), 1);
  EXPECT_NEAR(to_double(needle.area) / (2 * std::numbers::pi * a * a * (1 + c / (a * e) * std::asin(e))), 1, 1e-5);
}

TEST(Emitter, SamplesLieOnTheSurfaceWithItsNormal) {
  HashRng rng(2);
  for (const TestSurface& s : test_surfaces()) {
    const Bounds box = bounds(s.shape);
    const NormalCone cone = normal_cone(s.shape);
    for (int i = 0; i < 50; ++i) {
      const EmitterPoint p = sample_area(s.shape, rng.next2());
      ASSERT_NEAR(length_squared(p.normal), 1, 1e-5f) << s.name;
      ASSERT_TRUE(glm::all(glm::greaterThanEqual(p.point, box.min - 1e-5f)) &&
                  glm::all(glm::lessThanEqual(p.point, box.max + 1e-5f)))
          << s.name;
      ASSERT_GE(dot(p.normal, cone.axis), cone.cos - 1e-5f) << s.name;
      double nearest = 1e9;
      glm::dvec3 normal{};
      s.integrate(60, [&](double, double, const glm::dvec3& at, const glm::dvec3& n, double) {
        const double distance = glm::length(at - glm::dvec3(p.point));
        if (distance < nearest) nearest = distance, normal = n;
      });
      ASSERT_LT(nearest, 0.08) << s.name;
      ASSERT_GT(glm::dot(normal, glm::dvec3(p.normal)) * (s.natural_normal_is_du_cross_dv ? 1 : -1), 0.9) << s.name;
    }
  }
}

TEST(Emitter, DirectionSamplesAgreeWithTheirDensity) {
  HashRng rng(3);
  for (const TestSurface& s : test_surfaces())
    for (const Point& from : receivers())
      for (int i = 0; i < 200; ++i) {
        const auto d = sample_towards(s.shape, from, rng.next2());
        if (!d) continue;
        ASSERT_NEAR(pdf_towards(s.shape, from, d->point, d->normal) / d->pdf, 1, 1e-3) << s.name;
        const Vec3 to_point = d->point - from;
        ASSERT_NEAR(d->distance, std::sqrt(length_squared(to_point)), 1e-5f * (1 + d->distance)) << s.name;
        ASSERT_LT(distance_squared(d->wi * d->distance, to_point), 1e-10f * (1 + sqr(d->distance))) << s.name;
      }
}

/// The solid angle to which a small square of random numbers maps, times the density: 1.
double jacobian_test(const EmitterShape& shape, const Point& from, const Vec2& u, float h) {
  const auto at = [&](float x, float y) { return glm::dvec3(sample_towards(shape, from, u + Vec2(x, y))->wi); };
  const glm::dvec3 du = at(h, 0) - at(-h, 0), dv = at(0, h) - at(0, -h);
  return glm::length(glm::cross(du, dv)) / to_double(4 * h * h) * to_double(sample_towards(shape, from, u)->pdf);
}

TEST(Emitter, SphereConeIsRightNearAndFar) {
  const SphereEmitter sphere(translate({1, 2, 3}), 0.5f);
  for (const float gap : {1e-4f, 1e-2f, 1.0f, 100.0f}) {
    const Point from = Point(1, 2, 3) + (0.5f + gap) * normalize(Vec3(1, 1, -1));
    for (const Vec2& u : {Vec2(0.2f, 0.3f), Vec2(0.5f, 0.9f), Vec2(0.9f, 0.6f)})
      EXPECT_NEAR(jacobian_test(sphere, from, u, 0.02f), 1, 0.02) << gap;
  }
  const float far = 1e6f;
  const auto s = sphere.sample_towards({far, 2, 3}, {0.5f, 0.5f});
  ASSERT_TRUE(s);
  EXPECT_NEAR(s->pdf * pi * sqr(0.5f / (far - 1)), 1, 1e-4f);
  EXPECT_NEAR(std::sqrt(distance_squared(s->point, {1, 2, 3})), 0.5f, 1e-5f);
  // Inside the sphere there is no cone of directions.
  EXPECT_TRUE(sphere.sample_towards({1.1f, 2, 3}, {0.5f, 0.5f}));
}

// After rounding, points on the sphere lie inside or outside. From each, the directions to the inside fill a
// hemisphere: the irradiance is π times the radiance.
TEST(Emitter, SpheresLightTheirOwnInside) {
  HashRng rng(21);
  for (const float radius : {1.0f, 100.0f, 3e5f}) {
    const SphereEmitter sphere(translate({3 * radius, 0, -radius / 7}), radius);
    double irradiance = 0;
    constexpr int points = 200, samples = 100;
    for (int p = 0; p < points; ++p) {
      const EmitterPoint at = sphere.sample_area(rng.next2());
      for (int i = 0; i < samples; ++i) {
        const auto s = sphere.sample_towards(at.point, rng.next2());
        if (!s || dot(s->wi, s->normal) <= 0) continue;
        EXPECT_NEAR(sphere.pdf_towards(at.point, s->point, s->normal) / s->pdf, 1, 1e-3);
        irradiance += to_double(-dot(s->wi, at.normal) / s->pdf) / (points * samples);
      }
    }
    EXPECT_NEAR(irradiance, std::numbers::pi, 0.01 * std::numbers::pi) << radius;
  }
}

TEST(Emitter, SphericalTriangleIsUniform) {
  const TriangleEmitter t({-1, -0.2f, 0.3f}, {0.8f, -0.4f, -0.2f}, {0.1f, 0.9f, 0.4f});
  const TriangleEmitter turned(t.p[0], t.p[2], t.p[1]);
  for (const TriangleEmitter& triangle : {t, turned})
    for (const Point& from : {Point(0, 0, 2), Point(0.1f, 0.2f, 0.3f), Point(3, 1, 1), Point(1, 1, -20)})
      for (const Vec2& u : {Vec2(0.2f, 0.3f), Vec2(0.6f, 0.8f), Vec2(0.9f, 0.5f)})
        EXPECT_NEAR(jacobian_test(triangle, from, u, 0.02f), 1, 0.03) << from.z;
  // An octant of the sphere.
  EXPECT_NEAR(TriangleEmitter({1, 0, 0}, {0, 1, 0}, {0, 0, 1}).pdf_towards({0, 0, 0}, {}, {}), 2 / pi, 1e-5f);
}

TEST(AreaLight, EmitsOnTheSideOfItsNormal) {
  for (const bool flip : {false, true}) {
    const AreaLight light{TriangleEmitter({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), test_colour(), false, flip};
    const float side = flip ? -1.0f : 1.0f;
    const auto front = sample_direct(light, {0.2f, 0.2f, side}, {0.5f, 0.5f}, rgb);
    ASSERT_TRUE(front);
    EXPECT_EQ(front->normal, Normal(0, 0, side));
    EXPECT_FALSE(sample_direct(light, {0.2f, 0.2f, -side}, {0.5f, 0.5f}, rgb));
    EXPECT_FALSE(emitted(light, {front->position, front->normal, {}}, {0, 0, side}, rgb).is_black());
    EXPECT_TRUE(emitted(light, {front->position, front->normal, {}}, {0, 0, -side}, rgb).is_black());
    const auto photon = sample_emission(light, {0.5f, 0.5f}, {0.3f, 0.3f}, rgb);
    ASSERT_TRUE(photon);
    EXPECT_GT(photon->direction.z * side, 0);
  }
  const AreaLight both{TriangleEmitter({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), test_colour(), true, false};
  EXPECT_TRUE(sample_direct(both, {0.2f, 0.2f, -1}, {0.5f, 0.5f}, rgb));
  EXPECT_TRUE(sample_direct(both, {0.2f, 0.2f, 1}, {0.5f, 0.5f}, rgb));
  EXPECT_GT(sample_emission(both, {0.5f, 0.5f}, {0.3f, 0.3f}, rgb)->direction.z, 0);
  EXPECT_LT(sample_emission(both, {0.5f, 0.5f}, {0.7f, 0.3f}, rgb)->direction.z, 0);
}

// Cycles' profile: 1 - tan(a) / tan(h), normalised.
TEST(AreaLight, SlatsKeepThePowerAndNarrowTheLight) {
  for (const double half : {0.01, 0.3, 0.785398163397, 1.5}) {
    const Spread spread(half);
    double mean = 0;
    constexpr int n = 20000;
    for (int i = 0; i < n; ++i) {
      const double angle = half * (i + 0.5) / n;
      const double factor = to_double(spread.factor(static_cast<float>(std::cos(angle))));
      mean += factor * 2 * std::cos(angle) * std::sin(angle) * half / n;
      ASSERT_NEAR(factor / to_double(spread.peak()), 1 - std::tan(angle) / std::tan(half), half > 0.1 ? 1e-3 : 5e-2);
    }
    EXPECT_NEAR(mean, 1, half > 0.1 ? 1e-3 : 1e-2) << half;
    EXPECT_EQ(spread.factor(static_cast<float>(std::cos(half + 0.01))), 0) << half;
  }
  EXPECT_NEAR(Spread(0.785398163397).peak(), 1 / (1 - pi / 4), 1e-4f);
  AreaLight light{DiskEmitter(Transform(), 0, 1), test_colour()};
  const float open = light.power();
  light.spread = Spread(0.5);
  EXPECT_EQ(light.power(), open);
  EXPECT_TRUE(sample_direct(light, {0, 0, 9}, {0.5f, 0.5f}, rgb));
  EXPECT_FALSE(sample_direct(light, {9, 0, 9}, {0.5f, 0.5f}, rgb));
}

TEST(AreaLight, MirroredQuadricsKeepTheirOutside) {
  const Transform mirror = translate({1, 0, 0}) * scale({-1, 1, 1});
  const SphereEmitter sphere(mirror, 0.5f);
  const EmitterPoint p = sphere.sample_area({0.3f, 0.3f});
  EXPECT_GT(dot(p.normal, p.point - Point(1, 0, 0)), 0);
  EXPECT_GT(sphere.world_radius, 0);
  EXPECT_EQ(DiskEmitter(mirror, 0, 1).normal, Normal(0, 0, 1));
  EXPECT_EQ(DiskEmitter(scale({1, 1, -1}), 0, 1).normal, Normal(0, 0, -1));
}

TEST(Light, EmissionAgreesWithItsDensities) {
  HashRng rng(4);
  for (const NamedLight& l : test_lights())
    for (int i = 0; i < 200; ++i) {
      const auto s = sample_emission(l.light, rng.next2(), rng.next2(), rgb);
      ASSERT_TRUE(s) << l.name;
      ASSERT_NEAR(length_squared(s->direction), 1, 1e-5f) << l.name;
      const EmitterHit origin{s->origin, s->normal};
      const EmissionPdf pdf = pdf_emission(l.light, origin, s->direction);
      ASSERT_NEAR(pdf.position / s->pdf_position, 1, 1e-4f) << l.name;
      // Directions at the edge of a spot's cone or of a texel may round to the other side.
      if (s->pdf_direction > 1e-3f) {
        ASSERT_NEAR(pdf.direction / s->pdf_direction, 1, 2e-2f) << l.name;
      }
      if (const auto* area_light = std::get_if<AreaLight>(&l.light)) {
        const float cos = std::fabs(dot(s->normal, s->direction));
        ASSERT_NEAR(cos, s->cos_origin, 1e-5f) << l.name;
        const Spectrum radiance = emitted(l.light, origin, s->direction, rgb);
        ASSERT_FALSE(radiance.is_black()) << l.name;
        ASSERT_NEAR(s->flux[0], radiance[0] * s->cos_origin / (s->pdf_position * s->pdf_direction), 1e-3f * s->flux[0])
            << l.name;
        ASSERT_TRUE(area_light->pattern != nullptr || !area_light->spread.is_diffuse() ||
                    area_light->radiance.evaluate(rgb) == radiance);
      }
    }
}

// Sampling again with the numbers found for a ray reproduces that ray.
TEST(Light, EmissionIsInverted) {
  HashRng rng(14);
  for (const NamedLight& l : test_lights())
    for (int i = 0; i < 200; ++i) {
      const Vec2 u_position = rng.next2(), u_direction = rng.next2();
      const auto s = sample_emission(l.light, u_position, u_direction, rgb);
      ASSERT_TRUE(s) << l.name;
      // For distant lights, any point on the ray is correct.
      const Point origin = is_far(l.light) ? s->origin + 1.7f * s->direction : s->origin;
      const EmissionNumbers found = invert_emission(l.light, {origin, s->normal}, s->direction);
      // Random numbers that a light does not need do not affect it. The sampling of positions cannot be inverted on
      // stretched and twisted emitters, on two-sided spheres, and on spheres behind slats.
      const bool rejects = l.name.starts_with("ellipsoid") || l.name.starts_with("sheared sphere") ||
                           l.name.starts_with("partial ellipsoid") || l.name.starts_with("sheared cylinder") ||
                           l.name.starts_with("saddle") || l.name == "sphere two-sided" ||
                           l.name == "mirrored sphere two-sided" || l.name == "sphere behind slats";
      ASSERT_FALSE(found.position && rejects) << l.name;
      const Vec2 position = found.position.value_or(rejects ? u_position : rng.next2());
      const Vec2 direction = found.direction.value_or(rng.next2());
      for (const Vec2& v : {position, direction}) ASSERT_TRUE(v.x >= 0 && v.x <= 1 && v.y >= 0 && v.y <= 1) << l.name;
      const Vec2 most(one_minus_epsilon);
      const auto again = sample_emission(l.light, glm::min(position, most), glm::min(direction, most), rgb);
      ASSERT_TRUE(again) << l.name;
      ASSERT_LT(distance_squared(again->direction, s->direction), sqr(4e-3f)) << l.name;
      ASSERT_LT(distance_squared(again->origin, s->origin), sqr(4e-3f) * (1 + length_squared(s->origin))) << l.name;
    }
}

TEST(Light, PhotonsCarryEqualFluxWhoseMeanIsThePower) {
  HashRng rng(5);
  for (const NamedLight& l : test_lights()) {
    // Their powers are documented as approximate; the screens of these tests are sampled by a table that differs from
    // their pattern.
    if (l.name.starts_with("stretched") || l.name.ends_with("as a screen")) continue;
    double sum = 0, squares = 0;
    constexpr int n = 2000;
    for (int i = 0; i < n; ++i) {
      const auto s = sample_emission(l.light, rng.next2(), rng.next2(), rgb);
      ASSERT_TRUE(s) << l.name;
      const double flux = to_double(colour_luminance(s->flux));
      sum += flux / n;
      squares += flux * flux / n;
    }
    // If solid angle varies within a texel, colours are interpolated, or slats take some of the light, flux varies.
    const bool varies = l.name == "projection" || l.name == "equirectangular infinite" || l.name.ends_with("portal") ||
                        l.name.ends_with("slats");
    const double variance = squares / (sum * sum) - 1;
    EXPECT_NEAR(sum / to_double(power(l.light)), 1, varies ? 4 * std::sqrt(variance / n) : 1e-4) << l.name;
    EXPECT_LT(variance, varies ? 1.0 : 1e-5) << l.name;
  }
}

// At 10^-20 m from a light without green its irradiance overflows, and its green would be infinity times 0.
TEST(Light, PointsAreNotSeenFromWhereTheirLightIsInfinite) {
  const EvenPointLight light{{}, {SpectrumCurve::illuminant({1, 0, 1})}};
  const auto near = light.sample_direct({1e-15f, 0, 0}, {}, Wavelengths::rgb(0.5f));
  ASSERT_TRUE(near);
  EXPECT_NEAR(near->radiance[0], 1e30f, 1e25f);
  EXPECT_EQ(near->radiance[1], 0);
  for (const float distance : {1e-20f, 1e-30f, 0.0f})
    EXPECT_FALSE(light.sample_direct({distance, 0, 0}, {}, Wavelengths::rgb(0.5f))) << distance;
}

TEST(Light, PowersInClosedForm) {
  const SpectrumCurve one = SpectrumCurve::illuminant({1, 1, 1});
  const BoundingSphere scene{{0, 0, 0}, 2};
  EXPECT_NEAR(power(EvenPointLight{{}, {one}}), 4 * pi, 1e-4f);
  EXPECT_NEAR(power(AreaLight{SphereEmitter(Transform(), 2), one}), pi * 16 * pi, 1e-3f);
  EXPECT_NEAR(power(AreaLight{DiskEmitter(Transform(), 0, 2), one, true}), 2 * pi * 4 * pi, 1e-3f);
  EXPECT_NEAR(power(DistantLight{{0, 0, 1}, one, scene}), 4 * pi, 1e-4f);
  EXPECT_NEAR(power(EvenSky{{one}, scene}), 4 * pi * 4 * pi, 1e-3f);
  EXPECT_NEAR(power(SpotLight{{}, SpotProfile({0, 0, 1}, one, pi, pi)}), 4 * pi, 1e-4f);
  const std::vector<Rgb> ones(32, Rgb{1, 1, 1});
  for (const SphericalImage& white :
       {SphericalImage(SphereLayout::octahedral, 4, 4, std::vector<Rgb>(ones.begin(), ones.begin() + 16)),
        SphericalImage(SphereLayout::equirectangular, 8, 4, ones)}) {
    EXPECT_NEAR(power(ImageSky{{{&white, {}}, 3}, scene}), 3 * 4 * pi * 4 * pi, 1e-2f);
    EXPECT_NEAR(power(GoniometricLight{{}, {{&white, {}}, one}}), 4 * pi, 1e-4f);
  }
  // A face of a cube, seen from its centre, is a sixth of the sphere.
  const ProjectionImage slide(64, 64, std::vector<Rgb>(64 * 64, Rgb{1, 1, 1}), pi / 2);
  EXPECT_NEAR(slide.solid_angle(), 4 * pi / 6, 1e-5f);
  EXPECT_NEAR(power(ProjectionLight{{}, {3, &slide, {}}}), 3 * 4 * pi / 6, 1e-3f);
}

// An image of bytes is the same light as one of colours.
TEST(LightTexels, BytesAreTheirColours) {
  std::array<float, 256> values{};
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i * i) / 1000;
  for (const std::size_t channels : {1u, 3u, 4u}) {
    std::vector<std::uint8_t> bytes(8 * 4 * channels);
    for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(37 * i % 251);
    const LightTexels texels(bytes, channels, values);
    ASSERT_EQ(texels.size(), 32u);
    std::vector<Rgb> colours;
    for (std::size_t i = 0; i < 32; ++i) {
      const auto value = [&](std::size_t c) { return values[bytes[channels * i + (channels == 1 ? 0 : c)]]; };
      colours.push_back({value(0), value(1), value(2)});
      EXPECT_EQ(texels[i], colours.back());
    }
    EXPECT_EQ(largest_value(texels), largest_value(colours));
    const SphericalImage sky(SphereLayout::equirectangular, 8, 4, texels), same(sky.layout, 8, 4, colours);
    const ProjectionImage slide(8, 4, texels, 1), same_slide(8, 4, colours, 1);
    EXPECT_EQ(sky.mean_luminance, same.mean_luminance);
    EXPECT_EQ(slide.integral, same_slide.integral);
    for (const Vec2 u : {Vec2(0.1f, 0.2f), Vec2(0.7f, 0.4f), Vec2(0.9f, 0.95f)}) {
      EXPECT_EQ(sky.sample(u)->colour, same.sample(u)->colour);
      EXPECT_EQ(sky.sample(u)->pdf, same.sample(u)->pdf);
      EXPECT_EQ(slide.sample(u)->colour, same_slide.sample(u)->colour);
    }
  }
}

TEST(SpotProfile, FallsOffAsPbrtAndGltfDo) {
  const float total = 24 * pi / 180, start = 18 * pi / 180;  // coneangle 24, conedeltaangle 6
  const SpotProfile spot({0, 0, 1}, SpectrumCurve::illuminant({1, 1, 1}), start, total);
  for (float angle = 0; angle < 0.5f; angle += 0.01f) {
    const float x = std::clamp((std::cos(angle) - std::cos(total)) / (std::cos(start) - std::cos(total)), 0.0f, 1.0f);
    EXPECT_NEAR(spot.falloff({std::sin(angle), 0, std::cos(angle)}), x * x * (3 - 2 * x), 1e-4f) << angle;
  }
  // glTF's spot light, as KHR_lights_punctual recommends it.
  const SpotProfile square({0, 0, 1}, SpectrumCurve::illuminant({1, 1, 1}), start, total, SpotProfile::Falloff::square);
  const float scale = 1 / (std::cos(start) - std::cos(total)), offset = -std::cos(total) * scale;
  for (float angle = 0; angle < 0.5f; angle += 0.01f) {
    const float attenuation = std::clamp(std::cos(angle) * scale + offset, 0.0f, 1.0f);
    EXPECT_NEAR(square.falloff({std::sin(angle), 0, std::cos(angle)}), attenuation * attenuation, 1e-4f) << angle;
  }
  const auto s = sample_direct(SpotLight{{}, spot}, {0, 0, 4}, {}, rgb);
  ASSERT_TRUE(s);
  EXPECT_NEAR(s->radiance[1], 1.0f / 16, 1e-6f);
  EXPECT_FALSE(sample_direct(SpotLight{{}, spot}, {0, 3, 4}, {}, rgb));
}

TEST(InfiniteLight, ReadsTheNearestTexelInLightSpace) {
  std::vector<Rgb> texels(64);
  texels[8 * 3 + 4] = {1, 0, 0};  // around +z, towards +x and -y
  texels[7] = {0, 1, 0};          // around -z, towards +x and -y
  const SphericalImage image(SphereLayout::octahedral, 8, 8, texels);
  const BoundingSphere scene;
  const Light plain = ImageSky{{{&image, {}}, 2}, scene};
  EXPECT_EQ(emitted_infinite(plain, {}, normalize(Vec3(0.01f, -0.01f, 1)), rgb)[0], 2);
  EXPECT_EQ(emitted_infinite(plain, {}, normalize(Vec3(-0.01f, -0.01f, 1)), rgb)[0], 0);
  EXPECT_EQ(emitted_infinite(plain, {}, normalize(Vec3(0.01f, -0.01f, -1)), rgb)[1], 2);
  // The pbrt idiom "Rotate -90 1 0 0" turns light-space z into world-space y.
  const Light turned = ImageSky{{{&image, DirectionMap(rotate(-90, {1, 0, 0}))}, 1}, scene};
  EXPECT_EQ(emitted_infinite(turned, {}, normalize(Vec3(0.01f, 1, 0.01f)), rgb)[0], 1);
  EXPECT_FLOAT_EQ(pdf_direct_towards(turned, {}, normalize(Vec3(0.01f, 1, 0.01f))),
                  luminance({1, 0, 0}) / luminance({1, 1, 0}) * 64 / (4 * pi));
  const SphericalImage black(SphereLayout::octahedral, 2, 2, std::vector<Rgb>(4));
  EXPECT_FALSE(sample_direct(ImageSky{{{&black, {}}, 1}, scene}, {}, {0.5f, 0.5f}, rgb));
}

TEST(InfiniteLight, ReadsPanoramasBilinearlyInLightSpace) {
  std::vector<Rgb> texels(32);
  texels[8 * 1 + 0] = {1, 0, 0};  // phi 0 to 45 degrees from +x towards +y, theta 45 to 90 from +z
  texels[8 * 2 + 7] = {0, 1, 0};  // phi 315 to 360, theta 90 to 135
  const SphericalImage image(SphereLayout::equirectangular, 8, 4, texels);
  const Light light = ImageSky{{{&image, {}}, 2}, {}};
  const auto at = [&](float theta, float phi) {
    const float t = theta * pi / 180, f = phi * pi / 180;
    return emitted_infinite(light, {}, {std::sin(t) * std::cos(f), std::sin(t) * std::sin(f), std::cos(t)}, rgb);
  };
  EXPECT_NEAR(at(67.5f, 22.5f)[0], 2, 1e-5f);  // the texel's centre
  EXPECT_NEAR(at(112.5f, 337.5f)[1], 2, 1e-5f);
  EXPECT_NEAR(at(67.5f, 45)[0], 1, 1e-5f);          // halfway to its dark neighbour
  EXPECT_NEAR(at(67.5f, -11.25f)[0], 0.5f, 1e-5f);  // across the seam
  EXPECT_NEAR(at(90, 0)[0], 0.5f, 1e-5f);
  EXPECT_NEAR(at(90, 0)[1], 0.5f, 1e-5f);
}

TEST(PortalLight, ShinesThroughItsRectangleAlone) {
  const std::array<Point, 4> corners{Point(0, 0, 0), Point(1, 0, 0), Point(1, 2, 0), Point(0, 2, 0)};
  const Sky sky = EvenSky{{test_colour()}, {}};
  const Portal portal(corners, sky);
  EXPECT_NEAR(portal.frame.n.z, -1, 1e-6f);  // the sky is where (p3 - p0) x (p1 - p0) points
  EXPECT_NEAR(portal.area(), 2, 1e-6f);
  const Light light = PortalLight{sky, &portal};
  EXPECT_NEAR(power(light), 2 * pi * luminance(test_colour().rgb), 1e-3f * 2 * pi);
  const Point inside(0.5f, 1, 3);
  const auto seen = [&](const Point& from, const Point& through) {
    const Direction d = normalize(through - from);
    const bool bright = !emitted_infinite(light, from, d, rgb).is_black();
    EXPECT_EQ(bright, pdf_direct_towards(light, from, d) > 0);
    return bright;
  };
  EXPECT_TRUE(seen(inside, {0.01f, 0.01f, 0}));
  EXPECT_TRUE(seen(inside, {0.99f, 1.99f, 0}));
  EXPECT_FALSE(seen(inside, {-0.01f, 1, 0}));
  EXPECT_FALSE(seen(inside, {0.5f, 2.01f, 0}));
  EXPECT_FALSE(seen(inside, {0.5f, 1, 6}));          // away from it
  EXPECT_FALSE(seen({0.5f, 1, -1}, {0.5f, 1, 0}));   // from the sky's side
  EXPECT_FALSE(seen({0.5f, 1, -1}, {0.5f, 1, -3}));  // the side from which the sky is visible
  EXPECT_FALSE(sample_direct(light, {0.5f, 1, -1}, {0.5f, 0.5f}, rgb));
  HashRng rng(8);
  for (int i = 0; i < 200; ++i) {
    const auto s = sample_direct(light, inside, rng.next2(), rgb);
    ASSERT_TRUE(s);
    EXPECT_NEAR(pdf_direct_towards(light, inside, s->wi) / s->pdf, 1, 1e-3f);
    const auto photon = sample_emission(light, rng.next2(), rng.next2(), rgb);
    ASSERT_TRUE(photon);
    EXPECT_TRUE(photon->from_infinity);
    EXPECT_GT(photon->direction.z, 0);
    const Point crossing = photon->origin - photon->origin.z / photon->direction.z * photon->direction;
    EXPECT_TRUE(crossing.x > -1e-4f && crossing.x < 1.0001f && crossing.y > -1e-4f && crossing.y < 2.0001f);
  }
}

TEST(GoniometricLight, MultipliesIntensityByItsImage) {
  std::vector<Rgb> texels(64);
  texels[8 * 3 + 4] = {3, 3, 3};  // around +z, towards +x and -y
  const SphericalImage image(SphereLayout::octahedral, 8, 8, texels);
  const Light light = GoniometricLight{{1, 2, 3}, {{&image, DirectionMap(rotate(-90, {1, 0, 0}))}, test_colour()}};
  // Light-space z is world-space y; light-space -y is world-space z.
  const auto above = sample_direct(light, Point(1, 2, 3) + Vec3(0.02f, 4, 0.02f), {}, rgb);
  ASSERT_TRUE(above);
  EXPECT_TRUE(above->delta);
  EXPECT_NEAR(above->radiance[0], 3 * 3.0f / 16, 1e-3f);
  EXPECT_FALSE(sample_direct(light, Point(1, 2, 3) + Vec3(-0.02f, 4, 0.02f), {}, rgb));
  EXPECT_TRUE(is_delta(light));
  EXPECT_FALSE(is_infinite(light));
}

TEST(ProjectionLight, ShowsItsImageUpright) {
  // Top left red, bottom right green, over 90 degrees of height.
  const ProjectionImage image(4, 2, std::vector<Rgb>{{1, 0, 0}, {}, {}, {}, {}, {}, {}, {0, 1, 0}}, pi / 2);
  const Light light = ProjectionLight{{1, 2, 3}, {2, &image, {}}};
  const auto at = [&](float x, float y) {
    const auto s = sample_direct(light, Point(1, 2, 3) + 2.0f * Vec3(x, y, 1), {}, rgb);
    return s ? s->radiance * (4 * (x * x + y * y + 1)) : Spectrum();
  };
  EXPECT_NEAR(at(-1.9f, 0.9f)[0], 2, 1e-4f);
  EXPECT_NEAR(at(-1.1f, 0.1f)[0], 2, 1e-4f);
  EXPECT_NEAR(at(1.5f, -0.5f)[1], 2, 1e-4f);
  EXPECT_TRUE(at(1.5f, 0.5f).is_black());
  EXPECT_TRUE(at(-2.1f, 0.5f).is_black());
  EXPECT_FALSE(sample_direct(light, Point(1, 2, 2), {}, rgb));  // behind it
  const NormalCone cone = std::get<ProjectionLight>(light).profile.cone();
  EXPECT_NEAR(cone.axis.z, 1, 1e-6f);
  EXPECT_NEAR(cone.cos, 1 / std::sqrt(6.0f), 1e-5f);
}

TEST(InfiniteLight, DirectSamplesAgreeWithDensityAndRadiance) {
  HashRng rng(6);
  for (const NamedLight& l : test_lights()) {
    if (!is_infinite(l.light)) continue;
    int wrong = 0;
    for (int i = 0; i < 2000; ++i) {
      const auto s = sample_direct(l.light, {}, rng.next2(), rgb);
      ASSERT_TRUE(s) << l.name;
      ASSERT_FALSE(s->delta);
      ASSERT_EQ(s->distance, infinity);
      const bool same = std::fabs(pdf_direct_towards(l.light, {}, s->wi) - s->pdf) < 1e-3f * s->pdf &&
                        std::fabs(emitted_infinite(l.light, {}, s->wi, rgb)[0] - s->radiance[0]) < 1e-4f;
      wrong += !same;
    }
    EXPECT_LE(wrong, 1) << l.name;  // rounding at the texels' borders
  }
}

TEST(InfiniteLight, PhotonsStartInFrontOfTheScene) {
  HashRng rng(7);
  for (const NamedLight& l : test_lights()) {
    if ((!is_infinite(l.light) && l.name != "distant") || l.name.ends_with("portal")) continue;
    for (int i = 0; i < 300; ++i) {
      const auto s = sample_emission(l.light, rng.next2(), rng.next2(), rgb);
      const Vec3 offset = s->origin - Point(0.5f, 1, -0.2f);
      ASSERT_NEAR(dot(offset, s->direction), -2.5f, 1e-4f) << l.name;
      ASSERT_LE(length_squared(offset), 2 * sqr(2.5f) * 1.0001f) << l.name;
    }
  }
}

std::vector<Light> many_lights(int count, std::uint64_t seed) {
  HashRng rng(seed);
  std::vector<Light> lights;
  for (int i = 0; i < count; ++i) {
    const Point p = 10.0f * Vec3(rng.next(), rng.next(), rng.next());
    const Vec3 e1 = Vec3(rng.next(), rng.next(), rng.next()) - 0.5f,
               e2 = Vec3(rng.next(), rng.next(), rng.next()) - 0.5f;
    const SpectrumCurve colour = SpectrumCurve::illuminant({rng.next() + 0.1f, rng.next(), rng.next()});
    const Direction axis = normalize(e1);
    switch (i % 6) {
      case 0:
        lights.emplace_back(EvenPointLight{p, {colour}});
        break;
      case 1:
        lights.emplace_back(SpotLight{p, SpotProfile(axis, colour, 0.3f * rng.next(), 0.3f + 2 * rng.next())});
        break;
      case 2:
        lights.emplace_back(AreaLight{SphereEmitter(translate(p), 0.3f), colour});
        break;
      case 3:
        lights.emplace_back(AreaLight{DiskEmitter(translate(p) * rotate(90, e1), 0, 0.5f), colour, true});
        break;
      default:
        lights.emplace_back(AreaLight{TriangleEmitter(p, p + e1, p + e2), colour, false, i % 12 == 4});
        break;
    }
  }
  return lights;
}

TEST(PhotonAllocation, SharesByPowerWithoutLoss) {
  const std::vector<Light> lights = many_lights(50, 8);
  double total_power = 0;
  for (const Light& l : lights) total_power += to_double(power(l));
  constexpr int offsets = 64;
  constexpr std::uint64_t n = 1003;
  std::vector<double> mean(lights.size());
  for (int k = 0; k < offsets; ++k) {
    const PhotonAllocation allocation(lights, n, (static_cast<float>(k) + 0.5f) / offsets);
    std::uint64_t next = 0;
    for (const auto& share : allocation.shares()) {
      ASSERT_EQ(share.begin, next);
      next += share.count;
      const double expected = to_double(power(lights[share.light])) / total_power * static_cast<double>(n);
      ASSERT_LT(std::fabs(static_cast<double>(share.count) - expected), 1.0 + 1e-6);
      ASSERT_NEAR(to_double(share.weight) * expected, 1, 1e-5);
      mean[share.light] += static_cast<double>(share.count) / offsets;
    }
    ASSERT_EQ(next, n);
    ASSERT_EQ(allocation.total(), n);
  }
  for (std::size_t i = 0; i < lights.size(); ++i)
    EXPECT_NEAR(mean[i], to_double(power(lights[i])) / total_power * n, 2.0 / offsets) << i;
}

TEST(PhotonAllocation, IsSafeAtItsEnds) {
  EXPECT_EQ(PhotonAllocation({}, 10, 0.5f).total(), 0u);
  const std::vector<Light> black{EvenPointLight{{}, {SpectrumCurve::constant(0)}}};
  EXPECT_EQ(PhotonAllocation(black, 10, 0.5f).total(), 0u);
  const std::vector<Light> one{black[0], EvenPointLight{{}, {test_colour()}}, black[0]};
  for (const float offset : {0.0f, 0.5f, one_minus_epsilon}) {
    const PhotonAllocation a(one, 10, offset);
    ASSERT_EQ(a.shares().size(), 1u);
    EXPECT_EQ(a.shares()[0].light, 1u);
    EXPECT_EQ(a.shares()[0].count, 10u);
  }
  EXPECT_EQ(PhotonAllocation(one, 0, 0.5f).total(), 0u);
  const EmissionGuide of_other_scene(2);
  EXPECT_THROW(PhotonAllocation(one, 10, 0.5f, &of_other_scene), std::invalid_argument);
  EXPECT_THROW(emission_probabilities(one, &of_other_scene), std::invalid_argument);
}

// A density requested up to a bound is exact if it is below the bound; otherwise the result lies between the bound and
// the exact value.
TEST(GuidedDensity, NeedNotBeExactAboveWhatIsEnough) {
  const BoundingSphere scene{{0, 0, 0}, 10};
  const Light light = EvenSky{{test_colour()}, scene};
  EmissionGuide guide(1, AimedDisks(scene, {1, 2, 0}, 1));
  TreeDistribution& numbers = guide.lights[0].numbers;  // few photons start from the wide disks
  numbers.add_inner(0, numbers.add_leaf(0.9f), numbers.add_leaf(0.1f));
  HashRng rng(13);
  int exact = 0, bounded = 0;
  for (int i = 0; i < 10'000; ++i) {
    const auto ray = sample_emission(light, {rng.next(), rng.next()}, {rng.next(), rng.next()}, rgb);
    ASSERT_TRUE(ray);
    const auto density = [&](float enough) {
      return guided_density(guide, light, 0, {ray->origin, Normal(0), Vec2(0)}, ray->direction, enough);
    };
    const float enough = 4 * rng.next(), truth = density(infinity), some = density(enough);
    if (truth < enough) {
      ASSERT_EQ(some, truth);
      ++exact;
    } else {
      ASSERT_GE(some, enough);
      ASSERT_LE(some, truth);
      bounded += some < truth ? 1 : 0;
    }
  }
  EXPECT_GT(exact, 1000);
  EXPECT_GT(bounded, 100);
}

TEST(LightBvh, ProbabilitiesSumToOneAndMatchSamples) {
  for (const int count : {1, 2, 3, 5, 40, 300, 3000}) {
    std::vector<Light> lights = many_lights(count, 9);
    if (count % 5 == 0) lights.emplace_back(DistantLight{{0, 0, 1}, test_colour(), {}});
    if (count % 5 == 0) lights.emplace_back(EvenSky{{test_colour()}, {}});
    const LightBvh bvh(lights);
    HashRng rng(10);
    for (int i = 0; i < 30; ++i) {
      const Point p = 12.0f * Vec3(rng.next(), rng.next(), rng.next());
      const Normal n = i % 3 == 0 ? Normal(0) : normalize(Vec3(rng.next(), rng.next(), rng.next()) - 0.5f);
      double sum = 0;
      for (std::uint32_t l = 0; l < lights.size(); ++l) sum += to_double(bvh.pmf(p, n, l));
      // Less than 1 if the chosen group has bounds, but no light, that could contribute.
      ASSERT_LE(sum, 1 + 1e-5) << count;
      std::vector<int> counts(lights.size());
      double nothing = 0;
      constexpr int draws = 1000;
      for (int k = 0; k < draws; ++k) {
        const auto s = bvh.sample(p, n, (static_cast<float>(k) + 0.5f) / draws);
        nothing += !s;
        if (s) {
          ASSERT_NEAR(s->pmf, bvh.pmf(p, n, s->light), 1e-5f * s->pmf);
          ++counts[s->light];
        }
      }
      ASSERT_NEAR(nothing / draws, 1 - sum, 0.02) << count;
      for (std::uint32_t l = 0; l < lights.size(); ++l)
        ASSERT_NEAR(counts[l] / static_cast<double>(draws), to_double(bvh.pmf(p, n, l)), 1.5 / draws) << count;
    }
  }
}

TEST(LightBvh, NeverMissesALightThatContributes) {
  const std::vector<Light> lights = many_lights(3000, 11);
  const LightBvh bvh(lights);
  HashRng rng(12);
  for (int i = 0; i < 100; ++i) {
    const Point p = 12.0f * Vec3(rng.next(), rng.next(), rng.next()) - 1.0f;
    const Normal n = i % 2 == 0 ? Normal(0) : normalize(Vec3(rng.next(), rng.next(), rng.next()) - 0.5f);
    for (std::uint32_t l = 0; l < lights.size(); ++l) {
      bool contributes = false;
      for (int k = 0; k < 4; ++k) contributes = contributes || sample_direct(lights[l], p, rng.next2(), rgb);
      if (contributes) {
        ASSERT_GT(bvh.pmf(p, n, l), 0) << "light " << l;
      }
    }
  }
}

TEST(LightBvh, DescendsDeepTreesAndCoincidentLights) {
  // Doubling distances make the split by cost separate one light after another.
  std::vector<Light> lights;
  for (int i = 0; i < 100; ++i) lights.emplace_back(EvenPointLight{{std::ldexp(1.0f, i - 60), 0, 0}, {test_colour()}});
  for (int i = 0; i < 100; ++i) lights.emplace_back(EvenPointLight{{5, 5, 5}, {test_colour()}});
  const LightBvh bvh(lights);
  double sum = 0;
  for (std::uint32_t l = 0; l < lights.size(); ++l) sum += to_double(bvh.pmf({5, 5, 4}, Normal(0), l));
  EXPECT_NEAR(sum, 1, 1e-4);
  EXPECT_FALSE(LightBvh().sample({}, {}, 0.5f));
  EXPECT_FALSE(LightBvh(std::span<const Light>()).sample({}, {}, 0.5f));
}

// At each split, the half around the point has about nine times the importance of the other, whose centre is three
// times as far away as its radius: of n lights, .9^log2(n) remains for the nearest and its neighbour.
TEST(LightBvh, PrefersNearLights) {
  for (const auto& [count, nearest] : {std::pair(64, 0.4f), std::pair(20'000, 0.15f)}) {
    std::vector<Light> lights;
    for (int i = 0; i < count; ++i) lights.emplace_back(EvenPointLight{{static_cast<float>(i), 0, 0}, {test_colour()}});
    const LightBvh bvh(lights);
    EXPECT_GT(bvh.pmf({3, 0.1f, 0}, Normal(0), 3), nearest) << count;
    EXPECT_LT(bvh.pmf({3, 0.1f, 0}, Normal(0), 40), 0.01f) << count;
  }
}

// A split is chosen from a sample of a large node's lights. The first lights all belong to the near cluster: with these
// alone no split would be found, and splitting by number would mix the clusters. The near cluster has 2112 lights at a
// distance of 1, the far one 1984 of 479 times the power at 30, which is half of its importance. Mixed halves seem as
// near as half their size: (15/30)² would give the far lights four times their weight.
TEST(LightBvh, SplitsByLightsOfAllParts) {
  std::vector<Light> lights;
  const Vec3 centre(0, -1, 0);
  HashRng rng(13);
  const auto add = [&](const Vec3& around, float power) {
    const Vec3 offset(0.01f * rng.next(), 0, 0);
    lights.emplace_back(EvenPointLight{around + offset, {SpectrumCurve::illuminant({power, power, power})}});
  };
  constexpr int count = 4096;
  for (int i = 0; i < count; ++i) {
    const bool near = i < count / 2 || i % 31 == 0;
    add(near ? centre : Vec3(30, 0, 0), near ? 1.0f : 479.0f);
  }
  const LightBvh bvh(lights);
  double first_half = 0;
  for (std::uint32_t i = 0; i < count / 2; ++i) first_half += to_double(bvh.pmf({0, 0, 0}, Normal(0), i));
  EXPECT_GT(first_half, 0.6);  // 2048/2112 / (1 + 1/2); with mixed halves 1 / (1 + 4/2)
}

// Images of a light need texels as fine as its own image, or as a part of a sun.
TEST(Lights, SayHowFineImagesOfThemMustBe) {
  const SphericalImage panorama(SphereLayout::equirectangular, 8, 4, LightTexels(std::vector<Rgb>(32, Rgb{1, 1, 1})));
  const SphericalImage square(SphereLayout::octahedral, 6, 6, LightTexels(std::vector<Rgb>(36, Rgb{1, 1, 1})));
  EXPECT_EQ(texels_across_right_angle(ImageSky{{{&panorama, {}}, 1}, {}}), 2);
  EXPECT_FLOAT_EQ(texels_across_right_angle(ImageSky{{{&square, {}}, 1}, {}}), std::sqrt(6.0f));
  EXPECT_NEAR(texels_across_right_angle(SunLight{ConeProfile({0, 0, 1}, 0.01, test_colour()), {}}), pi / 0.01f, 0.1f);
  EXPECT_EQ(texels_across_right_angle(EvenSky{{test_colour()}, {}}), 0);
}

}  // namespace
}  // namespace lanthorn::test
