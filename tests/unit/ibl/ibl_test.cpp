// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "lanthorn/ibl.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "ibl/brute_force.h"
#include "ibl/cube_map.h"
#include "ibl/environment.h"
#include "ibl/spherical_harmonics.h"
#include "lanthorn/error.h"
#include "lanthorn/threads.h"
#include "math/octahedral.h"
#include "surface/microfacet.h"

namespace lanthorn::ibl_test {
namespace {

constexpr double pi_d = std::numbers::pi;
using RadianceOf = std::function<Rgb(const Direction&)>;

void set(Image& image, int x, int y, const Rgb& c) {
  image.at(x, y, 0) = c.r;
  image.at(x, y, 1) = c.g;
  image.at(x, y, 2) = c.b;
}

// By the definition in ibl.h, the centre is +x, and +z is a quarter of the width to its right.
Direction equirectangular_direction(int x, int y, int width) {
  const double polar = pi_d * (y + 0.5) / (width / 2.0), azimuth = 2 * pi_d * (x + 0.5) / width - pi_d;
  return {static_cast<float>(std::sin(polar) * std::cos(azimuth)), static_cast<float>(std::cos(polar)),
          static_cast<float>(std::sin(polar) * std::sin(azimuth))};
}

Image equirectangular(int width, const RadianceOf& radiance) {
  Image image(width, width / 2, {"R", "G", "B"});
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < width; ++x) set(image, x, y, radiance(equirectangular_direction(x, y, width)));
  return image;
}

Image octahedral(int size, const RadianceOf& radiance) {
  Image image(size, size, {"R", "G", "B"});
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const Vec2 at(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
      const Direction pbrt = direction_from_octahedral(at / static_cast<float>(size));
      set(image, x, y, radiance({pbrt.x, pbrt.z, -pbrt.y}));
    }
  return image;
}

Image cube_strip(int size, const RadianceOf& radiance) {
  Image image(6 * size, size, {"R", "G", "B"});
  const CubeMap directions(size);
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < 6 * size; ++x) set(image, x, y, radiance(directions.direction(x / size, x % size, y)));
  return image;
}

IblSettings small() {
  IblSettings settings;
  settings.specular_size = 64;
  settings.smallest_size = 8;
  settings.irradiance_size = 8;
  settings.checks = 0;
  return settings;
}

Rgb smooth(const Direction& d) { return {1 + 0.5f * d.y + 0.3f * d.x * d.z, 1 + 0.4f * d.x, 0.8f + 0.5f * d.z * d.z}; }

// Extended lights, noise, and a dark ground: not easy to integrate.
Rgb lively(const Direction& d) {
  const auto lamp = [&](const Vec3& towards, float width) {
    return dot(d, normalize(towards)) > std::cos(width) ? 10.0f : 0.0f;
  };
  const float sky = d.y > 0 ? 0.5f + 0.5f * d.y : 0.1f;
  const float stripes = std::sin(9 * d.x) * std::sin(7 * d.z) > 0.4f ? 1.0f : 0.0f;
  return {sky + lamp({1, 1, 0.3f}, 0.15f), sky + stripes + lamp({-1, 0.4f, 2}, 0.1f), sky + 0.3f * stripes};
}

struct Means {
  double mean = 0, largest = 0, least = 1e30;
};

// Means of the red channel, weighted by solid angle.
Means means_of(const Image& strip) {
  const int n = strip.height;
  Means m;
  double omega_sum = 0;
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < strip.width; ++x) {
      const double s = 2 * (x % n + 0.5) / n - 1, t = 2 * (y + 0.5) / n - 1;
      const double omega = std::pow(1 + s * s + t * t, -1.5), value = static_cast<double>(strip.at(x, y, 0));
      m.mean += omega * value;
      omega_sum += omega;
      m.largest = std::max(m.largest, value);
      m.least = std::min(m.least, value);
    }
  m.mean /= omega_sum;
  return m;
}

