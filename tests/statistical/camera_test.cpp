// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Light traced to the camera equals radiance seen from it: inside a sphere that emits radiance 1, every pixel of every
// camera is 1.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "math/hash.h"
#include "math/sampling.h"
#include "scene/camera.h"

namespace lanthorn {
namespace {

constexpr int width = 48, height = 32, tile = 8;
constexpr int tiles_x = width / tile, tiles_y = height / tile;
constexpr float radius = 5;

struct Tile {
  double sum = 0, sum2 = 0;
};

// Splats points drawn uniformly on the sphere; the means of tiles of pixels, with the variances of the means.
std::vector<Tile> traced(const Camera& camera, int samples) {
  std::vector<Tile> tiles(tiles_x * tiles_y);
  HashRng rng(1);
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
    t.sum2 = t.sum2 / samples / samples;
  }
  return tiles;
}

// z-test of every tile. Largest |z| of 24 tiles and 6 cameras beyond 5: false-alarm rate below 1e-4.
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
    double mean = 0;
    for (const Tile& t : traced(camera, 1000000)) {
      EXPECT_LT(std::fabs(t.sum - 1), 5 * std::sqrt(t.sum2)) << name << ": " << t.sum;
      EXPECT_GT(t.sum2, 0) << name;
      mean += t.sum / (tiles_x * tiles_y);
    }
    EXPECT_NEAR(mean, 1, 0.02) << name;
  }
}

// A realistic camera measures irradiance: light traced through its lens from a cone of directions of the sphere gives
// what rays from its film give. z-test of every tile, both sides noisy: false-alarm rate below 1e-4.
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
  HashRng rng(3);
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
    EXPECT_LT(std::fabs(traced[i].sum - seen[i].sum), 5 * std::sqrt(traced[i].sum2 + seen[i].sum2)) << i;
    EXPECT_LT(std::sqrt(traced[i].sum2), 0.03 * traced[i].sum) << i;
  }
}

// A camera's densities integrate to 1: uniform directions (or, orthographic, positions), weighted by pdf.
TEST(CameraStatistics, DensityOfDirectionsIntegratesToOne) {
  for (const auto& [name, node] : std::vector<std::pair<std::string, decltype(description::Camera::node)>>{
           {"perspective", description::PerspectiveCamera{70, 0, 1e6f}},
           {"equirectangular", description::SphericalCamera{description::SphericalMapping::equirectangular}},
           {"equal-area", description::SphericalCamera{description::SphericalMapping::equal_area}}}) {
    description::Camera description;
    description.node = node;
    const Camera camera(description, width, height);
    HashRng rng(2);
    constexpr int samples = 1000000;
    double sum = 0, sum2 = 0;
    for (int i = 0; i < samples; ++i) {
      const Direction d = sample_uniform_sphere(rng.next2());
      if (!camera.connect(d, {0.5f, 0.5f}, 0)) continue;
      const double value = static_cast<double>(camera.pdf({Point(0), d}).direction) / pdf_uniform_sphere;
      sum += value;
      sum2 += value * value;
    }
    EXPECT_LT(std::fabs(sum / samples - 1), 5 * std::sqrt(sum2) / samples) << name;
  }
}

}  // namespace
}  // namespace lanthorn
