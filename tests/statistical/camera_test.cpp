// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Light traced to the camera equals the radiance that it sees: inside a sphere that emits radiance 1, every pixel of
// every camera is 1.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "camera/camera.h"
#include "math/hash.h"
#include "math/sampling.h"
#include "support/statistics.h"

namespace lanthorn::camera_test {
namespace {

constexpr int width = 48, height = 32, tile = 8;
constexpr int tiles_x = width / tile, tiles_y = height / tile;
constexpr float radius = 5;

/// Mean of a given number of samples, where missing samples count as 0; and the variance of the mean.
struct Tile {
  double sum = 0, sum2 = 0;
};

double z_limit(int checks) { return test::z_limit(test::sidak(test::false_alarm_rate, checks)); }

// Splats uniformly distributed points of the sphere; returns means of tiles of pixels with their variances.
std::vector<Tile> traced(const Camera& camera, int samples) {
  std::vector<Tile> tiles(tiles_x * tiles_y);
  HashRng rng(test::seed(1));
  for (int i = 0; i < samples; ++i) {
    const Direction outwards = sample_uniform_sphere(rng.next2());
    const auto c = camera.connect(radius * outwards, rng.next2(), 0);
    if (!c) continue;
    const double value = static_cast<double>(c->importance) * std::fabs(dot(c->towards, outwards)) * 4 *
                         std::numbers::pi * radius * radius / (tile * tile);
    Tile& t = tiles[static_cast<std::size_t>(static_cast<int>(c->raster.y) / tile * tiles_x +
                                             static_cast<int>(c->raster.x) / tile)];
    t.sum += value;
    t.sum2 += value * value;
  }
  for (Tile& t : tiles) {
    t.sum /= samples;
    t.sum2 = (t.sum2 / samples - t.sum * t.sum) / samples;
  }
  return tiles;
}

// z-test of every tile and of the whole picture: 24 and 1 for each of 6 cameras. Standard errors of tiles: up to 3.6 %.
TEST(CameraStatistics, LightTracedFromASphereOfRadianceOneIsOne) {
  const AnimatedTransform placed(look_at({0.5f, 0.3f, 1.2f}, {0.2f, -0.1f, -2}, {0.1f, 1, 0}).inverted());
  const std::vector<std::pair<std::string, decltype(description::Camera::node)>> nodes{
      {"perspective", description::PerspectiveCamera{70, 0, 1e6f}},
      {"thin lens", description::PerspectiveCamera{70, 0.4f, 2}},
      {"orthographic", description::OrthographicCamera{0, 1e6f}},
      {"orthographic lens", description::OrthographicCamera{0.4f, 2}},
      {"equirectangular", description::SphericalCamera{description::SphericalMapping::equirectangular}},
      {"equal-area", description::SphericalCamera{description::SphericalMapping::equal_area}}};
  for (const auto& [name, node] : nodes) {
    description::Camera description;
    description.node = node;
    description.camera_to_world = placed;
    const Camera camera(description, width, height);
    const double z = z_limit(6 * (tiles_x * tiles_y + 1));
    Tile all;
    for (const Tile& t : traced(camera, 1000000)) {
      EXPECT_TRUE(test::within(t.sum, 1, z * std::sqrt(t.sum2))) << name;
      EXPECT_LT(std::sqrt(t.sum2), 0.05) << name << ": too few samples to tell";
      all.sum += t.sum / (tiles_x * tiles_y);
      all.sum2 += t.sum2 / (tiles_x * tiles_y) / (tiles_x * tiles_y);
    }
    EXPECT_TRUE(test::within(all.sum, 1, z * std::sqrt(all.sum2))) << name;
  }
}

// A realistic camera measures irradiance: light traced through its lens from a cone of directions of the sphere gives
// the same as rays from its film. z-test of every tile, with noise on both sides.
TEST(CameraStatistics, BothDirectionsThroughALensAgree) {
  description::Camera description;
  description::RealisticCamera lens;
  lens.elements = {{0.1f, 5e-3f, 1.5f, 0.05f}, {-0.1f, 5e-3f, 1, 0.05f}, {0, 0.1f, 0, 0.03f}};
  lens.focus_distance = 3;
  lens.film_diagonal = 0.08f;
  description.node = lens;
  description.camera_to_world = AnimatedTransform(scale({2, 2, 2}));
  const Camera camera(description, width, height);
  constexpr int samples = 2000000;
  constexpr float cone = 0.15f;  // 1 - cos of its half angle: wider than the view
  std::vector<Tile> traced(tiles_x * tiles_y), seen(tiles_x * tiles_y);
  const auto add = [](std::vector<Tile>& tiles, const Vec2& raster, double value) {
    Tile& t = tiles[static_cast<std::size_t>(static_cast<int>(raster.y) / tile * tiles_x +
                                             static_cast<int>(raster.x) / tile)];
    t.sum += value / samples;
    t.sum2 += value * value / samples / samples;
  };
  HashRng rng(test::seed(3));
  for (int i = 0; i < samples; ++i) {
    const Direction outwards = sample_uniform_cone(rng.next2(), cone);
    const double area = static_cast<double>(radius * radius / pdf_uniform_cone(cone));
    if (const auto c = camera.connect(radius * outwards, rng.next2(), 0))
      add(traced, c->raster,
          static_cast<double>(c->importance) * std::fabs(dot(c->towards, outwards)) * area / (tile * tile));
    const Vec2 raster(width * rng.next(), height * rng.next());
    add(seen, raster, static_cast<double>(camera.sample_ray(raster, rng.next2(), 0).weight) * tiles_x * tiles_y);
  }
  for (std::size_t i = 0; i < traced.size(); ++i) {
    const auto squared_error = [](const Tile& t) { return t.sum2 - t.sum * t.sum / samples; };
    const double error = std::sqrt(squared_error(traced[i]) + squared_error(seen[i]));
    EXPECT_TRUE(test::within(traced[i].sum, seen[i].sum, z_limit(tiles_x * tiles_y) * error)) << i;
    EXPECT_LT(error, 0.03 * traced[i].sum) << i;
  }
}

// A camera's densities integrate to 1: uniform directions (for an orthographic camera, positions), weighted by pdf.
TEST(CameraStatistics, DensityOfDirectionsIntegratesToOne) {
  for (const auto& [name, node] : std::vector<std::pair<std::string, decltype(description::Camera::node)>>{
           {"perspective", description::PerspectiveCamera{70, 0, 1e6f}},
           {"equirectangular", description::SphericalCamera{description::SphericalMapping::equirectangular}},
           {"equal-area", description::SphericalCamera{description::SphericalMapping::equal_area}}}) {
    description::Camera description;
    description.node = node;
    const Camera camera(description, width, height);
    HashRng rng(test::seed(2));
    constexpr int samples = 1000000;
    test::Mean mean;
    for (int i = 0; i < samples; ++i) {
      const Direction d = sample_uniform_sphere(rng.next2());
      const bool seen = camera.connect(d, {0.5f, 0.5f}, 0).has_value();
      mean.add(seen ? static_cast<double>(camera.pdf({Point(0), d}).direction) / pdf_uniform_sphere : 0);
    }
    // Tolerance for single precision: for cameras with a nearly constant density, samples hardly differ.
    EXPECT_TRUE(test::agrees(mean, 1, z_limit(3), 1e-5)) << name;
    EXPECT_LT(mean.error(), 0.005) << name;
  }
}

}  // namespace
}  // namespace lanthorn::camera_test