// The definition of the prefiltered environment, in double precision: texels of an equirectangular image as points.
double prefiltered(const Image& image, const Direction& r, double alpha, LobeWeight by) {
  double light = 0, norm = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const double polar = pi_d * (y + 0.5) / image.height;
      const Direction l = equirectangular_direction(x, y, image.width);
      const double cos = static_cast<double>(dot(l, r));
      if (cos <= 0) continue;
      const double cos2_h = 0.5 * (1 + cos), e = 1 + (alpha * alpha - 1) * cos2_h;
      const double masking = 2 * cos / (cos + std::sqrt(alpha * alpha * (1 - cos * cos) + cos * cos));
      const double weight = std::sin(polar) * (by == LobeWeight::cosine ? cos : masking) / (e * e);
      light += weight * static_cast<double>(image.at(x, y, 0));
      norm += weight;
    }
  return light / norm;
}

TEST(CubeMap, FacesAreOpenGls) {
  const auto centre = [](int face) { return cube_direction(face, {0.5f, 0.5f}); };
  const std::array<Vec3, 6> axes{{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}};
  for (int face = 0; face < 6; ++face)
    EXPECT_LT(length_squared(centre(face) - axes[static_cast<std::size_t>(face)]), 1e-12f);
  // The right edge of +Z is the left edge of +X, and the upper edge of +Z is the lower edge of +Y.
  EXPECT_GT(cube_direction(4, {1, 0.5f}).x, 0.7f);
  EXPECT_GT(cube_direction(0, {0, 0.5f}).z, 0.7f);
  EXPECT_GT(cube_direction(4, {0.5f, 0}).y, 0.7f);
  EXPECT_GT(cube_direction(2, {0.5f, 1}).z, 0.7f);
}

TEST(CubeMap, DirectionsAndPlacesAreInverses) {
  for (int face = 0; face < 6; ++face)
    for (const float x : {0.01f, 0.3f, 0.99f})
      for (const float y : {0.02f, 0.6f, 0.97f}) {
        const CubePoint p = cube_point(cube_direction(face, {x, y}));
        EXPECT_EQ(p.face, face);
        EXPECT_NEAR(p.at.x, x, 1e-6f);
        EXPECT_NEAR(p.at.y, y, 1e-6f);
      }
}

TEST(CubeMap, SolidAnglesCoverTheSphere) {
  for (const int size : {1, 2, 7, 64}) {
    double sum = 0;
    for (const float omega : cube_solid_angles(size)) sum += static_cast<double>(omega);
    EXPECT_NEAR(6 * sum, 4 * pi_d, 1e-5);
  }
}

TEST(CubeMap, LookUpsHaveNoSeams) {
  CubeMap map(16);
  for (int face = 0; face < 6; ++face)
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 16; ++x) {
        const Direction d = map.direction(face, x, y);
        map.texel(face, x, y) = {d.x, d.y, d.z, 0};
      }
  map.close_seams();
  std::mt19937 random(1);
  for (int i = 0; i < 10'000; ++i) {
    const auto u = [&] { return static_cast<float>(random() % 20'001) / 10'000.0f - 1; };
    const Vec3 d = normalize(Vec3(u() + 0.00001f, u(), u()));
    const Spectrum s = map.lookup(d);
    EXPECT_LT(length_squared(Vec3(s[0], s[1], s[2]) - d), sqr(0.03f));
  }
}

TEST(Ibl, WhiteFurnaceGivesOne) {
  const auto white = [](const Direction&) { return Rgb{1, 1, 1}; };
  for (const Image& image : {equirectangular(64, white), octahedral(32, white), cube_strip(16, white)}) {
    const Ibl ibl = bake_ibl(image, small());
    for (const SpecularLevel& level : ibl.specular) {
      EXPECT_NEAR(means_of(level.faces).largest, 1, 1e-4) << layout_name(ibl.layout);
      EXPECT_NEAR(means_of(level.faces).least, 1, 1e-4) << layout_name(ibl.layout);
    }
    EXPECT_NEAR(means_of(*ibl.irradiance).largest, 1, 1e-4);
    EXPECT_NEAR(means_of(*ibl.irradiance).least, 1, 1e-4);
    EXPECT_NEAR(irradiance_at(*ibl.sh, {0.6f, 0, 0.8f}, 2).g, 1, 1e-4);
    EXPECT_EQ(ibl.sun_texels, 0u);
  }
}

