// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "cache/bucket_kdtree.h"
#include "cache/hash_grid.h"
#include "cache/kernels.h"
#include "cache/left_balanced_kdtree.h"
#include "cache/photon.h"
#include "cache/photon_map.h"
#include "cache/radius_schedule.h"
#include "math/hash.h"
#include "math/sampling.h"

namespace lanthorn {
namespace {

static_assert(PointIndex<HashGrid>);
static_assert(NearestIndex<BucketKdTree>);
static_assert(NearestIndex<LeftBalancedKdTree>);

struct PointSet {
  std::string name;
  std::vector<Point> points;
  float scale;  ///< a radius that finds some of the points
};

Point random_point(HashRng& rng) { return {rng.next(), rng.next(), rng.next()}; }

std::vector<Point> lattice(int side, float spacing) {
  std::vector<Point> points;
  for (int i = 0; i < side * side * side; ++i)
    points.push_back(spacing * Point(static_cast<float>(i % side), static_cast<float>(i / side % side),
                                     static_cast<float>(i / side / side)));
  return points;
}

std::vector<PointSet> point_sets() {
  HashRng rng(7);
  const auto generate = [&rng](std::size_t count, auto&& point) {
    std::vector<Point> points(count);
    for (Point& p : points) p = point(rng);
    return points;
  };
  const auto cluster = [](HashRng& r) {
    const float spread = std::exp2(-20 * r.next());
    return Point(0.25f, 0.5f, 0.75f) + spread * (random_point(r) - Point(0.5f));
  };
  const auto line = [](HashRng& r) {
    const float t = r.next();
    return Point(1 + t, 2 - t, 3 + 2 * t);
  };
  std::vector<PointSet> sets;
  sets.push_back({"none", {}, 0.1f});
  sets.push_back({"one", {{1, 2, 3}}, 0.1f});
  sets.push_back({"random", generate(3000, random_point), 0.1f});
  sets.push_back({"clustered", generate(3000, cluster), 0.01f});
  sets.push_back({"collinear", generate(2000, line), 0.05f});
  sets.push_back({"along x", generate(2000, [](HashRng& r) { return Point(r.next(), 4, 5); }), 0.01f});
  sets.push_back({"plane", generate(3000, [](HashRng& r) { return Point(r.next(), -1, r.next()); }), 0.03f});
  sets.push_back({"all equal", std::vector<Point>(500, Point(0.1f, 0.2f, 0.3f)), 0.1f});
  sets.push_back({"duplicates", generate(2000, [](HashRng& r) { return glm::floor(4.0f * random_point(r)); }), 1.0f});
  sets.push_back({"lattice", lattice(12, 1), 2.0f});
  sets.push_back({"huge", generate(2000, [](HashRng& r) { return 1e9f * (random_point(r) - Point(0.5f)); }), 1e8f});
  sets.push_back(
      {"far away", generate(2000, [](HashRng& r) { return Point(1e7f) + 100.0f * random_point(r); }), 10.0f});
  sets.push_back({"tiny", generate(2000, [](HashRng& r) { return 1e-12f * random_point(r); }), 1e-13f});
  sets.push_back({"two far clusters",
                  generate(2000, [](HashRng& r) { return random_point(r) + Point(r.next() < 0.5f ? 0.0f : 1e6f); }),
                  0.2f});
  return sets;
}

/// Points of the set, points near them, and points off it.
std::vector<Point> queries_for(const PointSet& set) {
  HashRng rng(11);
  std::vector<Point> queries{{0, 0, 0}, {-1, 0.5f, 3}, {1e5f, -1e5f, 0}};
  for (int i = 0; i < 60 && !set.points.empty(); ++i) {
    const Point& p = set.points[static_cast<std::size_t>(rng.next() * static_cast<float>(set.points.size()))];
    queries.push_back(p);
    queries.push_back(p + 2 * set.scale * (random_point(rng) - Point(0.5f)));
    queries.push_back(p + Point(set.scale, 0, 0));
    queries.push_back(p - Point(0, set.scale, 0));
  }
  return queries;
}

double exact_dist2(const Point& a, const Point& b) {
  const double x = double{a.x} - b.x, y = double{a.y} - b.y, z = double{a.z} - b.z;
  return x * x + y * y + z * z;
}

/// Squared distances are rounded, differently for each way to compile them: points this near to the boundary may be
/// found or not.
constexpr double rounding = 1e-6;

template <class Index>
void expect_ball(const Index& index, const std::vector<std::uint32_t>& order, const PointSet& set, const Point& q,
                 float radius) {
  const double radius2 = double{radius} * radius;
  std::vector<int> visits(set.points.size());
  index.for_each_near(q, radius, [&](std::uint32_t slot, float dist2) {
    ASSERT_LT(slot, set.points.size());
    const std::uint32_t record = order[slot];
    ++visits[record];
    const double exact = exact_dist2(set.points[record], q);
    EXPECT_NEAR(dist2, exact, rounding * exact + 1e-37);
    EXPECT_LE(dist2, radius * radius);
  });
  for (std::size_t i = 0; i < visits.size(); ++i) {
    const double exact = exact_dist2(set.points[i], q);
    ASSERT_LE(visits[i], 1) << set.name << " point " << i << " radius " << radius;
    const bool inside = exact <= radius2 * (1 - rounding), outside = exact > radius2 * (1 + rounding) + 1e-37;
    ASSERT_TRUE(inside ? visits[i] == 1 : !outside || visits[i] == 0)
        << set.name << " point " << i << " radius " << radius;
  }
}

void expect_permutation(const std::vector<std::uint32_t>& order, std::size_t count) {
  std::vector<std::uint32_t> sorted = order;
  std::sort(sorted.begin(), sorted.end());
  ASSERT_EQ(sorted.size(), count);
  for (std::uint32_t i = 0; i < count; ++i) ASSERT_EQ(sorted[i], i);
}

TEST(HashGrid, FindsWhatBruteForceFinds) {
  for (const PointSet& set : point_sets())
    for (const float fraction : {0.0f, 0.02f, 0.3f, 1.0f}) {
      const float radius = fraction * set.scale;
      const auto [grid, order] = HashGrid::build(set.points, radius);
      expect_permutation(order, set.points.size());
      for (std::uint32_t slot = 0; slot < grid.size(); ++slot) ASSERT_EQ(grid.position(slot), set.points[order[slot]]);
      for (const Point& q : queries_for(set))
        for (const float smaller : {1.0f, 0.5f, 0.0f}) expect_ball(grid, order, set, q, smaller * radius);
    }
}

/// Everything here is exact in float: points on the boundary of a ball must be found, also where it is a cell's.
TEST(HashGrid, KeepsPointsOnTheBoundary) {
  const std::vector<Point> points = lattice(16, 1);
  for (const float radius : {1.0f, 2.0f, 3.0f}) {
    const auto [grid, order] = HashGrid::build(points, radius);
    for (const Point& q : lattice(8, 2)) {
      std::size_t found = 0, expected = 0;
      grid.for_each_near(q, radius, [&](std::uint32_t, float) { ++found; });
      for (const Point& p : points) expected += distance_squared(p, q) <= radius * radius;
      ASSERT_EQ(found, expected);
    }
  }
}

TEST(HashGrid, DoesNotDependOnThreads) {
  HashRng rng(3);
  std::vector<Point> points(100000);
  for (Point& p : points) p = random_point(rng) * Point(1, 1, 0.01f);
  std::vector<std::uint32_t> reference;
  for (const unsigned threads : {1u, 2u, 3u}) {
    const ThreadLimit limit(threads);
    const auto [grid, order] = HashGrid::build(points, 0.004f);
    if (threads == 1) reference = order;
    EXPECT_EQ(order, reference);
  }
}

template <class Tree>
class KdTree : public testing::Test {};
using KdTrees = testing::Types<LeftBalancedKdTree, BucketKdTree>;
TYPED_TEST_SUITE(KdTree, KdTrees);

constexpr std::array split_rules{SplitRule::largest_extent, SplitRule::largest_variance};

TYPED_TEST(KdTree, FindsInABallWhatBruteForceFinds) {
  for (const PointSet& set : point_sets())
    for (const SplitRule rule : split_rules) {
      const auto [tree, order] = TypeParam::build(set.points, rule);
      expect_permutation(order, set.points.size());
      for (std::uint32_t slot = 0; slot < tree.size(); ++slot) ASSERT_EQ(tree.position(slot), set.points[order[slot]]);
      for (const Point& q : queries_for(set))
        for (const float fraction : {1.0f, 0.1f, 0.0f}) expect_ball(tree, order, set, q, fraction * set.scale);
    }
}

/// The k-th smallest distances agree, each found point is there once and as far as it says.
template <class Tree>
void expect_nearest(const Tree& tree, const std::vector<std::uint32_t>& order, const PointSet& set, const Point& q,
                    std::size_t k, float max_radius) {
  std::vector<double> expected;
  for (const Point& p : set.points)
    if (exact_dist2(p, q) <= double{max_radius} * max_radius) expected.push_back(exact_dist2(p, q));
  std::sort(expected.begin(), expected.end());
  expected.resize(std::min(expected.size(), k));

  std::vector<Neighbour> memory(k);
  const std::span<const Neighbour> heap = tree.nearest(q, max_radius, memory);
  ASSERT_TRUE(std::is_heap(heap.begin(), heap.end()));
  std::vector<Neighbour> found(heap.begin(), heap.end());
  std::sort(found.begin(), found.end());
  ASSERT_EQ(found.size(), expected.size()) << set.name;
  std::set<std::uint32_t> slots;
  for (std::size_t i = 0; i < found.size(); ++i) {
    ASSERT_TRUE(slots.insert(found[i].slot).second);
    ASSERT_NEAR(found[i].dist2, expected[i], rounding * expected[i] + 1e-37) << set.name << " k " << k;
    const double own = exact_dist2(set.points[order[found[i].slot]], q);
    ASSERT_NEAR(found[i].dist2, own, rounding * own + 1e-37) << set.name;
  }
}

TYPED_TEST(KdTree, FindsTheNearestThatBruteForceFinds) {
  for (const PointSet& set : point_sets())
    for (const SplitRule rule : split_rules) {
      const auto [tree, order] = TypeParam::build(set.points, rule);
      const std::vector<Point> queries = queries_for(set);
      for (std::size_t i = 0; i < queries.size(); i += 3) {
        for (const std::size_t k : {0u, 1u, 7u, 50u}) expect_nearest(tree, order, set, queries[i], k, infinity);
        // Half a unit in the last place off all distances, so that none is on the boundary.
        expect_nearest(tree, order, set, queries[i], 20, 0.3f * set.scale * 1.0001f);
      }
      expect_nearest(tree, order, set, queries[0], 4000, infinity);
    }
}

TYPED_TEST(KdTree, KeepsPointsOnTheBoundary) {
  const std::vector<Point> points = lattice(16, 1);
  const auto [tree, order] = TypeParam::build(points);
  for (const float radius : {1.0f, 2.0f, 3.0f})
    for (const Point& q : lattice(8, 2)) {
      std::size_t found = 0;
      tree.for_each_near(q, radius, [&](std::uint32_t, float) { ++found; });
      const auto expected = std::count_if(points.begin(), points.end(),
                                          [&](const Point& p) { return distance_squared(p, q) <= radius * radius; });
      ASSERT_EQ(found, static_cast<std::size_t>(expected));
      std::vector<Neighbour> memory(points.size());
      ASSERT_EQ(tree.nearest(q, radius, memory).size(), found);
    }
}

TYPED_TEST(KdTree, DoesNotDependOnThreads) {
  HashRng rng(3);
  std::vector<Point> points(100000);
  for (Point& p : points) p = random_point(rng) * Point(1, 1, 0.01f);
  std::vector<std::uint32_t> reference;
  for (const unsigned threads : {1u, 2u, 3u}) {
    const ThreadLimit limit(threads);
    const auto [tree, order] = TypeParam::build(points);
    if (threads == 1) reference = order;
    EXPECT_EQ(order, reference);
  }
}

TEST(LeftBalancedKdTree, EveryNodeSplitsItsSubtree) {
  HashRng rng(5);
  for (const std::size_t count : {1u, 2u, 3u, 4u, 5u, 6u, 7u, 8u, 100u, 1000u}) {
    std::vector<Point> points(count);
    for (Point& p : points) p = {rng.next(), 0, 0};  // one axis: the tree is a search tree
    const auto [tree, order] = LeftBalancedKdTree::build(points);
    for (std::uint32_t slot = 1; slot < count; ++slot) {
      // An ancestor lies on the side that the path from it to here says.
      for (std::uint32_t below = slot; below > 0; below = (below - 1) / 2) {
        const float parent = tree.position((below - 1) / 2).x;
        if (below % 2 == 1) {
          ASSERT_LE(tree.position(slot).x, parent);
        } else {
          ASSERT_GE(tree.position(slot).x, parent);
        }
      }
    }
  }
}

constexpr std::array kernel_names{"box",
                                  "cone",
                                  "epanechnikov",
                                  "gaussian",
                                  "gaussian-jensen",
                                  "box-historical",
                                  "cone-historical",
                                  "epanechnikov-historical",
                                  "gaussian-historical",
                                  "gaussian-jensen-historical"};

double integral_over_disc(const Kernel& kernel, float support) {
  const int steps = 20000;
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const float d = support * (static_cast<float>(i) + 0.5f) / static_cast<float>(steps);
    sum += kernel.weight(d * d, support * support) * 2 * std::numbers::pi * d * support / steps;
  }
  return sum;
}

TEST(Kernel, IntegratesToOneOverItsDisc) {
  for (const char* name : kernel_names) {
    const Kernel kernel = kernel_from_name(name).value();
    const double expected = kernel.shape == KernelShape::gaussian_jensen && kernel.historical ? 0.531155 : 1;
    EXPECT_NEAR(integral_over_disc(kernel, 0.37f), expected, 1e-5) << name;
  }
  for (const float slope : {1.0f, 1.1f, 2.0f, 10.0f})
    EXPECT_NEAR(integral_over_disc({KernelShape::cone, false, slope}, 2.0f), 1, 1e-5) << slope;
}

TEST(Kernel, NamesGoBothWays) {
  for (const char* name : kernel_names) EXPECT_EQ(name_of(kernel_from_name(name).value()), name);
  EXPECT_FALSE(kernel_from_name("triangle").has_value());
}

TEST(Kernel, FallsFromTheCentreAndTheGaussianHasTheBoxRadiusAsDeviation) {
  for (const char* name : kernel_names) {
    const Kernel kernel = kernel_from_name(name).value();
    for (float u = 0; u < 1; u += 0.01f) EXPECT_GE(kernel.profile(u), kernel.profile(u + 0.01f)) << name;
    EXPECT_GE(kernel.profile(1), -1e-6f) << name;
  }
  const Kernel gaussian{KernelShape::gaussian};
  const float support = gaussian.support(0.2f);
  EXPECT_NEAR(gaussian.weight(0.2f * 0.2f, support * support) / gaussian.weight(0, support * support), std::exp(-0.5f),
              1e-5f);
}

TEST(GatherDisc, IsBoundedByTheKthPointOrTheLargestRadius) {
  const std::array<Neighbour, 3> found{{{4, 0}, {1, 1}, {0, 2}}};
  const auto kth = gather_disc({}, found, 3, 9).value();
  EXPECT_EQ(kth.support2, 4);
  EXPECT_EQ(kth.counted.size(), 2u);
  const auto historical = gather_disc({KernelShape::box, true}, found, 3, 9).value();
  EXPECT_EQ(historical.support2, 4);
  EXPECT_EQ(historical.counted.size(), 3u);
  const auto few = gather_disc({}, found, 5, 9).value();
  EXPECT_EQ(few.support2, 81);
  EXPECT_EQ(few.counted.size(), 3u);
  EXPECT_FALSE(gather_disc({}, {}, 5, 9).has_value());
  EXPECT_FALSE(gather_disc({}, std::span(found).last(1), 1, 9).has_value());
}

TEST(RadiusSchedule, FollowsTheRecurrence) {
  for (const double alpha : {0.1, 2.0 / 3, 0.9, 1.0}) {
    const RadiusSchedule schedule{0.25, alpha};
    EXPECT_EQ(schedule.radius(0), 0.25f);
    double shrink2 = 1;
    for (std::uint64_t pass = 0; pass < 5000; ++pass) {
      const double i = static_cast<double>(pass) + 1;
      ASSERT_NEAR(schedule.shrink2(pass) / shrink2, 1, 1e-10) << "pass " << pass << " alpha " << alpha;
      shrink2 *= (i + alpha) / (i + 1);
    }
  }
  // r² falls like i^(α - 1), for any number of passes.
  const RadiusSchedule schedule;
  EXPECT_NEAR(schedule.shrink2(10'000'000) / schedule.shrink2(80'000'000), 2, 1e-6);
}

TEST(RadiusSchedule, LogGammaIsAccurate) {
  for (const double x : {1e-3, 0.5, 1.0, 1.7, 2.0, 10.0, 15.9, 16.0, 1e3, 1e6})
    EXPECT_NEAR(log_gamma(x), std::lgamma(x), 1e-13 * std::fmax(1, std::fabs(std::lgamma(x)))) << x;
}

TEST(Photon, DirectionsAreRoundedToNearest) {
  HashRng rng(13);
  glm::dvec3 mean_error(0);
  double worst = 0;
  constexpr int count = 200000;
  for (int i = 0; i < count; ++i) {
    const Vec3 v = sample_uniform_sphere(rng.next2());
    const Vec3 error = decode_octahedral<16>(encode_octahedral<16>(v)) - v;
    worst = std::fmax(worst, std::sqrt(length_squared(error)));
    mean_error += glm::dvec3(error);
    ASSERT_LT(std::sqrt(length_squared(decode_octahedral<12>(encode_octahedral<12>(v)) - v)), 1.2e-3f);
  }
  EXPECT_LT(worst, 7e-5);
  // Errors have a deviation of about 2e-5 per axis: the mean of 2e5 one of 4.5e-8. Six of these: false alarm < 1e-8.
  for (int axis = 0; axis < 3; ++axis) EXPECT_LT(std::fabs(mean_error[axis] / count), 2.7e-7);
  for (int axis = 0; axis < 3; ++axis)
    for (const float sign : {-1.0f, 1.0f}) {
      Vec3 v(0);
      v[axis] = sign;
      EXPECT_EQ(decode_octahedral<16>(encode_octahedral<16>(v)), v);
      EXPECT_EQ(decode_octahedral<12>(encode_octahedral<12>(v)), v);
    }
}

TEST(Photon, SharedExponentIsRoundedToNearest) {
  HashRng rng(17);
  double mean_error = 0;
  constexpr int count = 200000;
  for (int i = 0; i < count; ++i) {
    const Vec3 rgb = std::exp2(28 * rng.next() - 13) * random_point(rng);
    const Vec3 decoded = decode_rgb9e5(encode_rgb9e5(rgb.x, rgb.y, rgb.z));
    const float largest = max_component(rgb);
    for (int c = 0; c < 3; ++c) {
      ASSERT_LE(std::fabs(decoded[c] - rgb[c]), std::fmax(largest / 512 * 1.0001f, 0x1p-25f));
      mean_error += (decoded[c] - rgb[c]) / largest / (3.0 * count);
    }
  }
  // Deviation 8e-4 each, of the mean 1e-6; six of these.
  EXPECT_LT(std::fabs(mean_error), 6e-6);
  EXPECT_EQ(decode_rgb9e5(encode_rgb9e5(0, -1, 0)), Vec3(0));
  EXPECT_EQ(decode_rgb9e5(encode_rgb9e5(1e9f, 1, 0)), Vec3(65408, 0, 0));
  EXPECT_EQ(decode_rgb9e5(encode_rgb9e5(511.9f, 0, 0)), Vec3(512, 0, 0));
  EXPECT_EQ(decode_rgb9e5(encode_rgb9e5(1, 0.5f, 0.25f)), Vec3(1, 0.5f, 0.25f));
}

TEST(Photon, HalfFloatsGoBothWays) {
  for (std::uint32_t h = 0; h < 0x7c00; ++h) ASSERT_EQ(encode_half(decode_half(static_cast<std::uint16_t>(h))), h);
  EXPECT_EQ(decode_half(0x3c00), 1);
  EXPECT_EQ(decode_half(0x0001), 0x1p-24f);
  EXPECT_EQ(decode_half(0x7bff), 65504);
  EXPECT_EQ(decode_half(0xc000), -2);
  // Ties go to even.
  EXPECT_EQ(encode_half(1 + 0x1p-11f), 0x3c00);
  EXPECT_EQ(encode_half(1 + 3 * 0x1p-11f), 0x3c02);
  EXPECT_EQ(encode_half(2 - 0x1p-12f), 0x4000);
}

std::vector<Photon> random_photons(std::size_t count, float brightest) {
  HashRng rng(19);
  std::vector<Photon> photons(count);
  for (Photon& p : photons) {
    p.position = random_point(rng);
    p.wi = sample_uniform_sphere(rng.next2());
    p.normal = sample_uniform_sphere(rng.next2());
    p.power = brightest * Spectrum(rng.next(), rng.next(), rng.next(), 0);
    p.flags = PhotonFlags::from_bits(static_cast<int>(64 * rng.next()), static_cast<std::uint32_t>(8 * rng.next()));
  }
  return photons;
}

TEST(PhotonMap, GivesBackWhatWasStored) {
  for (const ColorMode mode : {ColorMode::rgb, ColorMode::spectral})
    for (const float brightest : {1e-20f, 1.0f, 1e12f}) {
      const std::vector<Photon> photons = random_photons(2000, brightest);
      const auto map = PhotonMap<HashGrid>::build(photons, mode, 0.05f);
      ASSERT_EQ(map.size(), photons.size());
      for (std::size_t i = 0; i < photons.size(); i += 7) {
        const Photon& stored = photons[i];
        int times = 0;
        map.for_each_near(stored.position, 0.05f, [&](const PhotonMap<HashGrid>::Ref& photon, float dist2) {
          ASSERT_LE(dist2, 0.05f * 0.05f);
          if (photon.position() != stored.position) return;
          ++times;
          for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(photon.power()[c], stored.gained_power()[c], max_component(stored.gained_power()) / 511);
          EXPECT_EQ(photon.power()[3], 0);
          EXPECT_GT(dot(photon.wi(), stored.wi), 1 - 1e-6f);
          EXPECT_EQ(photon.normal().has_value(), mode == ColorMode::rgb);
          if (photon.normal()) {
            EXPECT_GT(dot(*photon.normal(), stored.normal), 1 - 1e-5f);
          }
          EXPECT_EQ(photon.flags(), stored.flags);
        });
        ASSERT_EQ(times, 1);
      }
    }
}

TEST(Photon, AllowsNoMoreEyeScatteringsThanCanBeRecorded) {
  for (const ColorMode mode : {ColorMode::rgb, ColorMode::spectral}) {
    Photon photon{Spectrum(1), {}, {0, 0, 1}, {0, 0, 1}, {.eye_scatterings = 1000, .caustic = true}};
    EXPECT_EQ(PackedPhoton::pack(photon, mode, 1).flags(mode),
              (PhotonFlags{.eye_scatterings = PhotonFlags::most_eye_scatterings, .caustic = true}));
    photon.flags.eye_scatterings = 0;
    EXPECT_EQ(PackedPhoton::pack(photon, mode, 1).flags(mode).eye_scatterings, 0);
  }
}

TEST(PhotonMap, KeepsSpectralPowersOfAnySize) {
  std::vector<Photon> photons(2);
  for (Photon& p : photons) p.wi = p.normal = {0, 0, 1};
  photons[0].power = {1e6f, 1, 0, 3e-2f};
  photons[1].power = {2e-2f, 5e5f, 7, 1e3f};
  photons[1].position = {1, 0, 0};
  const auto map = PhotonMap<LeftBalancedKdTree>::build(photons, ColorMode::spectral);
  std::array<Neighbour, 1> memory;
  for (const Photon& p : photons) {
    const Spectrum power = map[map.nearest(p.position, 0.5f, memory).front().slot].power();
    for (int c = 0; c < 4; ++c) EXPECT_NEAR(power[c], p.power[c], p.power[c] / 2000);
  }
}

TEST(PhotonMap, DoesNotDependOnChunksOrThreads) {
  const std::vector<Photon> photons = random_photons(50000, 1);
  const auto whole = PhotonMap<BucketKdTree>::build(photons, ColorMode::rgb);
  const ThreadLimit limit(3);
  std::vector<std::vector<Photon>> chunks{{}, {photons.begin(), photons.begin() + 777}, {}};
  chunks.emplace_back(photons.begin() + 777, photons.end());
  const auto cut = PhotonMap<BucketKdTree>::build(chunks, ColorMode::rgb);
  ASSERT_EQ(cut.size(), whole.size());
  for (std::uint32_t slot = 0; slot < whole.size(); ++slot) {
    ASSERT_EQ(cut[slot].position(), whole[slot].position());
    ASSERT_EQ(cut[slot].power(), whole[slot].power());
    ASSERT_EQ(cut[slot].wi(), whole[slot].wi());
  }
}

TEST(PhotonMap, MayBeEmpty) {
  const auto map = PhotonMap<HashGrid>::build(std::vector<Photon>{}, ColorMode::rgb, 0.1f);
  EXPECT_EQ(map.size(), 0u);
  map.for_each_near({0, 0, 0}, 0.1f, [](const PhotonMap<HashGrid>::Ref&, float) { FAIL(); });
}

#ifndef LANTHORN_FULL_PRECISION_PHOTONS
TEST(PhotonMap, TakesAtMost24BytesPerPhotonBesidesTheCellTable) {
  const std::vector<Photon> photons = random_photons(100000, 1);
  const auto grid = PhotonMap<HashGrid>::build(photons, ColorMode::rgb, 0.02f);
  EXPECT_LE(grid.memory_bytes() - grid.index().table_bytes(), 24 * photons.size() + 200);
  EXPECT_LE(grid.index().table_bytes(), 12 * photons.size());
  EXPECT_LE(PhotonMap<BucketKdTree>::build(photons, ColorMode::rgb).memory_bytes(),
            25 * photons.size() + photons.size() / 2);
  EXPECT_LE(PhotonMap<LeftBalancedKdTree>::build(photons, ColorMode::rgb).memory_bytes(), 25 * photons.size());
}
#endif

}  // namespace
}  // namespace lanthorn
