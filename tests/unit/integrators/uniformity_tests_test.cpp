// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "integrators/vcm/uniformity_tests.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "integrators/vcm/merge_radii.h"
#include "support/error_text.h"

namespace lanthorn::uniformity_tests_test {
namespace {

constexpr double alpha = 0.5;
constexpr unsigned all_tests = UniformityTests::histories - 1;
constexpr PixelWindow window{0, 0, 5, 3};
constexpr std::uint32_t middle = 7;

enum class Photons : std::uint8_t { none, even, in_one_half, dense_in_the_middle };

// The tests after `passes` passes. In each pass 60 photons or none hit the centre pixel.
UniformityTests after(std::uint32_t passes, Photons photons, std::optional<std::uint32_t> obstructed = {}) {
  UniformityTests tests(window);
  std::mt19937 random(7);
  std::uniform_real_distribution<float> uniform(-1, 1);
  for (std::uint32_t pass = 0; pass < passes; ++pass) {
    EXPECT_EQ(tests.seeks_obstacles(), pass == 0);
    if (pass == 0 && obstructed) tests.note_obstacle(*obstructed);
    for (int i = 0; i < 60 && photons != Photons::none; ++i) {
      Vec3 p(uniform(random), uniform(random), 0);
      if (photons == Photons::in_one_half) p.x = std::fabs(p.x);
      if (photons == Photons::dense_in_the_middle) p *= length_squared(p);
      if (length_squared(p) < 1) tests.count(middle, p, length_squared(p));
    }
    tests.end_pass();
  }
  return tests;
}

TEST(UniformityTests, PassWherePhotonsAreEven) {
  for (const std::optional<std::uint32_t> obstructed : {std::optional<std::uint32_t>(), std::optional(middle)})
    EXPECT_EQ(after(16, Photons::even, obstructed).passed(middle), all_tests);
}

TEST(UniformityTests, FailWherePhotonsAreUneven) {
  for (const Photons photons : {Photons::in_one_half, Photons::dense_in_the_middle})
    EXPECT_EQ(after(16, photons).passed(middle), 0u);
}

TEST(UniformityTests, TrustFewPhotonsOnlyWhereAllDiscsAroundAreClear) {
  EXPECT_EQ(after(16, Photons::none).passed(middle), all_tests);
  for (const std::uint32_t near : {1u, 2u, 3u, 6u, 7u, 8u, 11u, 12u, 13u})
    EXPECT_EQ(after(16, Photons::none, near).passed(middle), 0u) << near;
  for (const std::uint32_t far : {0u, 5u, 10u, 4u, 9u, 14u})
    EXPECT_EQ(after(16, Photons::none, far).passed(middle), all_tests) << far;
}

// A distribution that was uneven at first may be even in the smaller disc.
TEST(UniformityTests, CountAgainAfterAFailure) {
  UniformityTests tests(window);
  for (std::uint32_t pass = 0; pass < 16; ++pass) {
    for (int i = 0; i < 64; ++i) {
      const bool one_side = pass < 2;
      const float x = one_side || (i & 1) != 0 ? 0.1f : -0.1f, y = (i & 2) != 0 ? 0.1f : -0.1f;
      tests.count(middle, {x, y, 0}, (i & 4) != 0 ? 0.9f : 0.1f);
    }
    tests.end_pass();
  }
  EXPECT_EQ(tests.passed(middle), all_tests - 1 - 2) << "all but the first two";
}

TEST(UniformityTests, AreMadeAfterPowersOfTwoPasses) {
  const std::uint32_t expected[] = {0, 1, 3, 3, 7, 7, 7, 7, 15, 15, 15, 15, 15, 15, 15, 15, 31};
  for (std::uint32_t passes = 0; passes <= 16; ++passes) {
    const UniformityTests tests = after(passes, Photons::none);
    EXPECT_EQ(tests.passes_counted(), passes);
    EXPECT_EQ(tests.passed(middle), expected[passes]) << passes;
    EXPECT_EQ(tests.are_done(), passes == 16);
  }
}

TEST(UniformityTests, AreSavedAndLoaded) {
  const UniformityTests made = after(16, Photons::in_one_half, 0);
  std::vector<std::byte> bytes = made.save();
  UniformityTests loaded(window);
  loaded.load(bytes);
  EXPECT_TRUE(loaded.are_done());
  for (std::uint32_t pixel = 0; pixel < made.pixel_count(); ++pixel)
    EXPECT_EQ(loaded.passed(pixel), made.passed(pixel)) << pixel;
  bytes.back() = std::byte{32};
  EXPECT_EQ(test::error_text([&] { loaded.load(bytes); }), "damaged: its radii are not those of this render");
  bytes.pop_back();
  EXPECT_EQ(test::error_text([&] { loaded.load(bytes); }), "damaged: its radii do not match the picture's pixels");
}

float area(const UniformityTests& tests, std::uint32_t pass, double light_paths = 1) {
  return sqr(MergeShrinks(tests, alpha, pass, light_paths).at(middle));
}
float area_by(double schedule, std::uint32_t pass, double light_paths = 1) {
  return sqr(merge_radius_shrink(schedule, pass, light_paths));
}

TEST(MergeShrinks, FollowTheTests) {
  const UniformityTests even = after(16, Photons::even), uneven = after(16, Photons::in_one_half);
  for (const double light_paths : {0.25, 1.0, 4.0})
    for (std::uint32_t pass = 0; pass <= 16; ++pass) {
      EXPECT_FLOAT_EQ(area(even, pass, light_paths), area_by(pass == 0 ? alpha : 0.9, pass, light_paths)) << pass;
      EXPECT_GE(area(uneven, pass, light_paths), area_by(alpha, pass, light_paths)) << pass;
      EXPECT_LE(area(uneven, pass, light_paths), area(even, pass, light_paths)) << pass;
    }
  EXPECT_FLOAT_EQ(area(uneven, 1), area_by(alpha, 1)) << "more than half of the first";
  EXPECT_FLOAT_EQ(area(uneven, 1, 4), area_by(0.9, 0, 4) / 2) << "not less than half";
  for (std::uint32_t pass = 4; pass <= 16; ++pass) EXPECT_FLOAT_EQ(area(uneven, pass, 4), area_by(alpha, pass, 4));
}

TEST(MergeShrinks, ShrinkAlikeEverywhereAfterTheTests) {
  const UniformityTests even = after(16, Photons::even);
  for (const std::uint32_t pass : {17u, 64u, 1000u})
    EXPECT_NEAR(area(even, pass) / area(even, 16), area_by(2.0 / 3, pass) / area_by(2.0 / 3, 16), 1e-5);
}

// A pass keeps its radii when later passes have been counted: a merged state may get earlier passes afterwards.
TEST(MergeShrinks, OfAPassStayTheSameLater) {
  for (const Photons photons : {Photons::even, Photons::in_one_half})
    for (std::uint32_t pass = 0; pass < 16; ++pass)
      EXPECT_EQ(area(after(16, photons), pass), area(after(pass, photons), pass)) << pass;
}

TEST(MergeShrinks, AreAtMostTheLargest) {
  const UniformityTests tests = after(16, Photons::in_one_half, 0);
  for (const std::uint32_t pass : {0u, 3u, 16u, 100u}) {
    const MergeShrinks shrinks(tests, alpha, pass, 1);
    double sum = 0;
    float largest = 0;
    for (std::uint32_t pixel = 0; pixel < tests.pixel_count(); ++pixel) {
      sum += static_cast<double>(shrinks.at(pixel));
      largest = std::max(largest, shrinks.at(pixel));
    }
    EXPECT_EQ(shrinks.largest(), largest);
    EXPECT_FLOAT_EQ(shrinks.mean(), static_cast<float>(sum / 15));
  }
}

}  // namespace
}  // namespace lanthorn::uniformity_tests_test