TEST(Ibl, LayoutsOfOneEnvironmentGiveTheSameMaps) {
  const Ibl a = bake_ibl(equirectangular(256, smooth), small()), b = bake_ibl(octahedral(160, smooth), small()),
            c = bake_ibl(cube_strip(64, smooth), small());
  for (std::size_t level = 0; level < a.specular.size(); ++level)
    for (std::size_t i = 0; i < a.specular[level].faces.pixels.size(); ++i) {
      ASSERT_NEAR(a.specular[level].faces.pixels[i], c.specular[level].faces.pixels[i], 4e-3f);
      ASSERT_NEAR(b.specular[level].faces.pixels[i], c.specular[level].faces.pixels[i], 1e-2f);
    }
}

TEST(Ibl, LevelsAreTheIntegralOverTheLobe) {
  const Image image = equirectangular(256, lively);
  IblSettings settings = small();
  for (const LobeWeight weight : {LobeWeight::cosine, LobeWeight::masking}) {
    settings.weight = weight;
    const Ibl ibl = bake_ibl(image, settings);
    for (std::size_t i = 1; i < ibl.specular.size(); ++i) {
      const SpecularLevel& level = ibl.specular[i];
      const CubeMap map = cube_of(level.faces);
      double differences = 0, squares = 0;
      for (int k = 0; k < 60; ++k) {
        const int face = k % 6, x = (k * 7) % map.size(), y = (k * 5) % map.size();
        const double truth = prefiltered(image, map.direction(face, x, y), static_cast<double>(level.alpha), weight);
        differences += sqr(static_cast<double>(map.texel(face, x, y)[0]) - truth);
        squares += sqr(truth);
      }
      EXPECT_LT(std::sqrt(differences / squares), 0.01) << "alpha " << level.alpha;
    }
  }
}

TEST(Ibl, IrradianceIsTheIntegralOverTheCosine) {
  const Image image = equirectangular(256, lively);
  const CubeMap map = cube_of(*bake_ibl(image, small()).irradiance);
  for (int face = 0; face < 6; ++face) {
    const Direction n = map.direction(face, 2, 5);
    double sum = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        const double omega =
            2 * pi_d / image.width * (std::cos(pi_d * y / image.height) - std::cos(pi_d * (y + 1) / image.height));
        const double cos = static_cast<double>(dot(n, equirectangular_direction(x, y, image.width)));
        if (cos > 0) sum += omega * cos * static_cast<double>(image.at(x, y, 0)) / pi_d;
      }
    EXPECT_NEAR(static_cast<double>(map.texel(face, 2, 5)[0]) / sum, 1, 2e-3);
  }
}

TEST(Ibl, ReportedErrorsAreThoseOfTheMaps) {
  IblSettings settings = small();
  settings.checks = 30;
  const Ibl good = bake_ibl(equirectangular(256, lively), settings);
  settings.samples = 8;
  const Ibl bad = bake_ibl(equirectangular(256, lively), settings);
  for (std::size_t i = 1; i < good.specular.size(); ++i) {
    EXPECT_LT(good.specular[i].error->rms, 0.01);
    EXPECT_GT(bad.specular[i].error->rms, 3 * good.specular[i].error->rms);
    EXPECT_GE(bad.specular[i].error->max, bad.specular[i].error->rms);
  }
  EXPECT_LT(good.irradiance_error->rms, 2e-3);
}

