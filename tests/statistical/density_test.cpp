// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Density estimates on a uniformly lit plane: for points of a uniform field, the expected estimate is the field's
// density.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "index/bucket_kdtree.h"
#include "index/hash_grid.h"
#include "math/hash.h"
#include "photon/gather/kernels.h"
#include "photon/gather/radiance_estimate.h"
#include "photon/photon_map.h"
#include "support/statistics.h"

namespace lanthorn::density_test {
namespace {

constexpr std::array<Kernel, 4> kernels{
    {{KernelShape::box}, {KernelShape::cone}, {KernelShape::epanechnikov}, {KernelShape::gaussian}}};
constexpr std::array kernel_names{"box", "cone", "epanechnikov", "gaussian"};
constexpr float side = 500;  // of the lit square, whose density is 1 per unit of area
constexpr float margin = 15;
constexpr int fields = 32;

/// Uniform points on an oblique plane, and the map onto it.
struct Field {
  explicit Field(std::uint64_t seed) : points(static_cast<std::size_t>(side * side)) {
    HashRng rng(seed);
    for (Point& p : points) {
      const float x = rng.next();
      p = at(side * x, side * rng.next());
    }
  }
  static Point at(float x, float y) { return x * Vec3(0.6f, 0.8f, 0) + y * Vec3(0.48f, -0.36f, 0.8f); }

  /// Calls `visit` with query points at this spacing, far from the border.
  template <class Visit>
  static void for_each_query(float spacing, Visit&& visit) {
    for (float y = margin; y < side - margin; y += spacing)
      for (float x = margin; x < side - margin; x += spacing) visit(at(x, y));
  }

