// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "integrators/photonmap/irradiance_cache.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <span>
#include <vector>

#include "index/sphere_octree.h"
#include "integrators/photonmap/irradiance_photons.h"
#include "math/hash.h"
#include "math/sampling.h"
#include "photon/photon_map.h"

namespace lanthorn::irradiance_cache_test {
namespace {

const Bounds unit_box{Point(0), Point(1)};

Point random_point(HashRng& rng) { return {rng.next(), rng.next(), rng.next()}; }

struct Sphere {
  Point centre;
  float radius;
};

// Of all sizes, some larger than the box.
std::vector<Sphere> random_spheres(HashRng& rng) {
  std::vector<Sphere> spheres(2000);
  for (Sphere& s : spheres) s = {1.4f * random_point(rng) - Point(0.2f), std::exp2(-1 - 12 * rng.next())};
  spheres.push_back({Point(0.3f), 0});
  spheres.push_back({Point(0.5f), infinity});
  return spheres;
}

TEST(SphereOctree, FindsAllSpheresAroundAPoint) {
  HashRng rng(1);
  const std::vector<Sphere> spheres = random_spheres(rng);
  SphereOctree octree(unit_box);
  for (std::uint32_t i = 0; i < spheres.size(); ++i) octree.insert(i, spheres[i].centre, spheres[i].radius);
  std::size_t visited = 0, contained = 0;
  for (int q = 0; q < 2000; ++q) {
    const Point p = q == 0 ? Point(0.3f) : 1.4f * random_point(rng) - Point(0.2f);
    std::map<std::uint32_t, int> found;
    octree.for_each_around(p, [&](std::uint32_t id) { ++found[id]; });
    visited += found.size();
    for (const auto& [id, times] : found) EXPECT_EQ(times, 1);
    for (std::uint32_t i = 0; i < spheres.size(); ++i) {
      if (distance_squared(p, spheres[i].centre) > sqr(spheres[i].radius)) continue;
      ++contained;
      ASSERT_EQ(found.count(i), 1u) << q << ' ' << i;
    }
  }
  // Boxes two to four times as wide as the diameter contain a point 15 to 122 times as often as the sphere does.
  EXPECT_LT(visited, 60 * contained);
}

TEST(SphereOctree, FindsAllCentresNearAPoint) {
  HashRng rng(2);
  const std::vector<Sphere> spheres = random_spheres(rng);
  SphereOctree octree(unit_box);
  for (std::uint32_t i = 0; i < spheres.size(); ++i) octree.insert(i, spheres[i].centre, spheres[i].radius);
  for (int q = 0; q < 300; ++q) {
    const Point p = 1.4f * random_point(rng) - Point(0.2f);
    const float radius = std::exp2(-8 * rng.next());
    std::map<std::uint32_t, int> found;
    octree.for_each_near(p, radius, [&](std::uint32_t id) { ++found[id]; });
    for (std::uint32_t i = 0; i < spheres.size(); ++i)
      if (distance_squared(p, spheres[i].centre) <= sqr(radius)) {
        ASSERT_EQ(found.count(i), 1u) << q << ' ' << i;
      }
  }
}

Normal tilted(const Vec2& by) { return normalize(Normal(by.x, by.y, 1)); }

// The weighted mean over all records, with Ward's condition, in doubles.
std::optional<double> interpolated(const IrradianceCache& cache, const Point& p, const Normal& n, int channel) {
  double sum = 0, weights = 0;
  for (const IrradianceRecord& r : cache.records()) {
    const Vec3 offset = p - r.position;
    const double distance = std::sqrt(static_cast<double>(length_squared(offset)));
    if (static_cast<double>(dot(offset, 0.5f * (n + r.normal))) < -0.1 * distance) continue;
    const double radius = std::max(r.distance, r.least);
    const double e = distance / radius + std::sqrt(std::max(0.0, 1 - static_cast<double>(dot(n, r.normal))));
    const double weight = 1 - e / static_cast<double>(IrradianceCache::smoothing * cache.error());
    if (!(weight > 0)) continue;
    const Vec3 turn = cross(r.normal, n);  // Ward & Heckbert's form; the gradient turned to suit it
    const Vec3 rotation(r.rotation.x[channel], r.rotation.y[channel], r.rotation.z[channel]);
    const Vec3 translation(r.translation.x[channel], r.translation.y[channel], r.translation.z[channel]);
    const double steepness = static_cast<double>(r.distance) / radius;
    sum += weight * (static_cast<double>(r.irradiance[channel] + dot(turn, cross(r.normal, rotation))) +
                     steepness * static_cast<double>(dot(offset, translation)));
    weights += weight;
  }
  if (!(weights > 0)) return {};
  return std::max(0.0, sum / weights);
}

TEST(IrradianceCache, FindsWhatAllRecordsTell) {
  HashRng rng(3);
  IrradianceCache cache(unit_box, 0.3f);
  for (int i = 0; i < 3000; ++i) {
    IrradianceRecord record;
    record.position = random_point(rng) * Vec3(1, 1, 0.05f);
    record.normal = tilted(0.2f * (rng.next2() - Vec2(0.5f)));
    record.irradiance = Spectrum(1 + rng.next(), rng.next(), 2, 0);
    const Vec3 along = cross(record.normal, random_point(rng));
    record.rotation.add(along, Spectrum(rng.next(), 1, 2, 0));
    record.translation.add(cross(record.normal, random_point(rng)), Spectrum(rng.next(), 3, -1, 0));
    record.distance = std::exp2(-5 * rng.next());
    record.least = 0.1f;
    cache.insert(record);
  }
  int known = 0;
  for (int q = 0; q < 2000; ++q) {
    const Point p = random_point(rng) * Vec3(1, 1, 0.05f);
    const Normal n = tilted(0.2f * (rng.next2() - Vec2(0.5f)));
    const auto found = cache.find(p, n);
    for (int channel = 0; channel < 3; ++channel) {
      const auto expected = interpolated(cache, p, n, channel);
      ASSERT_EQ(found.has_value(), expected.has_value());
      if (!expected) continue;
      ++known;
      // Single precision gives 1 - cos of nearly equal normals to 1e-7, and its square root, used in weights, to 3e-4.
      ASSERT_NEAR(static_cast<double>((*found)[channel]), *expected, 3e-4) << q;
    }
  }
  EXPECT_GT(known, 4000);
}

TEST(IrradianceCache, InterpolatesLinearFieldsExactly) {
  const auto field = [](const Point& p) { return Spectrum(1 + 0.5f * p.x, 2 - p.y, 3 + p.x - p.y, 0); };
  HashRng rng(4);
  IrradianceCache cache(unit_box, 0.5f);
  for (int i = 0; i < 40; ++i) {
    IrradianceRecord record;
    record.position = random_point(rng) * Vec3(1, 1, 0);
    record.irradiance = field(record.position);
    record.translation = {Spectrum(0.5f, 0, 1, 0), Spectrum(0, -1, -1, 0), Spectrum()};
    record.distance = 0.5f;
    cache.insert(record);
  }
  for (int q = 0; q < 500; ++q) {
    const Point p = random_point(rng) * Vec3(1, 1, 0);
    const auto found = cache.find(p, Normal(0, 0, 1));
    ASSERT_TRUE(found);
    for (int channel = 0; channel < 3; ++channel) EXPECT_NEAR((*found)[channel], field(p)[channel], 1e-5f);
  }
}

TEST(IrradianceCache, SkipsRecordsBeforeThePoint) {
  IrradianceCache cache(unit_box, 0.5f);
  IrradianceRecord record;
  record.position = {0.5f, 0.5f, 0.5f};
  record.irradiance = Spectrum(1);
  record.distance = 1;
  cache.insert(record);
  const Normal up(0, 0, 1);
  EXPECT_TRUE(cache.covers({0.6f, 0.5f, 0.5f}, up));
  EXPECT_TRUE(cache.covers({0.6f, 0.5f, 0.52f}, up));
  EXPECT_FALSE(cache.covers({0.6f, 0.5f, 0.48f}, up));
  EXPECT_FALSE(cache.covers({0.6f, 0.5f, 0.5f}, -up));
  EXPECT_FALSE(cache.covers({1.01f, 0.5f, 0.5f}, up));  // beyond a R
  EXPECT_TRUE(cache.find({1.49f, 0.5f, 0.5f}, up));     // but within reach of smoothing
  EXPECT_TRUE(cache.covers({1.49f, 0.5f, 0.5f}, up, IrradianceCache::smoothing * cache.error()));
  EXPECT_FALSE(cache.covers({1.51f, 0.5f, 0.5f}, up, IrradianceCache::smoothing * cache.error()));
  EXPECT_FALSE(cache.find({1.51f, 0.5f, 0.5f}, up));
}

// A floor with a step that only one record is near enough to detect. The record limits its neighbours, but not across a
// wall.
TEST(IrradianceCache, NeighboursClampDistances) {
  for (const bool small_first : {true, false}) {
    IrradianceCache cache(unit_box, 0.2f);
    IrradianceRecord far;
    far.distance = 2;
    IrradianceRecord near = far, other_side = far;
    near.position = {0.1f, 0, 0};
    near.distance = 0.05f;
    far.position = {0.4f, 0, 0};
    other_side.position = {0.1f, 0, 0};
    other_side.normal = {0, 0, -1};
    cache.insert(other_side);
    cache.insert(small_first ? near : far);
    cache.insert(small_first ? far : near);
    EXPECT_EQ(cache.records()[0].distance, 2);
    EXPECT_EQ(cache.records()[small_first ? 1 : 2].distance, 0.05f);
    EXPECT_FLOAT_EQ(cache.records()[small_first ? 2 : 1].distance, 0.35f);
  }
}

// The octree's search for neighbours omits none.
TEST(IrradianceCache, NoDistanceIsLongerThanANeighboursAndTheWayThere) {
  HashRng rng(5);
  IrradianceCache cache(unit_box, 0.2f);
  for (int i = 0; i < 500; ++i) {
    IrradianceRecord record;
    record.position = random_point(rng);
    record.distance = std::exp2(2 - 10 * rng.next());
    cache.insert(record);
  }
  for (const IrradianceRecord& a : cache.records())
    for (const IrradianceRecord& b : cache.records())
      ASSERT_LE(a.distance, b.distance + std::sqrt(distance_squared(a.position, b.position)) + 1e-6f);
}

using Environment = std::function<HemisphereRay(const Vec3&)>;

// Mean over many grids of random directions.
IrradianceRecord mean_record(int cells, const Environment& environment, const Frame& frame) {
  constexpr int runs = 400;
  HashRng rng(6);
  const HemisphereGrid grid(cells);
  IrradianceRecord mean;
  mean.distance = 0;
  for (int run = 0; run < runs; ++run) {
    std::vector<HemisphereRay> rays;
    rays.reserve(static_cast<std::size_t>(grid.cells()));
    for (int cell = 0; cell < grid.cells(); ++cell)
      rays.push_back(environment(frame.to_world(grid.direction(cell, rng.next2()))));
    const IrradianceRecord record = estimate_irradiance(grid, rays, frame);
    const auto add = [](Spectrum& sum, const Spectrum& s) { sum += s / static_cast<float>(runs); };
    add(mean.irradiance, record.irradiance);
    add(mean.rotation.x, record.rotation.x);
    add(mean.rotation.y, record.rotation.y);
    add(mean.rotation.z, record.rotation.z);
    add(mean.translation.x, record.translation.x);
    add(mean.translation.y, record.translation.y);
    add(mean.translation.z, record.translation.z);
    mean.distance += record.distance / static_cast<float>(runs);
  }
  return mean;
}

TEST(HemisphereGrid, HasTheCellsAskedForAndCosineDensity) {
  for (const int cells : {4, 5, 16, 100, 512, 4096}) {
    const HemisphereGrid grid(cells);
    EXPECT_LE(grid.cells(), cells);
    EXPECT_GT(grid.cells(), 0.75 * cells);
  }
  HashRng rng(7);
  const HemisphereGrid grid(64);
  Vec3 mean(0);
  constexpr int runs = 1000;
  for (int i = 0; i < runs * grid.cells(); ++i) {
    const Vec3 d = grid.direction(i % grid.cells(), rng.next2());
    EXPECT_NEAR(length_squared(d), 1, 1e-5f);
    mean += d / static_cast<float>(runs * grid.cells());
  }
  // Standard deviations without stratification: 0.001, 0.002, 0.002.
  EXPECT_NEAR(mean.z, 2.0f / 3, 3e-3f);
  EXPECT_NEAR(mean.x, 0, 5e-3f);
  EXPECT_NEAR(mean.y, 0, 5e-3f);
}

// Half the sky is bright: for the lune between its border and the horizon, E = π/2 (1 + sin δ), where δ is the
// inclination towards the bright half.
TEST(IrradianceGradients, OfRotationUnderHalfASky) {
  const Frame frame(normalize(Vec3(0.3f, -0.2f, 0.9f)));
  const Direction bright = frame.to_world(normalize(Vec3(2, 1, 0)));
  const IrradianceRecord record = mean_record(
      256,
      [&](const Vec3& d) {
        return HemisphereRay{Spectrum(dot(d, bright) > 0 ? 1.0f : 0.0f, 1, 0, 0), infinity};
      },
      frame);
  EXPECT_NEAR(record.irradiance[0], pi / 2, 0.01f);
  EXPECT_NEAR(record.irradiance[1], pi, 1e-4f);
  const Vec3 rotation(record.rotation.x[0], record.rotation.y[0], record.rotation.z[0]);
  EXPECT_NEAR(dot(rotation, bright), pi / 2, 0.03f);
  EXPECT_NEAR(dot(rotation, cross(bright, frame.n)), 0, 0.03f);
  EXPECT_NEAR(dot(rotation, frame.n), 0, 1e-4f);
  EXPECT_NEAR(record.rotation.x[1], 0, 1e-4f);  // an even sky
  EXPECT_EQ(record.translation.x, Spectrum());  // that is infinitely far away
  // Also extrapolated, to first order.
  const float tilt = 0.1f;
  const Normal inclined = std::cos(tilt) * frame.n + std::sin(tilt) * bright;
  EXPECT_NEAR(record.at(Point(0), inclined)[0], pi / 2 * (1 + std::sin(tilt)), 0.01f);
}

// A bright half of a ceiling, at height h beyond x = e: E(x) = π/2 (1 - s / √(h² + s²)), s = e - x. The dark part is
// the other half of the ceiling, or far behind it: the edge that moves belongs to the nearer surface.
TEST(IrradianceGradients, OfTranslationUnderHalfACeiling) {
  constexpr float h = 0.7f;
  for (const float behind : {1.0f, 10.0f})
    for (const float edge : {0.0f, 0.4f, -0.5f}) {
      const IrradianceRecord record = mean_record(
          1024,
          [&](const Vec3& d) {
            const float distance = h / d.z;
            const bool is_bright = distance * d.x > edge;
            return HemisphereRay{Spectrum(is_bright ? 1.0f : 0.0f, 1, 0, 0), is_bright ? distance : behind * distance};
          },
          Frame());
      const float slant2 = sqr(h) + sqr(edge);
      EXPECT_NEAR(record.irradiance[0], pi / 2 * (1 - edge / std::sqrt(slant2)), 0.01f);
      // Cells that contain the edge count with the smaller of two distances, which is a few per cent too much.
      EXPECT_NEAR(record.translation.x[0] / (pi / 2 * sqr(h) / (slant2 * std::sqrt(slant2))), 1, 0.06f) << edge;
      EXPECT_NEAR(record.translation.y[0], 0, 0.03f);
      EXPECT_NEAR(record.translation.z[0], 0, 1e-4f);
      EXPECT_NEAR(record.translation.x[1], 0, 1e-4f);
    }
}

TEST(IrradianceGradients, DistanceIsTheHarmonicMeanAndLimitedByTheGradient) {
  constexpr float h = 0.7f;
  const auto ceiling = [&](float edge) {
    return mean_record(
        1024,
        [&, edge](const Vec3& d) {
          return HemisphereRay{Spectrum(h / d.z * d.x > edge ? 1.0f : 0.0f), h / d.z};
        },
        Frame());
  };
  // The mean of cos / h by density cos / π is 2 / (3 h).
  EXPECT_NEAR(ceiling(-infinity).distance, 1.5f * h, 0.01f);
  EXPECT_NEAR(ceiling(0).distance, h, 0.06f);  // E / |dE/dx|
}

// If clamping has enlarged R, the gradient must not remove more light.
TEST(IrradianceGradients, AreFlattenedWhereDistancesAreTooShort) {
  IrradianceRecord record;
  record.irradiance = Spectrum(1);
  record.translation.x = Spectrum(-1 / 0.1f);
  record.distance = 0.1f;
  EXPECT_NEAR(record.at({0.05f, 0, 0}, record.normal)[0], 0.5f, 1e-6f);
  record.least = 0.4f;
  EXPECT_NEAR(record.at({0.2f, 0, 0}, record.normal)[0], 0.5f, 1e-6f);
}

// On the left, photons leave three scattering events to eye paths; on the right, two.
TEST(IrradiancePhotons, AreForEyePathsThatMayUseAllTheirPhotons) {
  HashRng rng(8);
  std::vector<Photon> photons(1000);
  for (Photon& photon : photons) {
    const Point p = random_point(rng) * Vec3(1, 1, 0);
    photon = {Spectrum(1, 1, 1, 0), p, Direction(0, 0, 1), Normal(0, 0, 1), {.eye_scatterings = p.x < 0.5f ? 3 : 2}};
  }
  const auto map = PhotonMap<BucketKdTree>::build(photons, ColorMode::rgb);
  EstimateSettings settings;
  settings.radius = 0.2f;
  const auto records = IrradiancePhotons::build(map, std::span(&photons, 1), settings, Wavelengths::rgb(0.5f));
  const Normal up(0, 0, 1);
  int found = 0;
  for (int q = 0; q < 100; ++q) {
    // Away from the edges of the square, where light is not even.
    const Point left = Point(0.15f, 0.15f, 0) + random_point(rng) * Vec3(0.1f, 0.7f, 0),
                right = Point(1 - left.x, left.y, 0);
    if (records.find(left, up, 0.2f, 3)) ++found;
    EXPECT_FALSE(records.find(left, up, 0.2f, 4));
    if (records.find(right, up, 0.2f, 2)) ++found;
    EXPECT_FALSE(records.find(right, up, 0.2f, 3));
    EXPECT_FALSE(records.find(left, -up, 0.2f, 1));
  }
  EXPECT_GT(found, 160);
}

// Photons of a square of 1 m² that is lit in part: power 1 where `is_lit`, else `rest`.
template <class Lit>
IrradiancePhotons records_of(HashRng& rng, std::size_t count, Lit&& is_lit, float rest,
                             const EstimateSettings& settings) {
  std::vector<Photon> photons;
  while (photons.size() < count) {
    const Point p = random_point(rng) * Vec3(1, 1, 0);
    const float power = is_lit(p) ? 1.0f : rest;
    if (power > 0)
      photons.push_back(
          {Spectrum(power, power, power, 0), p, Direction(0, 0, 1), Normal(0, 0, 1), {.eye_scatterings = 9}});
  }
  const auto map = PhotonMap<BucketKdTree>::build(photons, ColorMode::rgb);
  return IrradiancePhotons::build(map, std::span(&photons, 1), settings, Wavelengths::rgb(0.5f));
}

struct Found {
  double share = 0, irradiance = 0;  // share of points with a record, mean of the records
};
// At random points of the rectangle.
Found found_in(const IrradiancePhotons& records, HashRng& rng, float radius, const Point& low, const Point& high) {
  constexpr int points = 4000;
  Found result;
  int count = 0;
  for (int i = 0; i < points; ++i)
    if (const auto e = records.find(low + random_point(rng) * (high - low), {0, 0, 1}, radius, 1)) {
      ++count;
      result.irradiance += static_cast<double>((*e)[0]);
    }
  return {static_cast<double>(count) / points, count > 0 ? result.irradiance / count : 0};
}

// The largest radius is ten times that of the estimates. Points beyond the edge of the light must not get its light,
// however near the edge, and whether they are dark or dim.
TEST(IrradiancePhotons, EndWhereLightEnds) {
  for (const std::size_t nearest : {std::size_t{0}, std::size_t{30}, std::size_t{50}, std::size_t{200}})
    for (const float rest : {0.0f, 0.1f}) {
      HashRng rng(9);
      EstimateSettings settings;
      settings.nearest = nearest;
      settings.radius = nearest == 0 ? 0.03f : 0.3f;
      const IrradiancePhotons records = records_of(
          rng, 20'000, [](const Point& p) { return p.x < 0.5f; }, rest, settings);
      const double lit = rest > 0 ? 20'000 : 40'000;  // photons per m²
      const auto found = [&](float from, float to) {
        return found_in(records, rng, settings.radius, {from, 0.1f, 0}, {to, 0.9f, 0});
      };
      const Found inside = found(0.1f, 0.4f), outside = found(0.502f, 0.9f);
      EXPECT_GT(inside.share, 0.8) << nearest;
      EXPECT_NEAR(inside.irradiance, lit, 0.03 * lit) << nearest;
      if (rest == 0)
        EXPECT_LT(outside.share, 0.002) << nearest;
      else
        EXPECT_NEAR(outside.irradiance, static_cast<double>(rest) * lit, 0.005 * lit) << nearest;
    }
}

// Spots and lines of light that are narrower than the estimates that find them: symmetric, but not even.
TEST(IrradiancePhotons, LeaveOutNarrowLines) {
  EstimateSettings settings;
  settings.nearest = 0;
  settings.radius = 0.05f;
  HashRng rng(10);
  const auto is_on_line = [](const Point& p) { return std::fabs(p.x - 0.5f) < 0.01f; };
  const auto is_in_spot = [](const Point& p) { return distance_squared(p, Point(0.5f, 0.5f, 0)) < sqr(0.02f); };
  const auto share = [&](const auto& is_lit, float rest, const Point& low, const Point& high) {
    return found_in(records_of(rng, 4'000, is_lit, rest, settings), rng, 0.3f, low, high).share;
  };
  for (const float rest : {0.0f, 0.05f}) {
    EXPECT_LT(share(is_on_line, rest, {0.476f, 0.2f, 0}, {0.524f, 0.8f, 0}), 0.05) << rest;
    EXPECT_LT(share(is_in_spot, rest, {0.476f, 0.476f, 0}, {0.524f, 0.524f, 0}), 0.05) << rest;
  }
}

}  // namespace
}  // namespace lanthorn::irradiance_cache_test