// Rotating the image by a quarter turns x into z.
TEST(Ibl, TurnsWithTheEnvironment) {
  const Image image = equirectangular(256, lively);
  Image rolled = image;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (std::size_t c = 0; c < 3; ++c) rolled.at((x + image.width / 4) % image.width, y, c) = image.at(x, y, c);
  const Ibl a = bake_ibl(image, small()), b = bake_ibl(rolled, small());
  const auto difference = [](const Image& first, const Image& second) {
    const CubeMap u = cube_of(first), v = cube_of(second);
    double differences = 0, squares = 0;
    for (int face = 0; face < 6; ++face)
      for (int y = 0; y < u.size(); ++y)
        for (int x = 0; x < u.size(); ++x) {
          const Direction d = u.direction(face, x, y);
          const Spectrum s = u.texel(face, x, y), t = v.lookup({-d.z, d.y, d.x});
          for (int c = 0; c < 3; ++c) {
            differences += sqr(static_cast<double>(s[c] - t[c]));
            squares += sqr(static_cast<double>(s[c]));
          }
        }
    return std::sqrt(differences / squares);
  };
  for (std::size_t i = 0; i < a.specular.size(); ++i)
    EXPECT_LT(difference(a.specular[i].faces, b.specular[i].faces), 0.01);
  EXPECT_LT(difference(*a.irradiance, *b.irradiance), 1e-3);
  const Rgb e = irradiance_at(*a.sh, {0.6f, 0.64f, 0.48f}, 3), f = irradiance_at(*b.sh, {-0.48f, 0.64f, 0.6f}, 3);
  EXPECT_NEAR(e.r, f.r, 1e-3f * e.r);
}

// One texel of 10⁵ in a sky of 1.
class Sun : public testing::TestWithParam<std::pair<int, int>> {};

TEST_P(Sun, KeepsItsEnergyAndIsSmooth) {
  constexpr int width = 512;
  Image image = equirectangular(width, [](const Direction&) { return Rgb{1, 1, 1}; });
  const auto [x, y] = GetParam();
  set(image, x, y, {1e5f, 1e5f, 1e5f});
  const double omega = 2 * pi_d / width * (std::cos(2 * pi_d * y / width) - std::cos(2 * pi_d * (y + 1) / width));
  const double flux = (1e5 - 1) * omega, mean = 1 + flux / (4 * pi_d);
  const Ibl ibl = bake_ibl(image, small());
  EXPECT_EQ(ibl.sun_texels, 1u);
  EXPECT_NEAR(ibl.mean.r / mean, 1, 1e-2);
  for (const SpecularLevel& level : ibl.specular) {
    const Means found = means_of(level.faces);
    EXPECT_NEAR(found.mean / mean, 1, 0.01) << "alpha " << level.alpha;
    EXPECT_GE(found.least, 0.999);
    if (level.alpha == 0) continue;
    // Checks every texel, not only the mean: there is a single light, whose lobe is known.
    const CubeMap map = cube_of(level.faces);
    const Direction sun = equirectangular_direction(x, y, width);
    const double a2 = sqr(static_cast<double>(level.alpha));
    const auto lobe = [&](double cos) { return std::max(0.0, cos) / sqr(0.5 * (1 - cos) + a2 * 0.5 * (1 + cos)); };
    double integral = 0;
    constexpr int steps = 100'000;
    for (int i = 0; i < steps; ++i) integral += 2 * pi_d / steps * lobe((i + 0.5) / steps);
    for (int face = 0; face < 6; ++face)
      for (int v = 0; v < map.size(); ++v)
        for (int u = 0; u < map.size(); ++u) {
          const double truth = 1 + flux * lobe(static_cast<double>(dot(map.direction(face, u, v), sun))) / integral;
          ASSERT_NEAR(map.texel(face, u, v)[0], truth, 0.02 * truth) << "alpha " << level.alpha;
        }
  }
  EXPECT_NEAR(means_of(*ibl.irradiance).mean / mean, 1, 0.01);
  EXPECT_NEAR(ibl.sh->radiance[0].r * 0.28209479 / mean, 1, 0.01);
}

