// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// A toy light with optional parts: without any part that its traits require it does not satisfy the concept, and could
// not become one of the alternatives of `Light`.
#include <gtest/gtest.h>

#include <type_traits>

#include "light/light.h"

namespace lanthorn::light_source_test {
namespace {

enum class Part {
  traits,
  sample_direct,
  sample_emission,
  pdf_emission,
  invert_emission,
  power,
  largest_radiance,
  bounds,
  pdf_direct,
  emitted,
  invisible,
  none
};

template <bool surface, bool infinite, bool far>
struct WithTraits {
  static constexpr LightTraits traits{.name = "toy", .has_surface = surface, .is_infinite = infinite, .is_far = far};
};
struct WithoutTraits {};
struct WithInvisible {
  bool invisible = false;
};
struct WithoutInvisible {};

// A black light. `At`: argument that says where it is seen, a hit or a direction.
template <Part missing, class Traits, class At>
struct Toy : std::conditional_t<missing == Part::traits, WithoutTraits, Traits>,
             std::conditional_t<missing == Part::invisible, WithoutInvisible, WithInvisible> {
  std::optional<LightSample> sample_direct(const Point&, const Vec2&, const Wavelengths&) const
      requires(missing != Part::sample_direct) {
    return {};
  }
  std::optional<EmissionSample> sample_emission(const Vec2&, const Vec2&, const Wavelengths&) const
      requires(missing != Part::sample_emission) {
    return {};
  }
  EmissionPdf pdf_emission(const EmitterHit&, const Direction&) const requires(missing != Part::pdf_emission) {
    return {};
  }
  EmissionNumbers invert_emission(const EmitterHit&, const Direction&) const
      requires(missing != Part::invert_emission) {
    return {};
  }
  float power() const requires(missing != Part::power) { return 0; }
  float largest_radiance(float) const requires(missing != Part::largest_radiance) { return 0; }
  EmissionBounds bounds() const requires(missing != Part::bounds) { return {}; }
  float pdf_direct(const Point&, const At&) const requires(missing != Part::pdf_direct) { return 0; }
  Spectrum emitted(const std::conditional_t<std::is_same_v<At, EmitterHit>, EmitterHit, Point>&, const Direction&,
                   const Wavelengths&) const requires(missing != Part::emitted) {
    return {};
  }
};

template <Part missing>
using Lamp = Toy<missing, WithTraits<true, false, false>, EmitterHit>;
template <Part missing>
using Sky = Toy<missing, WithTraits<false, true, true>, Direction>;
template <Part missing>
using Spark = Toy<missing, WithTraits<false, false, false>, Direction>;

TEST(LightSource, ToysAre) {
  static_assert(LightSource<Lamp<Part::none>>);
  static_assert(LightSource<Sky<Part::none>>);
  static_assert(LightSource<Spark<Part::none>>);
}

TEST(LightSource, MissNothingThatAllHave) {
  static_assert(!LightSource<Spark<Part::traits>>);
  static_assert(!LightSource<Spark<Part::sample_direct>>);
  static_assert(!LightSource<Spark<Part::sample_emission>>);
  static_assert(!LightSource<Spark<Part::pdf_emission>>);
  static_assert(!LightSource<Spark<Part::invert_emission>>);
  static_assert(!LightSource<Spark<Part::power>>);
  static_assert(!LightSource<Spark<Part::largest_radiance>>);
}

TEST(LightSource, HaveWhatTheirTraitsAskFor) {
  static_assert(!LightSource<Lamp<Part::pdf_direct>>);
  static_assert(!LightSource<Lamp<Part::emitted>>);
  static_assert(!LightSource<Lamp<Part::invisible>>);
  static_assert(!LightSource<Lamp<Part::bounds>>);
  static_assert(!LightSource<Sky<Part::pdf_direct>>);
  static_assert(!LightSource<Sky<Part::emitted>>);
  static_assert(!LightSource<Spark<Part::bounds>>);
  static_assert(LightSource<Sky<Part::bounds>>);
  static_assert(LightSource<Spark<Part::pdf_direct>>);
  static_assert(LightSource<Spark<Part::emitted>>);
}

/// Traits agree with the functions that depend on them.
TEST(LightSource, TraitsOfLights) {
  const auto expect = [](const Light& light, bool surface, bool infinite, bool far, bool delta) {
    EXPECT_EQ(has_surface(light), surface) << light.index();
    EXPECT_EQ(is_infinite(light), infinite) << light.index();
    EXPECT_EQ(is_far(light), far) << light.index();
    EXPECT_EQ(is_delta(light), delta) << light.index();
  };
  expect(AreaLight{}, true, false, false, false);
  AreaLight invisible;
  invisible.invisible = true;
  expect(invisible, true, false, false, true);
  expect(EvenPointLight{}, false, false, false, true);
  expect(SpotLight{}, false, false, false, true);
  expect(GoniometricLight{}, false, false, false, true);
  expect(ProjectionLight{}, false, false, false, true);
  expect(DistantLight{}, false, false, true, true);
  expect(SunLight{}, false, true, true, false);
  expect(EvenSky{}, false, true, true, false);
  expect(ImageSky{}, false, true, true, false);
  expect(PortalLight{}, false, true, true, false);
  expect(VolumeLight{}, false, false, false, false);
  EXPECT_TRUE(is_volume(VolumeLight{}));
  EXPECT_FALSE(is_volume(EvenPointLight{}));
  EXPECT_TRUE(emission_bounds(EvenPointLight{}));
  EXPECT_FALSE(emission_bounds(DistantLight{}));
}

}  // namespace
}  // namespace lanthorn::light_source_test
