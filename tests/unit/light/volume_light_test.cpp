// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Media as lights: where their light paths start, and the densities that weights use.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "light/light.h"
#include "math/sampling.h"
#include "support/statistics.h"

namespace lanthorn::volume_light_test {
namespace {

using test::Mean;

const Wavelengths rgb = Wavelengths::rgb(0.5f);

// Twice as bright in its upper half, and blue only there. Its x axis is rotated and stretched in the world.
const Medium& flame() {
  static const Medium medium = [] {
    DensityMedium m;
    const Bounds box{Point(-1), Point(1)};
    m.to_medium = (translate({3, 1, -2}) * rotate(30, {0, 1, 0}) * scale({2, 1, 0.5f})).inverted();
    m.sigma_a = SpectrumCurve::constant(0.5f);
    m.sigma_s = SpectrumCurve::constant(0);
    m.density = GridDensity{{{1, 2, 1}, {1, 2}, box}};
    m.majorants = BlockGrid(box, 16, [](const Bounds&) { return 2.0f; });
    m.emission = SpectrumEmission{SpectrumCurve::constant(3), {}};
    return m;
  }();
  return medium;
}

// Its table only has the lower half.
VolumeLight light_of_flame() {
  const MediumBox place = *box_of(flame());
  BlockGrid emission(place.box, 4, [](const Bounds& block) { return block.min.y < 0 ? 1.0f : 0.0f; });
  return {&flame(), std::make_shared<const GlowTable>(std::move(emission), place), 1, 1};
}

constexpr int samples = 200'000;

// Directions to points of the table have the density that `pdf_direct` returns. From a point inside they cover the
// sphere; from outside, the part whose rays hit the box.
TEST(VolumeLight, DirectionsHaveTheirDensity) {
  const VolumeLight light = light_of_flame();
  HashRng rng(1);
  for (const Point& from : {Point(3, 1, -2), Point(2.5f, 3, 0.5f), Point(8, -1, 1)}) {
    Mean by_samples, by_sphere;
    const Direction axis = normalize(Point(3.2f, 1.1f, -2) - from);
    const auto tested = [&](const Direction& d) { return std::exp(3 * static_cast<double>(dot(d, axis))); };
    for (int i = 0; i < samples; ++i) {
      const auto s = light.sample_direct(from, rng.next2(), rgb);
      ASSERT_TRUE(s);
      ASSERT_NEAR(s->pdf / light.pdf_direct(from, s->wi), 1, 1e-5f);
      by_samples.add(tested(s->wi));
      const Direction anywhere = sample_uniform_sphere(rng.next2());
      by_sphere.add(tested(anywhere) * static_cast<double>(light.pdf_direct(from, anywhere) / pdf_uniform_sphere));
    }
    EXPECT_NEAR(by_samples.mean(), by_sphere.mean(), 5.5 * (by_samples.error() + by_sphere.error())) << from.x;
  }
}

// Over all rays of one direction, the density is 1 per area perpendicular to them; beyond the box it is 0.
TEST(VolumeLight, RaysHaveADensityPerArea) {
  const VolumeLight light = light_of_flame();
  const Direction along = normalize(Vec3(0.3f, -0.5f, 0.8f));
  const Frame frame(along);
  HashRng rng(2);
  Mean all;
  constexpr float side = 8;
  for (int i = 0; i < samples; ++i) {
    const Vec3 across = side * Vec3(rng.next() - 0.5f, rng.next() - 0.5f, 0);
    const Point end = Point(3, 1, -2) + frame.to_world(across) + 10.0f * along;
    all.add(static_cast<double>(side * side * light.pdf_emission({end, Normal(0), Vec2(0)}, along).position));
    EXPECT_EQ(light.pdf_emission({end - 20.0f * along, Normal(0), Vec2(0)}, along).position, 0);
  }
  EXPECT_NEAR(all.mean(), 1, 5 * all.error());
}

// 4 pi times the integral of emission over the box: 0.5 per metre, radiance 3, densities between 1 and 2, which fall to
// half within a cell of the faces: by a quarter of a cell each at the faces of y, by a quarter in all at those of x and
// z.
TEST(VolumeLight, PhotonsCarryThePower) {
  const VolumeLight light = light_of_flame();
  HashRng rng(3);
  Mean flux;
  for (int i = 0; i < samples; ++i) {
    const Vec2 position = rng.next2();
    const auto s = light.sample_emission(position, rng.next2(), rgb);
    ASSERT_TRUE(s);
    flux.add(static_cast<double>(s->flux[1]));
    ASSERT_NEAR(s->pdf_direction, pdf_uniform_sphere, 1e-7f);
  }
  Mean by_volume;
  const auto& medium = std::get<DensityMedium>(flame());
  for (int i = 0; i < samples; ++i) {
    const Point p(2 * rng.next() - 1, 2 * rng.next() - 1, 2 * rng.next() - 1);
    by_volume.add(4 * 3.14159265358979 * 8 * 0.5 * 3 * static_cast<double>(density_at(medium.density, p)));
  }
  EXPECT_NEAR(flux.mean(), by_volume.mean(), 5.5 * (flux.error() + by_volume.error()));
  EXPECT_LT(flux.error(), 0.01 * flux.mean());
}

}  // namespace
}  // namespace lanthorn::volume_light_test