// Below the horizon, at an edge between faces, near a pole, at the picture's seam.
INSTANTIATE_TEST_SUITE_P(Places, Sun,
                         testing::Values(std::pair{300, 150}, std::pair{320, 128}, std::pair{77, 6},
                                         std::pair{511, 90}));

class SmallSun : public testing::TestWithParam<std::pair<int, int>> {};

// A sun is as bright in a mirror as in the image, and never brighter, wherever its texels fall on those of the map.
TEST_P(SmallSun, IsAsBrightAsInTheImage) {
  constexpr int width = 512;
  constexpr float sky = 0.2f, sun = 5000;
  Image image = equirectangular(width, [](const Direction&) { return Rgb{sky, sky, sky}; });
  const auto [x, y] = GetParam();
  set(image, x, y, {sun, sun, sun});
  const double omega = 2 * pi_d / width * (std::cos(2 * pi_d * y / width) - std::cos(2 * pi_d * (y + 1) / width));
  const double mean = static_cast<double>(sky) + static_cast<double>(sun - sky) * omega / (4 * pi_d);
  for (const int size : {64, 128, 512}) {
    IblSettings settings = small();
    settings.specular_size = size;
    settings.smallest_size = size;
    const Ibl ibl = bake_ibl(image, settings);
    ASSERT_EQ(ibl.specular.size(), 1u);
    const Image& faces = ibl.specular[0].faces;
    const float brightest = *std::max_element(faces.pixels.begin(), faces.pixels.end());
    EXPECT_LE(brightest, sun * 1.0001f) << size;
    EXPECT_NEAR(means_of(faces).mean / mean, 1, 2e-3) << size;
    const float least = size == width ? 0.999f * sun : sky;  // it fills texels of a map as fine as the image
    EXPECT_GE(brightest, least) << size;
  }
}

// An arbitrary place, an edge between faces, a corner of the cube, a place near a pole, one at the image's seam.
INSTANTIATE_TEST_SUITE_P(Places, SmallSun,
                         testing::Values(std::pair{300, 100}, std::pair{320, 128}, std::pair{320, 77},
                                         std::pair{77, 50}, std::pair{511, 90}));

TEST(Ibl, SunsOfWideTexelsAreNotPoints) {
  constexpr int width = 64;
  Image image = equirectangular(width, [](const Direction&) { return Rgb{1, 1, 1}; });
  set(image, 40, 12, {1e4f, 1e4f, 1e4f});
  IblSettings settings = small();
  const Ibl ibl = bake_ibl(image, settings);
  const double omega = 2 * pi_d / width * (std::cos(2 * pi_d * 12 / width) - std::cos(2 * pi_d * 13 / width));
  const double mean = 1 + 9999 * omega / (4 * pi_d);
  for (const SpecularLevel& level : ibl.specular) EXPECT_NEAR(means_of(level.faces).mean / mean, 1, 0.01);
  // A mirror shows the texel's radiance over the whole texel.
  EXPECT_NEAR(means_of(ibl.specular[0].faces).largest, 1e4, 4e3);
}

TEST(Ibl, IsTheSameForAnyNumberOfThreads) {
  const Image image = equirectangular(128, lively);
  const auto bake = [&](unsigned threads) {
    const ThreadLimit limit(threads);
    return bake_ibl(image, small());
  };
  const Ibl a = bake(1), b = bake(3);
  for (std::size_t i = 0; i < a.specular.size(); ++i) EXPECT_EQ(a.specular[i].faces.pixels, b.specular[i].faces.pixels);
  EXPECT_EQ(a.irradiance->pixels, b.irradiance->pixels);
  EXPECT_EQ(a.sh->radiance, b.sh->radiance);
}