  std::vector<Point> points;
};

using test::Mean;

/// One of four checks.
void expect_mean(const Mean& m, double expected, const std::string& what) {
  EXPECT_LT(m.error(), 0.001) << what << ": too few samples to tell";
  EXPECT_TRUE(test::agrees(m, expected, test::z_limit(test::sidak(test::false_alarm_rate, 4)))) << what;
}

double estimate(const Kernel& kernel, std::span<const Neighbour> found, std::size_t k) {
  const auto disc = gather_disc(found, k, infinity);
  double sum = 0;
  if (disc)
    for (const Neighbour& n : disc->counted) sum += kernel.weight(n.dist2, disc->support2);
  return sum;
}

class NearestDensity : public testing::TestWithParam<std::size_t> {};

TEST_P(NearestDensity, IsRightForEveryKernel) {
  const std::size_t k = GetParam();
  // Hardly any two queries share points: the radius is sqrt(k / pi) on average.
  const float spacing = 2.5f * std::sqrt(static_cast<float>(k) / pi);
  std::array<Mean, kernels.size()> means;
  std::vector<Neighbour> memory(k);
  for (std::uint64_t seed = 0; seed < fields; ++seed) {
    const auto [tree, order] = BucketKdTree::build(Field(test::seed(seed)).points);
    Field::for_each_query(spacing, [&](const Point& q) {
      const auto found = tree.nearest(q, infinity, memory);
      for (std::size_t i = 0; i < kernels.size(); ++i) means[i].add(estimate(kernels[i], found, k));
    });
  }
  for (std::size_t i = 0; i < kernels.size(); ++i) expect_mean(means[i], 1, kernel_names[i]);
}

INSTANTIATE_TEST_SUITE_P(Photons, NearestDensity, testing::Values(10, 50));

// Half of the photons are on the other side of the surface. Only photons on this side are counted up to k, so their
// density is correct.
TEST(EstimateDensity, PhotonsOfTheOtherSideDoNotCount) {
  constexpr std::size_t k = 20;
  Mean density, photons, counted;
  for (std::uint64_t seed = 0; seed < fields; ++seed) {
    std::vector<Photon> all;
    HashRng rng(test::seed(seed + fields));
    for (const Point& p : Field(test::seed(seed)).points) {
      const Direction wi(0, 0, rng.next() < 0.5f ? 1.0f : -1.0f);
      all.push_back({Spectrum(1), p, wi, Normal(0, 0, 1), {.eye_scatterings = 9}});
    }
    const auto map = PhotonMap<BucketKdTree>::build(all, ColorMode::rgb);
    Field::for_each_query(3 * std::sqrt(2.0f * k / pi), [&](const Point& q) {
      const DensityEstimate estimate = estimate_density(
          map, q, {{KernelShape::epanechnikov}, k, infinity}, [](const auto& photon, float) -> std::optional<Spectrum> {
            return photon.wi().z > 0 ? std::optional(photon.power()) : std::nullopt;
          });
      density.add(static_cast<double>(estimate.light[0]));
      photons.add(static_cast<double>(estimate.photons));
      counted.add(static_cast<double>(static_cast<float>(estimate.photons) * inv_pi / sqr(estimate.radius)));
    });
  }
  EXPECT_EQ(photons.mean(), static_cast<double>(k) - 1);
  const double z = test::z_limit(test::sidak(test::false_alarm_rate, 2));
  EXPECT_TRUE(test::agrees(counted, 0.5, z));
  EXPECT_TRUE(test::agrees(density, 0.5, z));
  EXPECT_LT(density.error(), 0.002);
}

// One half of the field is nine times as bright as the other. Considers points of the darker half whose nearest photons
// reach across the border.
TEST(EstimateDensity, DifferentialCheckingKeepsBordersOfLight) {
  Mean plain, checked, even;  // of fields
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    std::vector<Photon> all, same;
    HashRng rng(test::seed(seed));
    for (int i = 0; i < 1600; ++i) {  // one per unit of area
      const Vec2 u = rng.next2();
      const Point p(40 * u.x - 20, 40 * u.y - 20, 0);
      same.push_back({Spectrum(1), p, {0, 0, 1}, {0, 0, 1}, {.eye_scatterings = 9}});
      all.push_back(same.back());
      if (p.x > 0) all.back().power = Spectrum(9);
    }
    const auto halves = PhotonMap<BucketKdTree>::build(all, ColorMode::rgb);
    const auto uniform = PhotonMap<BucketKdTree>::build(same, ColorMode::rgb);
    const auto estimate = [](const auto& map, const Point& q, float differential) {
      const auto bring = [](const auto& photon, float) { return std::optional(photon.power()); };
      const EstimateSettings settings{{KernelShape::box}, 50, infinity, differential};
      return static_cast<double>(estimate_density(map, q, settings, bring).light[0]);
    };
    double in_plain = 0, in_checked = 0, in_even = 0;
    constexpr int queries = 17;  // that use the same photons
    for (int i = 0; i < queries; ++i) {
      const Point q(-2.5f, 0.5f * static_cast<float>(i) - 4, 0);
      in_plain += estimate(halves, q, 0) / queries;
      in_checked += estimate(halves, q, 0.5f) / queries;
      in_even += estimate(uniform, q, 0.5f) / queries;
    }
    plain.add(in_plain);
    checked.add(in_checked);
    even.add(in_even);
  }
  EXPECT_GT(plain.mean(), 1.9) << plain.error();
  EXPECT_LT(checked.mean(), 1.5) << checked.error();
  EXPECT_NEAR(even.mean(), 1, 0.05) << even.error();
}

TEST(FixedRadiusDensity, IsRightForEveryKernel) {
  constexpr float radius = 1.5f;
  const float widest = Kernel{KernelShape::gaussian}.support(radius);
  std::array<Mean, kernels.size()> means;
  for (std::uint64_t seed = 0; seed < fields; ++seed) {
    const auto [grid, order] = HashGrid::build(Field(test::seed(seed)).points, widest);
    Field::for_each_query(3, [&](const Point& q) {
      for (std::size_t i = 0; i < kernels.size(); ++i) {
        const Kernel kernel = kernels[i];
        const float support = kernel.support(radius);
        double sum = 0;
        grid.for_each_near(q, support,
                           [&](std::uint32_t, float dist2) { sum += kernel.weight(dist2, support * support); });
        means[i].add(sum);
      }
    });
  }
  for (std::size_t i = 0; i < kernels.size(); ++i) expect_mean(means[i], 1, kernel_names[i]);
}

}  // namespace
}  // namespace lanthorn::density_test
