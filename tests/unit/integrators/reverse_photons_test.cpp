// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The parts of photons that search for points: their radii, and the leaves of the tree that they reach.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "index/bucket_kdtree.h"
#include "integrators/photonmap/reverse_photons.h"
#include "math/hash.h"

namespace lanthorn::reverse_photons_test {
namespace {

Point random_point(HashRng& rng) { return {rng.next(), rng.next(), rng.next()}; }

TEST(ReversePhotons, LeavesInBallsHoldAllPointsInThem) {
  HashRng rng(1);
  for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{31}, std::size_t{20'000}}) {
    std::vector<Point> points(count);
    for (Point& p : points) p = random_point(rng);
    const BucketKdTree tree = BucketKdTree::build(points).index;
    std::vector<Ball> balls(40);
    for (Ball& b : balls) b = {random_point(rng), 0.2f * rng.next()};
    balls.push_back({{0.5f, 0.5f, 0.5f}, 3});

    const std::uint32_t no_ball = 1u << 31;
    std::vector<std::vector<std::uint32_t>> numbers_at(count, {no_ball});
    tree.for_each_leaf_in(balls, [&](SlotRange range, std::span<const std::uint32_t> numbers) {
      EXPECT_TRUE(std::is_sorted(numbers.begin(), numbers.end()));
      EXPECT_LE(range.end - range.begin, BucketKdTree::leaf_size);
      for (std::uint32_t slot = range.begin; slot < range.end; ++slot) {
        EXPECT_EQ(numbers_at[slot], std::vector{no_ball});  // each once
        numbers_at[slot].assign(numbers.begin(), numbers.end());
      }
    });
    std::size_t met = 0;
    for (std::uint32_t slot = 0; slot < count; ++slot) {
      const std::vector<std::uint32_t>& numbers = numbers_at[slot];
      met += numbers.size();
      for (std::uint32_t b = 0; b < balls.size(); ++b)
        EXPECT_TRUE(distance_squared(balls[b].centre, tree.position(slot)) > sqr(balls[b].radius) ||
                    std::binary_search(numbers.begin(), numbers.end(), b));
    }
    if (count <= BucketKdTree::leaf_size) continue;
    EXPECT_LE(met, count * balls.size() / 4);  // few beyond the radius
  }
}

TEST(ReversePhotons, LeavesAreAllSlots) {
  HashRng rng(2);
  std::vector<Point> points(1000);
  for (Point& p : points) p = random_point(rng);
  std::uint32_t next = 0;
  BucketKdTree::build(points).index.for_each_leaf([&](SlotRange range) {
    EXPECT_EQ(range.begin, next);
    next = range.end;
  });
  EXPECT_EQ(next, 1000u);
}

PhotonMap<BucketKdTree> map_of(const std::vector<Point>& positions) {
  std::vector<Photon> photons;
  photons.reserve(positions.size());
  for (const Point& p : positions) photons.push_back({Spectrum(1, 1, 1, 0), p, {0, 1, 0}, {0, 1, 0}, {}});
  return PhotonMap<BucketKdTree>::build(photons, ColorMode::rgb);
}

// Uniform density on a square of 1 m²: a disc with k photons has π r² = k / n. 4096 leaves are squares; leaves twice as
// long as wide would have radii 1.12 times as large.
TEST(ReversePhotons, RadiiHoldTheNumberOfPhotonsAskedFor) {
  constexpr std::size_t n = 100'000;
  HashRng rng(3);
  std::vector<Point> positions(n);
  for (Point& p : positions) p = {rng.next(), 0, rng.next()};
  const PhotonMap<BucketKdTree> map = map_of(positions);
  for (const std::size_t k : {std::size_t{10}, std::size_t{50}}) {
    const double expected = std::sqrt(static_cast<double>(k) / (static_cast<double>(pi) * n));
    for (const RadiusRule rule : {RadiusRule::nearest, RadiusRule::leaf}) {
      double sum = 0;
      for (const float r : photon_radii(map, {Kernel(), k, 1}, rule)) sum += static_cast<double>(r);
      EXPECT_NEAR(sum / n / expected, 1, 0.05) << k << (rule == RadiusRule::leaf ? ", leaf" : ", nearest");
    }
  }
}

TEST(ReversePhotons, RadiiAreBounded) {
  const std::vector<Point> alone{{0, 0, 0}, {5, 0, 0}}, together(100, Point(1, 2, 3));
  for (const RadiusRule rule : {RadiusRule::nearest, RadiusRule::leaf}) {
    for (const float r : photon_radii(map_of(alone), {Kernel(), 50, 0.5f}, rule)) EXPECT_EQ(r, 0.5f);
    for (const float r : photon_radii(map_of(together), {Kernel(), 50, 0.5f}, rule)) EXPECT_EQ(r, 0.5e-3f);
  }
  const Kernel gaussian{KernelShape::gaussian};
  for (const float r : photon_radii(map_of(alone), {gaussian, 0, 0.5f}, RadiusRule::nearest))
    EXPECT_EQ(r, gaussian.support(0.5f));
}

}  // namespace
}  // namespace lanthorn::reverse_photons_test