TEST(Ibl, UnusableValuesCountAsBlackAndAreCounted) {
  Image image = equirectangular(64, [](const Direction&) { return Rgb{1, 1, 1}; });
  image.at(3, 4, 0) = -1;
  image.at(5, 6, 1) = infinity;
  image.at(7, 8, 2) = std::nanf("");
  image.at(9, 10, 2) = 3e38f;
  const Ibl ibl = bake_ibl(image, small());
  EXPECT_EQ(ibl.unusable_values, 4u);
  for (const SpecularLevel& level : ibl.specular)
    for (const float value : level.faces.pixels) ASSERT_TRUE(value >= 0 && value < 1.001f);
}

TEST(Ibl, OfTheLargestRadianceIsFinite) {
  const Image image = equirectangular(64, [](const Direction&) {
    return Rgb{largest_environment_radiance, largest_environment_radiance, largest_environment_radiance};
  });
  const Ibl ibl = bake_ibl(image, small());
  EXPECT_EQ(ibl.unusable_values, 0u);
  const auto expect_white = [](const Image& map) {
    for (const float value : map.pixels) ASSERT_NEAR(value / largest_environment_radiance, 1, 1e-4);
  };
  for (const SpecularLevel& level : ibl.specular) expect_white(level.faces);
  expect_white(*ibl.irradiance);
  EXPECT_NEAR(irradiance_at(*ibl.sh, {0, 1, 0}, 2).g / largest_environment_radiance, 1, 1e-4);
}

TEST(Ibl, SizesMustBePowersOfTwo) {
  const Image image = equirectangular(64, smooth);
  IblSettings settings = small();
  settings.specular_size = 48;
  EXPECT_THROW(bake_ibl(image, settings), Error);
  settings = small();
  settings.smallest_size = 128;
  EXPECT_THROW(bake_ibl(image, settings), Error);
  EXPECT_THROW(bake_ibl(Image(30, 20, {"R", "G", "B"}), small()), Error);
}

TEST(Ibl, MappingsGiveRoughness) {
  const Image image = equirectangular(64, smooth);
  IblSettings settings = small();
  settings.smallest_size = 4;  // five levels
  const auto middle = [&](RoughnessMapping mapping) {
    settings.mapping = mapping;
    return bake_ibl(image, settings).specular[2];
  };
  EXPECT_FLOAT_EQ(middle(RoughnessMapping::square).alpha, 0.25f);
  EXPECT_FLOAT_EQ(middle(RoughnessMapping::linear).alpha, 0.5f);
  const float r = middle(RoughnessMapping::filament).roughness;
  EXPECT_FLOAT_EQ(r * (2 - r), 0.5f);
}

TEST(SphericalHarmonics, AreOrthonormal) {
  std::array<std::array<double, 16>, 16> products{};
  constexpr int size = 64;
  const CubeMap map(size);
  const std::vector<float> omega = cube_solid_angles(size);
  for (int face = 0; face < 6; ++face)
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) {
        const auto basis = sh_basis(map.direction(face, x, y));
        for (std::size_t i = 0; i < 16; ++i)
          for (std::size_t j = 0; j < 16; ++j)
            products[i][j] += static_cast<double>(omega[static_cast<std::size_t>(y * size + x)] * basis[i] * basis[j]);
      }
  for (std::size_t i = 0; i < 16; ++i)
    for (std::size_t j = 0; j < 16; ++j) EXPECT_NEAR(products[i][j], i == j ? 1 : 0, 2e-3) << i << ' ' << j;
}

// A band's irradiance is its radiance times 1, 2/3, 1/4, 0: the projection of the cube map agrees.
TEST(SphericalHarmonics, AreTheProjectionOfTheIrradianceMap) {
  IblSettings settings = small();
  settings.irradiance_size = 32;
  const Ibl ibl = bake_ibl(equirectangular(256, lively), settings);
  const CubeMap map = cube_of(*ibl.irradiance);
  const std::vector<float> omega = cube_solid_angles(map.size());
  for (std::size_t i = 0; i < 16; ++i) {
    double sum = 0;
    for (int face = 0; face < 6; ++face)
      for (int y = 0; y < map.size(); ++y)
        for (int x = 0; x < map.size(); ++x)
          sum += static_cast<double>(omega[static_cast<std::size_t>(y * map.size() + x)] * map.texel(face, x, y)[0] *
                                     sh_basis(map.direction(face, x, y))[i]);
    EXPECT_NEAR(ibl.sh->irradiance[i].r, sum, 5e-3 * static_cast<double>(ibl.sh->irradiance[0].r)) << i;
  }
}

