// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Queries of balls and beams by position and by ray, against brute force in extended precision.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <type_traits>
#include <vector>

#include "base/parallel.h"
#include "index/ball_bvh.h"
#include "index/beam_bvh.h"
#include "math/hash.h"
#include "math/sampling.h"

namespace lanthorn::ray_index_test {
namespace {

using Exact = glm::vec<3, long double>;

Point random_point(HashRng& rng) { return {rng.next(), rng.next(), rng.next()}; }

template <class Item>
struct Set {
  std::string name;
  std::vector<Item> items;
  float scale;  ///< width of the part that queries cover
};

template <class Item, class Make>
std::vector<Item> generate(std::size_t count, Make&& make) {
  HashRng rng(7);
  std::vector<Item> items;
  for (std::size_t i = 0; i < count; ++i) items.push_back(make(rng, i));
  return items;
}

Beam between(const Point& a, const Point& b, float radius) {
  const float length = std::sqrt(distance_squared(a, b));
  return {a, length > 0 ? (b - a) / length : Direction(0, 1, 0), length, radius};
}

std::vector<Set<Beam>> beam_sets() {
  const auto in_cube = [](float size, const Point& corner, float radius) {
    return [=](HashRng& r, std::size_t) {
      return between(corner + size * random_point(r), corner + size * random_point(r), size * radius * r.next());
    };
  };
  std::vector<Set<Beam>> sets;
  sets.push_back({"none", {}, 1});
  sets.push_back({"one", {between({0, 0, 0}, {1, 1, 1}, 0.3f)}, 1});
  for (const std::size_t count : {7u, 8u, 9u, 64u, 65u, 513u})
    sets.push_back({std::to_string(count), generate<Beam>(count, in_cube(1, {0, 0, 0}, 0.1f)), 1});
  sets.push_back({"random", generate<Beam>(3000, in_cube(1, {0, 0, 0}, 0.05f)), 1});
  sets.push_back({"from one point",
                  generate<Beam>(3000,
                                 [](HashRng& r, std::size_t) {
                                   return between({0.5f, 0.5f, 0.5f}, random_point(r), 0.03f);
                                 }),
                  1});
  sets.push_back({"clustered",
                  generate<Beam>(3000,
                                 [](HashRng& r, std::size_t) {
                                   const float spread = std::exp2(-20 * r.next());
                                   const Point c(0.25f, 0.5f, 0.75f);
                                   return between(c + spread * (random_point(r) - Point(0.5f)),
                                                  c + spread * (random_point(r) - Point(0.5f)), 0.1f * spread);
                                 }),
                  0.1f});
  // Rays exactly along the beams find nothing; rays in nearly their direction must find the right ones.
  sets.push_back({"parallel",
                  generate<Beam>(2000,
                                 [](HashRng& r, std::size_t) {
                                   return Beam{{r.next(), r.next(), 0}, {0, 0, 1}, r.next(), 0.05f};
                                 }),
                  1});
  sets.push_back({"nearly parallel",
                  generate<Beam>(2000,
                                 [](HashRng& r, std::size_t) {
                                   const Point a(r.next(), r.next(), 0);
                                   const float turn = std::exp2(-30 * r.next());
                                   return between(a, a + Point(turn, -turn, 1), 0.05f);
                                 }),
                  1});
  sets.push_back({"in a plane",
                  generate<Beam>(2000,
                                 [](HashRng& r, std::size_t) {
                                   return between({r.next(), 2, r.next()}, {r.next(), 2, r.next()}, 0.02f);
                                 }),
                  1});
  sets.push_back({"all equal", std::vector<Beam>(500, between({0, 0.5f, 0.5f}, {1, 0.5f, 0.5f}, 0.1f)), 1});
  sets.push_back({"without length",
                  generate<Beam>(2000,
                                 [](HashRng& r, std::size_t) {
                                   return Beam{random_point(r), {0, 1, 0}, 0, 0.1f};
                                 }),
                  1});
  sets.push_back({"without radius",
                  generate<Beam>(2000,
                                 [](HashRng& r, std::size_t i) {
                                   const auto x = static_cast<float>(i % 32);
                                   return Beam{{x, -1, r.next()}, {0, 1, 0}, 2, 0};
                                 }),
                  8});
  // Beams thinner than the rounding of bounds and pieces.
  sets.push_back({"thin", generate<Beam>(200, in_cube(1, {0, 0, 0}, 1e-5f)), 1});
  sets.push_back({"huge", generate<Beam>(2000, in_cube(1e9f, Point(-5e8f), 0.05f)), 1e9f});
  sets.push_back({"far away", generate<Beam>(2000, in_cube(100, Point(1e7f), 0.05f)), 100});
  sets.push_back({"tiny", generate<Beam>(2000, in_cube(1e-10f, Point(0), 0.05f)), 1e-10f});
  sets.push_back({"long and short",
                  generate<Beam>(2000,
                                 [](HashRng& r, std::size_t) {
                                   const Point a = random_point(r);
                                   const float length = std::exp2(20 * r.next() - 10);
                                   return Beam{a, sample_uniform_sphere(r.next2()), length, 0.01f};
                                 }),
                  1});
  return sets;
}

std::vector<Set<Ball>> ball_sets() {
  std::vector<Set<Ball>> sets;
  for (const Set<Beam>& beams : beam_sets()) {
    Set<Ball> set{beams.name, {}, beams.scale};
    for (const Beam& beam : beams.items) set.items.push_back({beam.origin, beam.radius});
    sets.push_back(set);
  }
  return sets;
}

Point middle_of(const Ball& ball) { return ball.centre; }
Point middle_of(const Beam& beam) { return beam.origin + 0.5f * beam.length * beam.direction; }

Point start_of(const Ball& ball) { return ball.centre; }
Point start_of(const Beam& beam) { return beam.origin + 0.001f * beam.length * beam.direction; }

/// Points on items, points near them, and points away from them.
template <class Item>
std::vector<Point> positions_for(const Set<Item>& set) {
  HashRng rng(11);
  std::vector<Point> positions{{0, 0, 0}, {-1, 0.5f, 3}, {1e5f, -1e5f, 0}};
  for (int i = 0; i < 25 && !set.items.empty(); ++i) {
    const Item& item = set.items[static_cast<std::size_t>(rng.next() * static_cast<float>(set.items.size()))];
    positions.push_back(middle_of(item));
    positions.push_back(middle_of(item) + item.radius * (2.0f * random_point(rng) - Point(1)));
    positions.push_back(middle_of(item) + Point(item.radius, 0, 0));
    positions.push_back(start_of(item) + item.radius * (2.0f * random_point(rng) - Point(1)));
  }
  return positions;
}

/// Rays through items and past them, infinite and limited, along the axes and in the direction of items.
template <class Item>
std::vector<RaySegment> rays_for(const Set<Item>& set) {
  HashRng rng(13);
  std::vector<RaySegment> rays;
  for (const Point& p : positions_for(set)) {
    const Direction d = sample_uniform_sphere(rng.next2());
    rays.push_back({p - set.scale * d, d});
    rays.push_back({p - set.scale * d, d, 0.5f * set.scale, set.scale * (0.5f + rng.next())});
    rays.push_back({p, d, -set.scale, set.scale});
    rays.push_back({p - 0.001f * set.scale * d, d});
    rays.push_back({p - set.scale * Point(0, 0, 1), {0, 0, 1}});
    rays.push_back({p - set.scale * Point(0, 1, 0), {0, 1, 0}, 0, set.scale});
    rays.push_back({p + set.scale * Point(1, 0, 0), {-1, -0.0f, 0}, 0, 2 * set.scale});
  }
  return rays;
}

struct Answer {
  long double t = 0, s = 0, dist2 = 0, sin = 0;
  bool found = false;
  bool on_boundary = false;  // may be found or not
};

// True if x is less than the limit; reports whether it is so close that rounding decides. Extended precision is exact
// for coordinates: rounding of doubles is below 10⁻¹² of the magnitudes added.
bool within(long double x, long double limit, long double magnitude, bool& on_boundary) {
  if (std::fabs(x - limit) <= 1e-12L * magnitude) on_boundary = true;
  return x <= limit;
}

Answer exact_foot(const Point& p, const Point& origin, const Direction& direction, float begin, float end,
                  float radius) {
  const Exact d(direction), w = Exact(p) - Exact(origin);
  Answer a;
  a.t = dot(w, d) / dot(d, d);
  a.dist2 = dot(w - a.t * d, w - a.t * d);
  const long double w2 = dot(w, w), r2 = static_cast<long double>(radius) * radius;
  a.found = within(begin, a.t, std::sqrt(w2), a.on_boundary);
  a.found = (end == infinity || within(a.t, end, std::sqrt(w2), a.on_boundary)) && a.found;
  a.found = within(a.dist2, r2, 1e-6L * w2 + r2, a.on_boundary) && a.found;
  return a;
}

Answer exact(const Ball& ball, const Point& p) {
  const Exact w = Exact(ball.centre) - Exact(p);
  Answer a;
  a.dist2 = dot(w, w);
  const long double r2 = static_cast<long double>(ball.radius) * ball.radius;
  a.found = within(a.dist2, r2, r2, a.on_boundary);
  return a;
}
Answer exact(const Ball& ball, const RaySegment& ray) {
  return exact_foot(ball.centre, ray.origin, ray.direction, ray.begin, ray.end, ball.radius);
}
Answer exact(const Beam& beam, const Point& p) {
  return exact_foot(p, beam.origin, beam.direction, 0, beam.length, beam.radius);
}
// From the normal equations of |o + t d - a - s e|², unlike the index, which uses cross products.
Answer exact(const Beam& beam, const RaySegment& ray) {
  const Exact d(ray.direction), e(beam.direction), w = Exact(beam.origin) - Exact(ray.origin);
  const long double dd = dot(d, d), ee = dot(e, e), de = dot(d, e), dw = dot(d, w), ew = dot(e, w);
  const Exact n = cross(d, e);
  const long double n2 = dot(n, n), far = std::sqrt(dot(w, w)) + beam.radius;
  Answer a;
  if (n2 == 0) return a;
  a.t = (dw * ee - de * ew) / n2;
  a.s = (de * dw - dd * ew) / n2;
  const Exact gap = a.t * d - w - a.s * e;
  a.dist2 = dot(gap, gap);
  a.sin = std::sqrt(n2);
  // Small angles between lines amplify rounding: in the normal equations here, in the cross products of the index.
  const long double worst = far / n2, r2 = static_cast<long double>(beam.radius) * beam.radius;
  a.found = within(ray.begin, a.t, worst, a.on_boundary);
  a.found = (ray.end == infinity || within(a.t, ray.end, worst, a.on_boundary)) && a.found;
  a.found = within(0, a.s, worst, a.on_boundary) && a.found;
  a.found = within(a.s, beam.length, worst, a.on_boundary) && a.found;
  a.found = within(a.dist2, r2, far * far / a.sin, a.on_boundary) && a.found;
  return a;
}

std::map<std::uint32_t, Answer> answers_of(const BallBvh& index, const Point& p) {
  std::map<std::uint32_t, Answer> found;
  index.for_each_containing(p, [&](std::uint32_t slot, float dist2) {
    EXPECT_TRUE(found.insert({slot, {.dist2 = dist2}}).second);
  });
  return found;
}
std::map<std::uint32_t, Answer> answers_of(const BallBvh& index, const RaySegment& ray) {
  std::map<std::uint32_t, Answer> found;
  index.for_each_along(ray, [&](std::uint32_t slot, float t, float dist2) {
    EXPECT_TRUE(found.insert({slot, {.t = t, .dist2 = dist2}}).second);
  });
  return found;
}
std::map<std::uint32_t, Answer> answers_of(const BeamBvh& index, const Point& p) {
  std::map<std::uint32_t, Answer> found;
  index.for_each_around(p, [&](std::uint32_t slot, float s, float dist2) {
    EXPECT_TRUE(found.insert({slot, {.t = s, .dist2 = dist2}}).second);
  });
  return found;
}
std::map<std::uint32_t, Answer> answers_of(const BeamBvh& index, const RaySegment& ray) {
  std::map<std::uint32_t, Answer> found;
  index.for_each_crossing(ray, [&](std::uint32_t slot, const BeamCrossing& c) {
    EXPECT_TRUE(found.insert({slot, {.t = c.t, .s = c.s, .dist2 = c.dist2, .sin = c.sin}}).second);
  });
  return found;
}

/// Returns how many items the query found.
template <class Index, class Item, class Query>
std::size_t expect_exact(const Index& index, const std::vector<std::uint32_t>& order, const Set<Item>& set,
                         const Query& query) {
  const std::map<std::uint32_t, Answer> found = answers_of(index, query);
  for (std::uint32_t slot = 0; slot < set.items.size(); ++slot) {
    const Item& item = set.items[order[slot]];
    const Answer expected = exact(item, query);
    const auto at = found.find(slot);
    if (expected.on_boundary) continue;
    EXPECT_EQ(at != found.end(), expected.found) << set.name << " item " << order[slot];
    if (at == found.end()) continue;
    const Answer& a = at->second;
    const long double r2 = static_cast<long double>(item.radius) * item.radius;
    EXPECT_LE(std::fabs(a.dist2 - expected.dist2), 1e-6L * (expected.dist2 + r2) + 1e-37L) << set.name;
    EXPECT_LE(std::fabs(a.t - expected.t), 1e-6L * std::fabs(expected.t) + 1e-7L * set.scale) << set.name;
    EXPECT_LE(std::fabs(a.s - expected.s), 1e-6L * std::fabs(expected.s) + 1e-7L * set.scale) << set.name;
    EXPECT_LE(std::fabs(a.sin - expected.sin), 1e-6L * expected.sin + 1e-12L) << set.name;
  }
  for (const auto& [slot, answer] : found) EXPECT_LT(slot, set.items.size());
  return found.size();
}

void expect_permutation(std::vector<std::uint32_t> order, std::size_t count) {
  std::sort(order.begin(), order.end());
  ASSERT_EQ(order.size(), count);
  for (std::uint32_t i = 0; i < count; ++i) ASSERT_EQ(order[i], i);
}

TEST(BallBvh, FindsWhatBruteForceFinds) {
  for (const Set<Ball>& set : ball_sets()) {
    const auto [index, order] = BallBvh::build(set.items);
    expect_permutation(order, set.items.size());
    ASSERT_EQ(index.size(), set.items.size());
    for (std::uint32_t slot = 0; slot < index.size(); ++slot) {
      ASSERT_EQ(index.position(slot), set.items[order[slot]].centre);
      ASSERT_EQ(index.ball(slot).radius, set.items[order[slot]].radius);
    }
    std::size_t around = 0, along = 0;
    for (const Point& p : positions_for(set)) around += expect_exact(index, order, set, p);
    for (const RaySegment& ray : rays_for(set)) along += expect_exact(index, order, set, ray);
    EXPECT_TRUE(set.items.empty() || (around > 0 && along > 0)) << set.name;
  }
}

TEST(BeamBvh, FindsWhatBruteForceFinds) {
  for (const Set<Beam>& set : beam_sets()) {
    const auto [index, order] = BeamBvh::build(set.items);
    expect_permutation(order, set.items.size());
    ASSERT_EQ(index.size(), set.items.size());
    for (std::uint32_t slot = 0; slot < index.size(); ++slot) {
      const Beam stored = index.beam(slot), &given = set.items[order[slot]];
      ASSERT_EQ(stored.origin, given.origin);
      ASSERT_EQ(stored.direction, given.direction);
      ASSERT_EQ(stored.length, given.length);
      ASSERT_EQ(stored.radius, given.radius);
    }
    std::size_t around = 0, crossing = 0;
    for (const Point& p : positions_for(set)) around += expect_exact(index, order, set, p);
    for (const RaySegment& ray : rays_for(set)) crossing += expect_exact(index, order, set, ray);
    EXPECT_TRUE(set.items.empty() || (around > 0 && crossing > 0)) << set.name;
  }
}

/// All numbers here are exact: boundaries are included, and so are ends.
TEST(BallBvh, KeepsTheBoundary) {
  std::vector<Ball> balls;
  for (int i = 0; i < 512; ++i)
    balls.push_back({Point(static_cast<float>(i % 8), static_cast<float>(i / 8 % 8), static_cast<float>(i / 64)), 2});
  const auto index = BallBvh::build(balls).index;
  std::size_t contain = 0, along = 0;
  index.for_each_containing({3, 3, 3}, [&](std::uint32_t, float) { ++contain; });
  EXPECT_EQ(contain, 33u);  // lattice points within 2
  index.for_each_along({{-5, 3, 3}, {1, 0, 0}, 6, 9}, [&](std::uint32_t, float t, float dist2) {
    ++along;
    EXPECT_TRUE(t >= 6 && t <= 9 && dist2 <= 4);
  });
  EXPECT_EQ(along, 4u * 13u);  // in four layers, the points within 2 in the plane
}

TEST(BeamBvh, KeepsTheBoundary) {
  std::vector<Beam> beams;
  for (int i = 0; i < 64; ++i)
    beams.push_back({{static_cast<float>(i % 8), 0, static_cast<float>(i / 8)}, {0, 1, 0}, 4, 2});
  const auto index = BeamBvh::build(beams).index;
  std::size_t crossed = 0, around = 0, beyond = 0;
  index.for_each_crossing({{-5, 4, 3}, {1, 0, 0}, 6, 9}, [&](std::uint32_t, const BeamCrossing& c) {
    ++crossed;
    EXPECT_TRUE(c.t >= 6 && c.t <= 9 && c.s == 4 && c.dist2 <= 4 && c.sin == 1);
  });
  EXPECT_EQ(crossed, 4u * 5u);
  index.for_each_around({3, 0, 3}, [&](std::uint32_t, float s, float) {
    ++around;
    EXPECT_EQ(s, 0);
  });
  EXPECT_EQ(around, 13u);
  index.for_each_around({3, -0.5f, 3}, [&](std::uint32_t, float, float) { ++beyond; });
  EXPECT_EQ(beyond, 0u);  // ends are flat
}

/// The order of the items, and the order in which queries find them.
template <class Index, class Item, class Query>
std::vector<std::uint32_t> all_that_threads_could_change(const std::vector<Item>& items, const Query& query) {
  const auto [index, order] = Index::build(items);
  std::vector<std::uint32_t> all = order;
  const auto note = [&all](std::uint32_t slot, auto...) { all.push_back(slot); };
  if constexpr (std::is_same_v<Index, BallBvh>) {
    index.for_each_along(query, note);
  } else {
    index.for_each_crossing(query, note);
  }
  return all;
}

TEST(RayIndex, DoesNotDependOnThreads) {
  HashRng rng(3);
  std::vector<Ball> balls;
  std::vector<Beam> beams;
  for (int i = 0; i < 100000; ++i) {
    beams.push_back(between(random_point(rng), random_point(rng), 0.001f));
    balls.push_back({beams.back().origin, 0.01f});
  }
  const RaySegment ray{{0, 0, 0}, normalize(Vec3(1, 1.1f, 0.9f))};
  std::vector<std::uint32_t> first_balls, first_beams;
  for (const unsigned threads : {1u, 2u, 3u}) {
    const ThreadLimit limit(threads);
    const auto of_balls = all_that_threads_could_change<BallBvh>(balls, ray);
    const auto of_beams = all_that_threads_could_change<BeamBvh>(beams, ray);
    if (threads == 1) first_balls = of_balls, first_beams = of_beams;
    EXPECT_EQ(of_balls, first_balls);
    EXPECT_EQ(of_beams, first_beams);
    EXPECT_GT(of_balls.size(), balls.size());
    EXPECT_GT(of_beams.size(), beams.size());
  }
}

/// More nodes and leaves than the queues hold.
TEST(RayIndex, FindsAllOfMany) {
  constexpr std::size_t count = 30000;
  HashRng rng(11);
  std::vector<Ball> balls;
  std::vector<Beam> beams;
  for (std::size_t i = 0; i < count; ++i) {
    balls.push_back({random_point(rng), 4});
    beams.push_back({random_point(rng) - Vec3(0, 10, 0), {0, 1, 0}, 20, 4});
  }
  const BallBvh of_balls = BallBvh::build(balls).index;
  const BeamBvh of_beams = BeamBvh::build(beams).index;
  std::vector<int> found(count);
  const auto expect_all = [&](const char* what, auto&& search) {
    std::fill(found.begin(), found.end(), 0);
    search([&](std::uint32_t slot, auto...) { ++found[slot]; });
    EXPECT_EQ(std::count(found.begin(), found.end(), 1), count) << what;
  };
  const Point p(0.5f);
  const RaySegment ray{{-5, 0.5f, 0.5f}, {1, 0, 0}};
  expect_all("containing", [&](auto&& note) { of_balls.for_each_containing(p, note); });
  expect_all("along", [&](auto&& note) { of_balls.for_each_along(ray, note); });
  expect_all("around", [&](auto&& note) { of_beams.for_each_around(p, note); });
  expect_all("crossing", [&](auto&& note) { of_beams.for_each_crossing(ray, note); });
}

TEST(BallBvh, OneRadiusForAll) {
  HashRng rng(5);
  std::vector<Point> points(1000);
  std::vector<Ball> balls;
  for (Point& p : points) {
    p = random_point(rng);
    balls.push_back({p, 0.1f});
  }
  const auto one = BallBvh::build(points, 0.1f), each = BallBvh::build(balls);
  EXPECT_EQ(one.order, each.order);
  for (std::uint32_t slot = 0; slot < 1000; ++slot) EXPECT_EQ(one.index.ball(slot).radius, 0.1f);
}

}  // namespace
}  // namespace lanthorn::ray_index_test
