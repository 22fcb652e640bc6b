// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "photon/gather/adaptive_radius.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "math/hash.h"
#include "photon/gather/radius_schedule.h"

namespace lanthorn::adaptive_radius_test {
namespace {

constexpr double pi_d = std::numbers::pi;

// Photons of one pass around the origin of a plane, uniform in a square. `light(p)` is their light per area.
struct Plane {
  static constexpr float half_side = 1;
  static constexpr int photons = 4000;
  static constexpr float per_area = photons / (4 * half_side * half_side);

  template <class Radius, class Light>
  static void pass(HashRng& rng, const AdaptiveRadiusSettings& settings, Radius& radius, Light&& light) {
    typename Radius::Tally tally(radius, settings);
    const float reach2 = sqr(radius.reach(settings));
    for (int i = 0; i < photons; ++i) {
      const Vec3 p(half_side * (2 * rng.next() - 1), half_side * (2 * rng.next() - 1), 0);
      const float value = light(p);
      if (dot(p, p) > reach2 || value <= 0) continue;
      tally.see({p, dot(p, p), Spectrum(value / per_area / 4)}, Frame());
    }
    radius.update(tally, settings);
  }
};

AdaptiveRadiusSettings epanechnikov(float alpha = 2.0f / 3) { return {alpha, {KernelShape::epanechnikov}}; }

// Hachisuka et al. 2008 with τ as published, against the mean over passes that the integrators compute.
TEST(HachisukaRadius, IsThePublishedEstimate) {
  const AdaptiveRadiusSettings settings{0.7f, {KernelShape::box}};
  HachisukaRadius radius(0.5f);
  HashRng rng(1);
  double r2 = 0.25, n = 0, tau = 0, mean = 0;
  constexpr int passes = 200;
  for (int pass = 0; pass < passes; ++pass) {
    HachisukaRadius::Tally tally(radius, settings);
    const auto m = static_cast<int>(6 * rng.next());
    double tau_m = 0;
    for (int i = 0; i < m; ++i) {
      tally.see({Vec3(0), 0, Spectrum(1)}, Frame());
      tau_m += static_cast<double>(rng.next());
    }
    const double radius_before = static_cast<double>(radius.radius());
    mean += tau_m / (pi_d * radius_before * radius_before) / passes;
    radius.update(tally, settings);
    if (m == 0) continue;
    const double kept = n + 0.7 * m, ratio = kept / (n + m);
    tau = (tau + tau_m) * ratio;
    r2 *= ratio;
    n = kept;
  }
  EXPECT_NEAR(static_cast<double>(radius.radius()), std::sqrt(r2), 1e-5 * std::sqrt(r2));
  const double published = tau / (pi_d * r2 * passes);
  EXPECT_NEAR(mean, published, 1e-4 * published);
}

// With uniform photons, the radius shrinks as Knaus & Zwicker's does, whose rule was derived from this one.
TEST(HachisukaRadius, ShrinksLikeTheScheduleOnUniformPhotons) {
  const AdaptiveRadiusSettings settings = epanechnikov();
  HachisukaRadius radius(0.5f);
  HashRng rng(2);
  constexpr int first = 50, last = 800;
  double at_first = 0;
  for (int pass = 1; pass <= last; ++pass) {
    Plane::pass(rng, settings, radius, [](const Vec3&) { return 1.0f; });
    if (pass == first) at_first = static_cast<double>(radius.radius());
  }
  const double slope = std::log(static_cast<double>(radius.radius()) / at_first) / std::log(double{last} / first);
  EXPECT_NEAR(slope, -(1 - 2.0 / 3) / 2, 0.01);
}

// For light 1 + c d² everything is known: v = 1 / per_area, and the Laplacian is 4 c.
TEST(LeastErrorRadius, FindsTheBestRadiusOfAParabola) {
  const AdaptiveRadiusSettings settings = epanechnikov();
  for (const float c : {1.5f, 3.0f}) {
    LeastErrorRadius radius(0.35f);
    HashRng rng(3);
    constexpr int passes = 400;
    for (int pass = 0; pass < passes; ++pass)
      Plane::pass(rng, settings, radius, [c](const Vec3& p) { return 1 + c * dot(p, p); });
    constexpr double roughness = 4 / (3 * pi_d), second = 1.0 / 6;
    const double bias = second * 4 * static_cast<double>(c) / 2;
    const double best =
        std::pow(roughness / static_cast<double>(Plane::per_area) / (6 * passes * bias * bias), 1.0 / 6);
    EXPECT_NEAR(static_cast<double>(radius.radius()), best, 0.12 * best) << "c = " << c;
  }
}

// The radius of the formula above `LeastErrorRadius`, between its bounds. Photons are the same in every pass, and are
// brighter the farther away they are. Returns in how many of 60 passes the radius differs from both bounds.
int passes_between_bounds(KernelShape shape, double growth) {
  const AdaptiveRadiusSettings settings{1, {shape}};
  constexpr double first = 0.3;
  const auto support_of = [&](double r) { return static_cast<double>(settings.kernel.support(static_cast<float>(r))); };
  const auto bound = [](double alpha, int passes) {
    return static_cast<double>(RadiusSchedule{first, alpha}.radius(static_cast<std::uint64_t>(passes)));
  };
  int between = 0;
  LeastErrorRadius radius(static_cast<float>(first));
  double squares = 0, laplacian = 0, noise = 0;
  for (int pass = 1; pass <= 60; ++pass) {
    const auto before = static_cast<double>(radius.radius());
    const double support = support_of(before), reach = support_of(std::min(2 * before, bound(0.9, pass - 1)));
    EXPECT_NEAR(static_cast<double>(radius.reach(settings)), reach, 1e-6);
    LeastErrorRadius::Tally tally(radius, settings);
    constexpr int photons = 50;
    for (int i = 0; i < photons; ++i) {
      const double area = (i + 0.5) / photons, dist2 = area * std::pow(support_of(first), 2);
      if (dist2 > reach * reach) break;
      const double light = 1 + 0.2 * (i % 3) + growth * area;
      Spectrum color;
      color[i % 4] = static_cast<float>(light);
      tally.see({Vec3(0), static_cast<float>(dist2), color}, Frame());
      if (dist2 <= support * support) squares += light * light / (pi_d * support * support);
      const double stencil = 24 / pi_d * (2 * dist2 / (reach * reach) - 1) / std::pow(reach, 4);
      laplacian += light * stencil;
      noise += light * stencil * light * stencil;
    }
    radius.update(tally, settings);
    const double bias = static_cast<double>(settings.moments.second) / 2;
    const double bias2 = bias * bias * std::max(0.0, laplacian * laplacian - noise) / (pass * pass);
    const double variance = squares / pass * static_cast<double>(settings.moments.roughness);
    const double best = std::pow(variance / (6 * pass * bias2), 1.0 / 6) / support_of(1);
    const double expected = std::clamp(best, bound(0.4, pass), bound(0.9, pass));
    EXPECT_NEAR(static_cast<double>(radius.radius()), expected, 1e-3 * expected) << "pass " << pass;
    between += best == expected ? 1 : 0;
  }
  return between;
}

TEST(LeastErrorRadius, FollowsItsFormula) {
  for (const KernelShape shape : {KernelShape::epanechnikov, KernelShape::gaussian}) {
    EXPECT_GT(passes_between_bounds(shape, 0.4), 40);
    EXPECT_LT(passes_between_bounds(shape, 3), 20);
  }
}

// Without photons, nothing is learned.
TEST(LeastErrorRadius, StaysAsItIsWithoutPhotons) {
  const AdaptiveRadiusSettings settings = epanechnikov();
  LeastErrorRadius radius(0.3f);
  radius.update(LeastErrorRadius::Tally(radius, settings), settings);
  EXPECT_EQ(radius.radius(), 0.3f);
}

TEST(LeastErrorRadius, StaysWideOnUniformPhotons) {
  LeastErrorRadius radius(0.3f);
  HashRng rng(4);
  for (int pass = 0; pass < 100; ++pass) Plane::pass(rng, epanechnikov(), radius, [](const Vec3&) { return 1.0f; });
  EXPECT_GT(radius.radius(), 0.5f * 0.3f);
}

float chi_squared_radius(bool edge, int passes) {
  ChiSquaredRadius radius(0.3f);
  HashRng rng(5);
  for (int pass = 0; pass < passes; ++pass)
    Plane::pass(rng, epanechnikov(), radius, [edge](const Vec3& p) { return edge && p.x < 0.02f ? 0.0f : 1.0f; });
  return radius.radius();
}

TEST(ChiSquaredRadius, ShrinksAtAnEdgeAndHardlyOnUniformPhotons) {
  const RadiusSchedule slowest{0.3, 0.9};
  EXPECT_GT(chi_squared_radius(false, 30), 0.8f * slowest.radius(30));
  EXPECT_LT(chi_squared_radius(true, 30), 0.5f * slowest.radius(30));
  const RadiusSchedule fastest{0.3, 0.4};
  EXPECT_GT(chi_squared_radius(true, 30), 0.99f * fastest.radius(30));
}

// Photons of one pass: `in_each` in each sector of a disc in the y-z plane, and `more` in addition in one of them.
void update(ChiSquaredRadius& radius, int in_each, std::size_t full_sector, int more) {
  const AdaptiveRadiusSettings settings = epanechnikov();
  const Frame frame({0, 1, 0}, {0, 0, 1}, {1, 0, 0});
  ChiSquaredRadius::Tally tally(radius, settings);
  for (std::size_t sector = 0; sector < disc_sectors; ++sector) {
    const float dist2 = (sector & 4u ? 0.51f : 0.49f) * sqr(radius.reach(settings));
    const float side = std::sqrt(dist2 / 2);
    const Vec3 offset = frame.to_world({sector & 1u ? side : -side, sector & 2u ? side : -side, 0});
    const int count = in_each + (sector == full_sector ? more : 0);
    for (int i = 0; i < count; ++i) tally.see({offset, dist2, Spectrum(1)}, frame);
  }
  radius.update(tally, settings);
}

// With 100 photons in each sector and 41 or 42 more in one, chi-squared is 13.99 or 14.66: just below and above 14.07,
// the 5 % point. (Counts since the radius last shrank, whatever the number of passes.)
TEST(ChiSquaredRadius, ShrinksBeyondTheCriticalValue) {
  constexpr float first = 0.3f;
  const RadiusSchedule slowest{static_cast<double>(first), 0.9};
  for (std::size_t sector = 0; sector < disc_sectors; ++sector) {
    ChiSquaredRadius uniform(first), other(first);
    update(uniform, 50, sector, 20);
    update(uniform, 50, sector, 21);
    EXPECT_FLOAT_EQ(uniform.radius(), slowest.radius(2));
    update(other, 50, sector, 21);
    EXPECT_FLOAT_EQ(other.radius(), slowest.radius(1));
    update(other, 50, sector, 21);
    const float shrunk = std::sqrt(0.75f) * slowest.radius(2);
    EXPECT_FLOAT_EQ(other.radius(), shrunk);
    update(other, 50, sector, 21);
    EXPECT_FLOAT_EQ(other.radius(), shrunk);
  }
}

TEST(ChiSquaredRadius, WantsFivePhotonsInEachSector) {
  ChiSquaredRadius few(0.3f), enough(0.3f);
  update(few, 0, 3, 39);
  update(enough, 0, 3, 40);
  EXPECT_LT(enough.radius(), 0.9f * few.radius());
}

TEST(KernelMoments, AreThoseOfTheKernels) {
  const auto expect = [](KernelShape shape, double roughness, double second) {
    const KernelMoments m = moments_of({shape});
    EXPECT_NEAR(static_cast<double>(m.roughness), roughness, 1e-4);
    EXPECT_NEAR(static_cast<double>(m.second), second, 1e-4);
  };
  expect(KernelShape::box, 1 / pi_d, 1.0 / 4);
  expect(KernelShape::epanechnikov, 4 / (3 * pi_d), 1.0 / 6);
  expect(KernelShape::cone, 3 / (2 * pi_d), 3.0 / 20);
}

}  // namespace
}  // namespace lanthorn::adaptive_radius_test