TEST(SphericalHarmonics, WindowLeavesNoNegativeIrradiance) {
  const auto lamp = [](const Direction& d) { return d.y > 0.99f ? Rgb{10, 10, 10} : Rgb{0, 0, 0}; };
  IblSettings settings = small();
  const auto below = [&] {
    const ShMaps sh = *bake_ibl(equirectangular(256, lamp), settings).sh;
    float least = infinity;
    const CubeMap map(16);
    for (int face = 0; face < 6; ++face)
      for (int i = 0; i < 256; ++i) {
        const Direction d = map.direction(face, i % 16, i / 16);
        least = std::min(least, irradiance_at(sh, {d.x, d.y, d.z}, 3).r);
      }
    return least;
  };
  EXPECT_LT(below(), -0.001f);
  settings.windowed = true;
  EXPECT_GE(below(), 0);
  EXPECT_LT(below(), 0.002f) << "the weakest window";
  EXPECT_EQ(bake_ibl(equirectangular(256, smooth), settings).sh->window, 0) << "nothing is negative";
}

// Integrates over light directions, with D and G of the closures.
TEST(BrdfTable, BruteForceIsTheIntegralOverTheHemisphere) {
  constexpr int steps = 400;
  for (const double alpha : {0.4, 1.0})
    for (const double cos : {0.3, 0.8}) {
      const TrowbridgeReitz ggx(static_cast<float>(alpha), static_cast<float>(alpha));
      const Vec3 v(std::sqrt(1 - cos * cos), 0, cos);
      double scale = 0, bias = 0;
      for (int i = 0; i < steps; ++i)
        for (int k = 0; k < steps; ++k) {
          const double z = (i + 0.5) / steps, across = std::sqrt(1 - z * z), phi = 2 * pi_d * (k + 0.5) / steps;
          const Vec3 l(across * std::cos(phi), across * std::sin(phi), z), h = normalize(v + l);
          const double brdf_cos = static_cast<double>(ggx.d(h) * ggx.g(v, l)) / (4 * cos);
          const double schlick = std::pow(1 - static_cast<double>(dot(v, h)), 5);
          scale += brdf_cos * (1 - schlick) * 2 * pi_d / (steps * steps);
          bias += brdf_cos * schlick * 2 * pi_d / (steps * steps);
        }
      const BrdfSums sums = integrate_brdf(cos, alpha);
      EXPECT_NEAR(sums.scale, scale, 5e-4) << alpha << ' ' << cos;
      EXPECT_NEAR(sums.bias, bias, 5e-4) << alpha << ' ' << cos;
    }
}

TEST(BrdfTable, ReportedErrorIsThatOfTheTable) {
  Image table = brdf_table(32, false);
  EXPECT_LT(brdf_table_error(table, 8).max, 2e-3);
  for (float& value : table.pixels) value *= 1.1f;
  EXPECT_NEAR(brdf_table_error(table, 8).rms, 0.1, 2e-3);
}

TEST(BrdfTable, IsTheIntegralOfTheBrdf) {
  constexpr int size = 64;
  const Image table = brdf_table(size, false);
  for (const int y : {9, 20, 31, 42, 53, 63})
    for (const int x : {0, 1, 3, 8, 20, 40, 63}) {
      const double roughness = (y + 0.5) / size;
      const BrdfSums truth = integrate_brdf((x + 0.5) / size, roughness * roughness);
      EXPECT_NEAR(table.at(x, y, 0), truth.scale, 1e-3) << x << ' ' << y;
      EXPECT_NEAR(table.at(x, y, 1), truth.bias, 1e-3) << x << ' ' << y;
    }
}

