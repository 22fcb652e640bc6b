// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "math/packed_float.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "math/hash.h"

namespace lanthorn::packed_float_test {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr std::uint16_t sign_bit = 0x8000, largest_code = 0x7bff, infinite_code = 0x7c00;

// The value of a half float by its definition, IEEE 754, 3.4.
float value_of(std::uint16_t half) {
  const int exponent = half >> 10 & 31, fraction = half & 1023;
  const float magnitude = exponent == 0 ? std::ldexp(static_cast<float>(fraction), -24)
                                        : std::ldexp(static_cast<float>(1024 + fraction), exponent - 25);
  return half & sign_bit ? -magnitude : magnitude;
}

// Tests both the processor's instructions, if compiled in, and the integer arithmetic.
void expect_code(float x, std::uint16_t code) {
  ASSERT_EQ(encode_half(x), code) << x;
  ASSERT_EQ(encode_half_in_software(x), code) << x;
}

TEST(HalfFloat, SurvivesARoundTrip) {
  for (std::uint32_t code = 0; code <= largest_code; ++code)
    for (const std::uint32_t sign : {0u, std::uint32_t{sign_bit}}) {
      const auto half = static_cast<std::uint16_t>(sign | code);
      const float value = value_of(half);  // also of denormals and of -0
      ASSERT_EQ(std::bit_cast<std::uint32_t>(decode_half(half)), std::bit_cast<std::uint32_t>(value));
      ASSERT_EQ(std::bit_cast<std::uint32_t>(decode_half_in_software(half)), std::bit_cast<std::uint32_t>(value));
      expect_code(value, half);
      ASSERT_EQ(encode_finite_half(value), half);
    }
}

TEST(HalfFloat, IsTheNearestAndTiesGoToEven) {
  for (std::uint16_t half = 0; half < largest_code; ++half) {
    const float middle = (value_of(half) + value_of(static_cast<std::uint16_t>(half + 1))) / 2;
    expect_code(std::nextafter(middle, 0.0f), half);
    expect_code(middle, half % 2 == 0 ? half : half + 1);
    expect_code(-middle, static_cast<std::uint16_t>(sign_bit | (half % 2 == 0 ? half : half + 1)));
    expect_code(std::nextafter(middle, infinity), half + 1);
  }
}

TEST(HalfFloat, KeepsInfinityAndNan) {
  expect_code(infinity, infinite_code);
  expect_code(-infinity, sign_bit | infinite_code);
  expect_code(65520, infinite_code);  // between 65504 and 65536; the tie rounds to even, 65536, which is out of range
  expect_code(std::nextafter(65520.0f, 0.0f), largest_code);
  for (const auto encode : {encode_half, encode_half_in_software}) {
    EXPECT_TRUE(std::isnan(decode_half(encode(NAN))));
    EXPECT_TRUE(std::isnan(decode_half_in_software(encode(NAN))));
  }
  EXPECT_EQ(decode_half(infinite_code), infinity);
  EXPECT_EQ(decode_half_in_software(sign_bit | infinite_code), -infinity);
}

TEST(HalfFloat, CanBeKeptFinite) {
  EXPECT_EQ(encode_finite_half(1e9f), largest_code);
  EXPECT_EQ(encode_finite_half(-infinity), sign_bit | largest_code);
  EXPECT_EQ(encode_finite_half(NAN), 0);
  EXPECT_EQ(encode_finite_half(-0.0f), sign_bit);
  EXPECT_EQ(value_of(largest_code), largest_half);
}

TEST(SharedExponent, IsRoundedToNearest) {
  HashRng rng(17);
  double mean_error = 0;
  constexpr int count = 200000;
  for (int i = 0; i < count; ++i) {
    const float scale = std::exp2(28 * rng.next() - 13);
    const Vec3 rgb{scale * rng.next(), scale * rng.next(), scale * rng.next()};
    const Vec3 decoded = decode_rgb9e5(encode_rgb9e5(rgb.x, rgb.y, rgb.z));
    const float largest = std::max({rgb.x, rgb.y, rgb.z});
    for (int c = 0; c < 3; ++c) {
      ASSERT_LE(std::fabs(decoded[c] - rgb[c]), std::fmax(largest / 512 * 1.0001f, 0x1p-25f));
      mean_error += (decoded[c] - rgb[c]) / largest / (3.0 * count);
    }
  }
  // A single error has a standard deviation of 8e-4, the mean error of 1e-6. The bound is six standard deviations of
  // the mean.
  EXPECT_LT(std::fabs(mean_error), 6e-6);
}

// All values whose largest component has a normalised mantissa, and the smallest values.
TEST(SharedExponent, SurvivesARoundTrip) {
  for (std::uint32_t exponent = 0; exponent < 32; ++exponent)
    for (std::uint32_t mantissa = exponent == 0 ? 0 : 256; mantissa < 512; ++mantissa)
      for (const std::uint32_t code : {mantissa | exponent << 27, mantissa << 9 | 1u << 18 | exponent << 27,
                                       7u | mantissa << 18 | exponent << 27}) {
        const Vec3 rgb = decode_rgb9e5(code);
        ASSERT_EQ(encode_rgb9e5(rgb.x, rgb.y, rgb.z), code);
      }
}

TEST(SharedExponent, ClampsAndRoundsTiesToEven) {
  const auto coded = [](float r, float g, float b) { return decode_rgb9e5(encode_rgb9e5(r, g, b)); };
  EXPECT_EQ(coded(0, -1, NAN), Vec3(0));
  EXPECT_EQ(coded(-0.0f, 0, 0), Vec3(0));
  EXPECT_EQ(coded(infinity, 128, -infinity), Vec3(largest_rgb9e5, 128, 0));
  EXPECT_EQ(coded(511.9f, 0, 0), Vec3(512, 0, 0)) << "carries into the exponent";
  EXPECT_EQ(coded(256, 2.5f, 3.5f), Vec3(256, 2, 4));
  EXPECT_EQ(coded(0x1p-24f, 0x1p-25f, 0x1.8p-24f), Vec3(0x1p-24f, 0, 0x1p-23f));
}

}  // namespace
}  // namespace lanthorn::packed_float_test
