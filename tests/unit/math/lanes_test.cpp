// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Each operation of `Lanes` against the same operation on floats.
#include "math/lanes.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace lanthorn::lanes_test {
namespace {

using Floats = std::array<float, Lanes::width>;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr Floats a{1, -2, 0.5f, 3, -0.25f, 7, 0, nan}, b{2, -2, -4, 0.125f, 8, -7, 1, 1};

// All NaNs count as equal.
void expect_same(const Lanes& got, const Floats& expected) {
  const Floats values = got.stored();
  for (std::size_t i = 0; i < values.size(); ++i)
    EXPECT_TRUE(values[i] == expected[i] || (std::isnan(values[i]) && std::isnan(expected[i])))
        << "lane " << i << ": " << values[i] << " instead of " << expected[i];
}

template <class Function>
Floats each(Function&& f) {
  Floats result;
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = f(a[i], b[i]);
  return result;
}

TEST(Lanes, ComputeAsFloatsDo) {
  const Lanes x(a), y(b);
  expect_same(x + y, each([](float p, float q) { return p + q; }));
  expect_same(x - y, each([](float p, float q) { return p - q; }));
  expect_same(x * y, each([](float p, float q) { return p * q; }));
  expect_same(x / y, each([](float p, float q) { return p / q; }));
  expect_same(abs(x), each([](float p, float) { return std::fabs(p); }));
  expect_same(Lanes(3.0f), each([](float, float) { return 3.0f; }));
  // If either operand is NaN, the result is the second.
  expect_same(min(x, y), each([](float p, float q) { return p < q ? p : q; }));
  expect_same(max(x, y), each([](float p, float q) { return p > q ? p : q; }));
}

TEST(Lanes, ReadWholeNumbers) {
  const std::array<std::uint8_t, Lanes::width> bytes{0, 1, 2, 3, 100, 200, 254, 255};
  const std::array<std::uint16_t, Lanes::width> words{0, 1, 2, 3, 255, 256, 40000, 65535};
  expect_same(Lanes(bytes), {0, 1, 2, 3, 100, 200, 254, 255});
  expect_same(Lanes(words), {0, 1, 2, 3, 255, 256, 40000, 65535});
}

TEST(Lanes, CompareAndSelect) {
  const Lanes x(a), y(b);
  const auto one_if = [](bool is) { return is ? 1.0f : 2.0f; };
  expect_same(select(x < y, Lanes(1), 2), each([&](float p, float q) { return one_if(p < q); }));
  expect_same(select(x <= y, Lanes(1), 2), each([&](float p, float q) { return one_if(p <= q); }));
  expect_same(select(~(x < y), Lanes(1), 2), each([&](float p, float q) { return one_if(!(p < q)); }));
  expect_same(select((x <= y) & (y <= 1), Lanes(1), 2),
              each([&](float p, float q) { return one_if(p <= q && q <= 1); }));
  expect_same(select(x < y, x, y), each([](float p, float q) { return p < q ? p : q; }));
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < a.size(); ++i) bits |= static_cast<std::uint32_t>(!(a[i] > b[i])) << i;
  EXPECT_EQ(not_greater(x, y), bits);
}

TEST(Lanes, VectorsInLanes) {
  StoredVec3 stored;
  for (std::uint32_t i = 0; i < Lanes::width; ++i) {
    const auto x = static_cast<float>(i);
    stored.set(i, {x, 2 - x, 0.5f * x});
    EXPECT_EQ(stored.lane(i), Point(x, 2 - x, 0.5f * x));
  }
  const LaneVec3 v = stored.load(), w{1, -1, 2};
  // With small integers and halves no operation rounds, so fused operations give the same result.
  const auto of_lane = [&](auto&& f) {
    Floats result;
    for (std::uint32_t i = 0; i < Lanes::width; ++i) result[i] = f(stored.lane(i));
    return result;
  };
  const Vec3 one(1, -1, 2);
  expect_same(dot(v, w), of_lane([&](const Vec3& p) { return p.x * one.x + p.y * one.y + p.z * one.z; }));
  expect_same(cross(v, w).x, of_lane([&](const Vec3& p) { return p.y * one.z - p.z * one.y; }));
  expect_same(cross(v, w).y, of_lane([&](const Vec3& p) { return p.z * one.x - p.x * one.z; }));
  expect_same(cross(v, w).z, of_lane([&](const Vec3& p) { return p.x * one.y - p.y * one.x; }));
  expect_same((v + w).y, of_lane([](const Vec3& p) { return p.y - 1; }));
  expect_same((v - w).z, of_lane([](const Vec3& p) { return p.z - 2; }));
  expect_same((Lanes(2.0f) * v).x, of_lane([](const Vec3& p) { return 2 * p.x; }));
  expect_same(abs(v).y, of_lane([](const Vec3& p) { return std::fabs(p.y); }));
}

}  // namespace
}  // namespace lanthorn::lanes_test