TEST(BrdfTable, OfAMirrorIsSchlicksTerm) {
  constexpr int size = 128;
  const Image table = brdf_table(size, false);
  for (const int x : {5, 40, 127}) {
    const double schlick = std::pow(1 - (x + 0.5) / size, 5);
    EXPECT_NEAR(table.at(x, 0, 0), 1 - schlick, 1e-3);
    EXPECT_NEAR(table.at(x, 0, 1), schlick, 1e-3);
  }
}

// D V cos over the hemisphere, with the formulas of Estevez & Kulla 2017 and Neubelt & Pettineo 2013.
TEST(BrdfTable, ThirdChannelIsTheAlbedoOfSheen) {
  constexpr int size = 32;
  const Image table = brdf_table(size, true), without = brdf_table(size, false);
  EXPECT_EQ(without.at(10, 20, 2), 0);
  for (const int y : {20, 31})
    for (const int x : {10, 20, 30}) {
      const double roughness = (y + 0.5) / size, alpha = roughness * roughness, cos_v = (x + 0.5) / size;
      const double sin_v = std::sqrt(1 - cos_v * cos_v);
      double sum = 0;
      constexpr int steps = 400;
      for (int i = 0; i < steps; ++i)
        for (int k = 0; k < steps; ++k) {
          const double cos_l = (i + 0.5) / steps, sin_l = std::sqrt(1 - cos_l * cos_l), phi = pi_d * (k + 0.5) / steps;
          const double hx = sin_v + sin_l * std::cos(phi), hy = sin_l * std::sin(phi), hz = cos_v + cos_l;
          const double sin_h = std::sqrt((hx * hx + hy * hy) / (hx * hx + hy * hy + hz * hz));
          const double d = (2 + 1 / alpha) * std::pow(sin_h, 1 / alpha) / (2 * pi_d);
          sum += d / (4 * (cos_l + cos_v - cos_l * cos_v)) * cos_l * 2 * pi_d / (steps * static_cast<double>(steps));
        }
      EXPECT_NEAR(table.at(x, y, 2), sum, 0.01 * sum + 1e-3);
    }
}

TEST(ContactSheet, HasARowForEachMap) {
  const Ibl ibl = bake_ibl(equirectangular(64, smooth), small());
  const Image sheet = contact_sheet(ibl);
  constexpr int left = 88, top = 14;  // of the labels
  EXPECT_EQ(sheet.width, left + 6 * 100 + 4);
  EXPECT_EQ(sheet.height, top + static_cast<int>(ibl.specular.size() + 2) * 100 + 4);
  EXPECT_NEAR(sheet.at(left + 4 + 48, top + 4 + 48, 0), smooth({1, 0, 0}).r, 0.02f);
}

// Its labels as dots: "+X" above the first face, "SPECULAR" and its roughness before the first row.
TEST(ContactSheet, HasLabels) {
  const Ibl ibl = bake_ibl(equirectangular(64, smooth), small());
  const Image sheet = contact_sheet(ibl);
  const auto text = [&](int left, int top, int characters) {
    std::string rows;
    for (int y = 0; y < 5; ++y, rows += '\n')
      for (int x = 0; x < 4 * characters - 1; ++x) rows += sheet.at(left + 2 * x, top + 2 * y, 1) > 0 ? '#' : ' ';
    return rows;
  };
  EXPECT_EQ(text(88 + 4, 4, 2),
            "    # #\n"
            " #  # #\n"
            "###  # \n"
            " #  # #\n"
            "    # #\n");
  EXPECT_EQ(text(4, 14 + 4, 2),
            "### ###\n"
            "#   # #\n"
            "### ###\n"
            "  # #  \n"
            "### #  \n");
  EXPECT_EQ(text(4, 14 + 4 + 14, 1).substr(0, 8), "###\n# #\n") << "0.00";
}

}  // namespace
}  // namespace lanthorn::ibl_test
