// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Compares filters with quadrature, and tests their samples by chi-squared tests. Further tests with random numbers
// check each sample, not means.
#include "film/filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "lanthorn/error.h"
#include "lanthorn/scene_description.h"
#include "math/hash.h"
#include "support/chi2.h"

namespace lanthorn::filter_test {
namespace {

const std::vector<FilterShape> shapes{BoxFilter{},
                                      BoxFilter{{1.3f, 0.4f}},
                                      TriangleFilter{},
                                      TriangleFilter{{0.5f, 3}},
                                      GaussianFilter{},
                                      MitchellFilter{},
                                      MitchellFilter{{3, 2}, 0, 1},
                                      SincFilter{},
                                      SincFilter{{2, 3}, 5},
                                      GaussianFilter{{4, 2}, 2}};

/// Integral of g(f(x, y)) over [x0, x1] x [y0, y1] by the midpoint rule.
template <class G>
double integrate(const Filter& filter, double x0, double x1, double y0, double y1, int steps, G&& g) {
  double sum = 0;
  const double dx = (x1 - x0) / steps, dy = (y1 - y0) / steps;
  for (int j = 0; j < steps; ++j)
    for (int i = 0; i < steps; ++i)
      sum += g(filter.evaluate({static_cast<float>(x0 + (i + 0.5) * dx), static_cast<float>(y0 + (j + 0.5) * dy)}));
  return sum * dx * dy;
}
double identity(float f) { return static_cast<double>(f); }
double magnitude(float f, FilterPart part) {
  return std::fmax(0.0, static_cast<double>(part == FilterPart::positive ? f : -f));
}
// The parts of a filter that are not 0.
std::vector<FilterPart> parts_of(const Filter& filter) {
  if (filter.negative_share() == 0) return {FilterPart::positive};
  return {FilterPart::positive, FilterPart::negative};
}

TEST(Filter, KnownValues) {
  EXPECT_EQ(Filter().evaluate({0.4f, -0.5f}), 1);
  EXPECT_EQ(Filter().evaluate({0.5f, 0}), 0);
  EXPECT_FLOAT_EQ(Filter(TriangleFilter{}).evaluate({0.5f, -1}), 1.5f);
  EXPECT_NEAR(Filter(GaussianFilter{}).evaluate({0, 0}), std::pow(1 - std::exp(-4.5f), 2), 1e-6);
  EXPECT_NEAR(Filter(MitchellFilter{}).evaluate({0, 0}), std::pow(16.0f / 18, 2), 1e-6);
  EXPECT_NEAR(Filter(MitchellFilter{}).evaluate({1, 0}), 1.0f / 18 * 16 / 18, 1e-6);
  EXPECT_NEAR(Filter(SincFilter{}).evaluate({0, 0.5f}), 2 / std::numbers::pi * (3 / std::numbers::pi), 1e-6);
  EXPECT_LT(Filter(SincFilter{}).evaluate({1.5f, 0}), 0);
  // Mitchell & Netravali's filters integrate to 1 over [-2, 2] for all B and C.
  EXPECT_NEAR(Filter(MitchellFilter{{2, 2}, 0.7f, 0.2f}).integral(), 1, 1e-5);
}

TEST(Filter, IntegralMatchesQuadrature) {
  for (const FilterShape& shape : shapes) {
    const Filter filter(shape);
    const Vec2 r = filter.radius();
    EXPECT_NEAR(integrate(filter, -r.x, r.x, -r.y, r.y, 400, identity) / static_cast<double>(filter.integral()), 1,
                1e-4)
        << shape.index();
  }
}

TEST(Filter, SharesAreThoseOfQuadrature) {
  for (const FilterShape& shape : shapes) {
    const Filter filter(shape);
    const Vec2 r = filter.radius();
    const double negative = integrate(filter, -r.x, r.x, -r.y, r.y, 400,
                                      [](float f) { return magnitude(f, FilterPart::negative); }),
                 all = integrate(filter, -r.x, r.x, -r.y, r.y, 400, identity);
    EXPECT_NEAR(filter.negative_share(), negative / all, 1e-3) << shape.index();
    HashRng rng(test::seed(1));
    for (const FilterPart part : parts_of(filter))
      for (int i = 0; i < 1000; ++i) {
        const Vec2 offset = filter.sample(rng.next2(), part);
        // Each cell of the sampler's table has one sign; the filter may change sign inside it, where it is near 0.
        const float f = filter.evaluate(offset);
        if (std::fabs(f) > 0.01f) {
          EXPECT_EQ(f > 0, part == FilterPart::positive) << offset.x << " " << offset.y;
        }
      }
  }
}

// As many as the least variance demands, to half a sample: n N / (1 + 2 N) of n.
TEST(Filter, EveryPrefixOfASequenceHasItsShareOfNegativeSamples) {
  for (const FilterShape& shape : shapes) {
    const Filter filter(shape);
    const auto n = static_cast<double>(filter.negative_share());
    std::uint64_t negative = 0;
    for (std::uint64_t i = 0; i < 5000; ++i) {
      const FilterPlace place = filter.place_of_sample(i);
      const bool is_negative = place.part == FilterPart::negative;
      ASSERT_EQ(place.number, is_negative ? negative : i - negative) << i;
      negative += is_negative ? 1 : 0;
      ASSERT_LE(std::fabs(static_cast<double>(negative) - n / (1 + 2 * n) * static_cast<double>(i + 1)), 0.5 + 1e-6)
          << i;
    }
    EXPECT_EQ(filter.place_of_sample(0).part, FilterPart::positive);
  }
  EXPECT_GT(Filter(SincFilter{}).negative_share(), 0.2f);
  EXPECT_EQ(Filter(GaussianFilter{}).negative_share(), 0);
}

double statistic_of(const Filter& filter, FilterPart part, int& used) {
  constexpr int cells = 24, samples = 200000;
  const auto of_part = [&](float f) { return magnitude(f, part); };
  const Vec2 r = filter.radius();
  std::vector<double> counts(cells * cells);
  HashRng rng(test::seed(2));
  for (int i = 0; i < samples; ++i) {
    const Vec2 at = (filter.sample(rng.next2(), part) + r) / (2.0f * r) * static_cast<float>(cells);
    EXPECT_TRUE(at.x >= 0 && at.x < cells && at.y >= 0 && at.y < cells);
    ++counts[static_cast<std::size_t>(at.y) * cells + static_cast<std::size_t>(at.x)];
  }
  const double total = integrate(filter, -r.x, r.x, -r.y, r.y, 480, of_part);
  double statistic = 0, rest_expected = 0, rest_observed = 0;
  for (int j = 0; j < cells; ++j)
    for (int i = 0; i < cells; ++i) {
      const auto edge = [&](int k, float radius) { return (2.0 * k / cells - 1) * static_cast<double>(radius); };
      const double expected =
          samples / total *
          integrate(filter, edge(i, r.x), edge(i + 1, r.x), edge(j, r.y), edge(j + 1, r.y), 20, of_part);
      const double observed = counts[static_cast<std::size_t>(j * cells + i)];
      if (expected < 10) {  // too few for the approximation: pool cells
        rest_expected += expected;
        rest_observed += observed;
        continue;
      }
      statistic += (observed - expected) * (observed - expected) / expected;
      ++used;
    }
  if (rest_expected >= 10) {
    statistic += (rest_observed - rest_expected) * (rest_observed - rest_expected) / rest_expected;
    ++used;
  }
  return statistic;
}

TEST(Filter, SamplesFollowTheFilter) {
  int tests = 0;
  for (const FilterShape& shape : shapes) tests += static_cast<int>(parts_of(Filter(shape)).size());
  for (const FilterShape& shape : shapes) {
    const Filter filter(shape);
    for (const FilterPart part : parts_of(filter)) {
      int used = 0;
      const double statistic = statistic_of(filter, part, used);
      EXPECT_TRUE(
          test::not_below(test::chi2_upper_tail(statistic, used - 1), test::sidak(test::false_alarm_rate, tests)))
          << shape.index() << ": " << statistic << " with " << used << " cells";
    }
  }
}

// Stratified and low-discrepancy numbers keep their structure only if the warp is monotonic and continuous. With lobes
// on both axes, it is so for each of the two products of their parts.
TEST(Filter, SamplingIsContinuous) {
  for (const FilterShape& shape : shapes) {
    const Filter filter(shape);
    for (const FilterPart part : parts_of(filter)) {
      constexpr int steps = 1 << 16;
      int starts = 0;
      float last = filter.radius().x;
      for (int i = 0; i < steps; ++i) {
        const float offset = filter.sample({static_cast<float>(i) / steps, 0}, part).x;
        starts += offset <= last ? 1 : 0;
        last = offset;
      }
      EXPECT_LE(starts, filter.negative_share() == 0 ? 1 : 2) << shape.index();
    }
  }
}

// Splats and samples must reconstruct equally: the mean weight of a splat in a pixel, over raster positions, is the
// filter's share.
TEST(Filter, SplatsReconstructLikeSamples) {
  for (const FilterShape& shape : shapes) {
    const Filter filter(shape);
    constexpr int steps = 800;
    double sum = 0, moment = 0;
    for (int j = 0; j < steps; ++j)
      for (int i = 0; i < steps; ++i) {
        const Vec2 p((static_cast<float>(i) + 0.5f) * 10 / steps, (static_cast<float>(j) + 0.5f) * 10 / steps);
        filter.for_each_pixel(p, 10, 10, [&](int x, int y, float weight) {
          if (x != 5 || y != 4) return;
          sum += static_cast<double>(weight);
          moment += static_cast<double>(weight) * static_cast<double>(p.x - 5.5f);
        });
      }
    EXPECT_NEAR(sum / (steps * steps) * 100, 1, 5e-3) << shape.index();
    EXPECT_NEAR(moment / (steps * steps) * 100, 0, 5e-3) << shape.index();
  }
}

TEST(Filter, TheBoxCoversEachPositionOnce) {
  const Filter box;
  HashRng rng(test::seed(3));
  for (int i = 0; i < 100000; ++i) {
    Vec2 p = 64.0f * rng.next2();
    if (i % 4 == 0) p.x = std::floor(p.x);
    if (i % 4 == 1) p.y = std::nextafter(std::ceil(p.y), 0.0f);
    int visits = 0;
    box.for_each_pixel(p, 64, 64, [&](int x, int y, float weight) {
      ++visits;
      EXPECT_EQ(weight, 1);
      EXPECT_EQ(x, static_cast<int>(p.x));
      EXPECT_EQ(y, static_cast<int>(p.y));
    });
    EXPECT_EQ(visits, 1) << p.x << " " << p.y;
  }
  box.for_each_pixel({-0.1f, 3}, 64, 64, [](int, int, float) { ADD_FAILURE() << "outside"; });
  box.for_each_pixel({NAN, 3}, 64, 64, [](int, int, float) { ADD_FAILURE() << "nowhere"; });
}

TEST(Filter, RefusesWhatCannotBeNormalised) {
  EXPECT_THROW(Filter(BoxFilter{{0, 1}}), Error);
  EXPECT_THROW(Filter(BoxFilter{{1, NAN}}), Error);
  EXPECT_THROW(Filter(GaussianFilter{{1, 1}, 0}), Error);
  EXPECT_THROW(Filter(SincFilter{{1, 1}, -3}), Error);
  EXPECT_THROW(Filter(GaussianFilter{{1e-3f, 1}, 100}), Error) << "0 in single precision";
}

TEST(Filter, IsBuiltFromASceneFilesChoice) {
  description::Filter filter{description::FilterKind::mitchell, {3, 2}, 0.5f, 0.2f, 0.4f, 3};
  const auto shape = std::get<MitchellFilter>(filter_shape(filter));
  EXPECT_EQ(shape.radius, Vec2(3, 2));
  EXPECT_EQ(shape.b, 0.2f);
  EXPECT_EQ(shape.c, 0.4f);
  filter.kind = description::FilterKind::gaussian;
  EXPECT_EQ(std::get<GaussianFilter>(filter_shape(filter)).sigma, 0.5f);
}

}  // namespace
}  // namespace lanthorn::filter_test
